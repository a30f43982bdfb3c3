// Requests for motion and their replies: plain structs and generated ones.

#include "io/dds/convert.h"

namespace selfcal {
namespace {

using borrowed::text;

// The generated structs' strings are never written to.
char* literal_text(std::string_view literal) { return const_cast<char*>(literal.data()); }

// The value among `all` that `word` is the name of.
template <class E, std::size_t n>
std::optional<E> named(std::string_view word, const std::array<E, n>& all) {
  for (const E value : all)
    if (to_string(value) == word) return value;
  return std::nullopt;
}

constexpr std::array kMoveKinds = {MoveKind::travel,  MoveKind::touch, MoveKind::seat,
                                   MoveKind::retract, MoveKind::lock,  MoveKind::visit,
                                   MoveKind::release};
constexpr std::array kOutcomes = {MotionReply::Outcome::accepted, MotionReply::Outcome::done,
                                  MotionReply::Outcome::stopped, MotionReply::Outcome::refused};
constexpr std::string_view kStop = "stop";
const std::string kNothing;

}  // namespace

dds::MotionRequest borrow(const MotionRequest& request) {
  const auto size = static_cast<std::uint32_t>(request.q.size());
  return {.id_ = request.id,
          .kind_ = literal_text(to_string(request.kind)),
          .label_ = text(request.label),
          .q_ = {size, size, const_cast<double*>(request.q.data()), false},
          .speed_ = request.speed,
          .why_ = text(kNothing)};
}

dds::MotionRequest borrow_stop(std::uint64_t id, const std::string& why) {
  return {.id_ = id,
          .kind_ = literal_text(kStop),
          .label_ = text(kNothing),
          .q_ = {},
          .speed_ = 0,
          .why_ = text(why)};
}

Result<RobotRequest> to_plain(const dds::MotionRequest& request) {
  RobotRequest plain{.stop = kStop == request.kind_, .why = request.why_, .move = {}};
  plain.move.id = request.id_;
  if (plain.stop) return plain;
  const auto kind = named(request.kind_, kMoveKinds);
  if (!kind) return bad_input("\"" + std::string(request.kind_) + "\" is no kind of motion");
  plain.move.kind = *kind;
  plain.move.label = request.label_;
  plain.move.q.assign(request.q_._buffer, request.q_._buffer + request.q_._length);
  plain.move.speed = request.speed_;
  return plain;
}

dds::MotionReply borrow(const MotionReply& reply) {
  return {
      .id_ = reply.id, .outcome_ = literal_text(to_string(reply.outcome)), .why_ = text(reply.why)};
}

MotionReply to_plain(const dds::MotionReply& reply) {
  const auto outcome = named(reply.outcome_, kOutcomes);
  if (outcome) return {.id = reply.id_, .outcome = *outcome, .why = reply.why_};
  return {.id = reply.id_,
          .outcome = MotionReply::Outcome::refused,
          .why = "the robot answered \"" + std::string(reply.outcome_) + "\", which is no outcome"};
}

}  // namespace selfcal
