#include "app/commands/support/paced_output.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace selfcal {
namespace {

constexpr Nanoseconds kAwake = 200'000;  // before an edge: a sleep may end so much later
constexpr Nanoseconds kFrame = 200'000;  // the frames of a sample take so long: an edge goes first
constexpr Nanoseconds kLeisure = 500'000;  // what is done between two frames takes so long
constexpr Nanoseconds kLongestMark = 5 * kMillisecond;  // waited for a mark in one turn
constexpr Nanoseconds kReadingStep = 1000;              // over which a speed is taken
constexpr Nanoseconds kLate = 5'000;                    // after its moment an edge counts as missed
constexpr int kMostPauses = 20;                         // for one edge; then it is driven late
constexpr std::size_t kMostDriven = 1'000'000;

}  // namespace

PacedOutput::PacedOutput(Machine& machine, JointSender& joints, TriggerSender& trigger,
                         Clock& clock)
    : machine_(machine),
      joints_(joints),
      trigger_(trigger),
      clock_(clock),
      delay_(nanoseconds(machine.settings().trigger_delay)),
      began_(clock.now() - machine.now()),
      told_(machine.now()),
      level_(machine.closed()) {}

std::optional<Nanoseconds> PacedOutput::next_edge() const {
  const auto ahead = machine_.next_edge();
  if (held_.empty()) return ahead;
  return ahead ? std::min(*ahead, held_.front().time) : held_.front().time;
}

/// From when on no frame is begun before the next edge.
std::optional<Nanoseconds> PacedOutput::quiet_from() const {
  const auto edge = next_edge();
  return edge ? std::optional(*edge - delay_ - 2 * kFrame) : std::nullopt;
}

bool PacedOutput::at_leisure() {
  const auto quiet = quiet_from();
  return !quiet || *quiet > now() + kLeisure;
}

/// False when there was news before anything was due.
bool PacedOutput::wait_for_next() {
  const auto quiet = quiet_from();
  const Nanoseconds sample = owed_ ? now() : machine_.next_sample();
  if (!quiet || *quiet > sample) {
    clock_.wait(sample - now());
    return now() >= sample;
  }
  const Nanoseconds edge = *next_edge();
  clock_.wait(edge - kAwake - now());
  if (now() < edge - kAwake) return false;
  while (now() < edge) {
  }
  return true;
}

Result<void> PacedOutput::turn() {
  if (!restarting_ && !wait_for_next()) return {};
  const Nanoseconds t = now();
  if (const auto edge = next_edge(); edge && missed(*edge, t)) return pause();
  if (restarting_) {
    auto sent = try_sample();
    restarting_ = owed_;
    return sent;
  }
  machine_.advance(t);
  edges_.clear();
  machine_.take(edges_);
  held_.insert(held_.end(), edges_.begin(), edges_.end());
  if (auto driven = drive_due(); !driven || restarting_) return driven;
  samples_.clear();
  machine_.take(samples_);
  owed_ = owed_ || !samples_.empty();
  if (!owed_) return {};
  if (const auto quiet = quiet_from(); quiet && *quiet < now()) return {};
  in_a_row_ = 0;
  return try_sample();
}

/// Whether an edge has been missed that can be waited for once more: its contact has not been told.
bool PacedOutput::missed(Nanoseconds edge, Nanoseconds now) {
  return now > edge + kLate && told_ < edge - delay_ - kFrame / 2 && in_a_row_ < kMostPauses;
}

/// The machine has stood still since its last frame, and goes on with another one.
Result<void> PacedOutput::pause() {
  ++pauses_;
  ++in_a_row_;
  began_ = clock_.now() - told_;
  owed_ = restarting_ = true;
  return {};
}

Result<void> PacedOutput::drive_due() {
  while (!held_.empty() && held_.front().time <= now()) {
    const Edge edge = held_.front();
    if (edge.closed != level_) {
      if (missed(edge.time, now())) return pause();
      if (auto driven = drive(edge); !driven) return driven;
    }
    held_.pop_front();
  }
  return {};
}

Result<void> PacedOutput::drive(const Edge& edge) {
  DrivenEdge driven;
  driven.closed = level_ = edge.closed;
  driven.before = clock_.now();
  auto sent = trigger_.send(edge.time, edge.closed);
  driven.after = clock_.now();
  driven.late = driven.before - began_ - edge.time;
  told_ = driven.before - began_;
  if (driven_.size() >= kMostDriven) return sent;
  const Nanoseconds contact = driven.before - began_ - delay_;
  driven.label = machine_.label();
  driven.q = machine_.readings(contact);
  driven.dq =
      (machine_.readings(contact + kReadingStep) - machine_.readings(contact - kReadingStep)) /
      seconds(2 * kReadingStep);
  driven_.push_back(std::move(driven));
  return sent;
}

/// A robot whose bus is down goes on.
Result<void> PacedOutput::try_sample() {
  const auto sent = send_sample();
  if (!sent && !failing_) std::fprintf(stderr, "%s\n", sent.error().what.c_str());
  failing_ = !sent;
  return {};
}

/// When the positions are to be taken, on the machine's time; nothing while the mark is awaited.
Result<std::optional<Nanoseconds>> PacedOutput::moment_of_sample(Nanoseconds looked) {
  if (!joints_.marks()) return std::optional(now() + preparing_);
  const auto edge = next_edge();
  const Nanoseconds latest = edge ? *edge - delay_ - kFrame : looked + kLongestMark;
  const auto mark = joints_.mark(std::clamp<Nanoseconds>(latest - now(), 0, kLongestMark));
  if (!mark || !*mark) return mark;
  // A mark after the contact that lies ahead: the machine has stood still for it.
  const Nanoseconds came = **mark;
  if (edge && looked < latest && came - began_ > latest) began_ = came - looked;
  return std::optional(came - began_);
}

Result<void> PacedOutput::send_sample() {
  const Nanoseconds looked = now();
  const auto moment = moment_of_sample(looked);
  if (!moment || *moment) owed_ = false;
  if (!moment) return tl::unexpected(moment.error());
  if (!*moment) return {};
  const EncoderSample sample = machine_.sample(**moment);
  q_.resize(sample.joints);
  for (int j = 0; j < sample.joints; ++j) q_[j] = machine_.scales()[j].reading(sample.counts[j]);
  told_ = **moment;
  // Now and then the processor does something else in between: that is not the usual.
  preparing_ += std::clamp<Nanoseconds>(now() - looked - preparing_, -200, 200);
  return joints_.send(**moment, q_);
}

std::string driven_text(const std::vector<DrivenEdge>& driven) {
  const auto list = [](const Eigen::VectorXd& v) {
    return std::vector<double>(v.begin(), v.end());
  };
  std::string text;
  for (const DrivenEdge& edge : driven) {
    nlohmann::ordered_json line;
    line["closed"] = edge.closed;
    line["before_ns"] = edge.before;
    line["after_ns"] = edge.after;
    line["late_ns"] = edge.late;
    line["label"] = edge.label;
    line["q"] = list(edge.q);
    line["dq"] = list(edge.dq);
    text += line.dump() + "\n";
  }
  return text;
}

}  // namespace selfcal
