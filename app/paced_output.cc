#include "app/paced_output.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace selfcal {
namespace {

constexpr Nanoseconds kAwake = 200'000;  // before an edge: a sleep may end so much later
constexpr Nanoseconds kFrame = 200'000;  // the frames of a sample take so long: an edge goes first
constexpr Nanoseconds kLeisure = 500'000;  // what is done between two frames takes so long
constexpr Nanoseconds kLongestMark = 5 * kMillisecond;  // waited for a mark in one turn
constexpr Nanoseconds kStep = 1000;                     // over which a speed is taken
constexpr std::size_t kMostDriven = 1'000'000;

}  // namespace

PacedOutput::PacedOutput(Machine& machine, JointSender& joints, TriggerSender& trigger,
                         Clock& clock)
    : machine_(machine),
      joints_(joints),
      trigger_(trigger),
      clock_(clock),
      began_(clock.now() - machine.now()),
      level_(machine.closed()) {}

std::optional<Nanoseconds> PacedOutput::next_edge() const {
  const auto ahead = machine_.next_edge();
  if (held_.empty()) return ahead;
  return ahead ? std::min(*ahead, held_.front().time) : held_.front().time;
}

bool PacedOutput::at_leisure() {
  const auto edge = next_edge();
  return !edge || *edge > now() + kLeisure;
}

/// False when there was news before anything was due.
bool PacedOutput::wait_for_next() {
  const auto edge = next_edge();
  const Nanoseconds sample = owed_ ? now() : machine_.next_sample();
  if (!edge || *edge >= sample + kFrame) {
    clock_.wait(sample - now());
    return now() >= sample;
  }
  clock_.wait(*edge - kAwake - now());
  if (now() < *edge - kAwake) return false;
  while (now() < *edge) {
  }
  return true;
}

Result<void> PacedOutput::turn() {
  if (!wait_for_next()) return {};
  machine_.advance(now());
  edges_.clear();
  machine_.take(edges_);
  held_.insert(held_.end(), edges_.begin(), edges_.end());
  while (!held_.empty() && held_.front().time <= now()) {
    const Edge edge = held_.front();
    held_.pop_front();
    if (edge.closed == level_) continue;
    if (auto driven = drive(edge); !driven) return driven;
  }
  samples_.clear();
  machine_.take(samples_);
  owed_ = owed_ || !samples_.empty();
  if (!owed_) return {};
  if (const auto next = next_edge(); next && *next < now() + kFrame) return {};
  // A robot whose bus is down goes on.
  const auto sent = send_sample();
  if (!sent && !failing_) std::fprintf(stderr, "%s\n", sent.error().what.c_str());
  failing_ = !sent;
  return {};
}

Result<void> PacedOutput::drive(const Edge& edge) {
  DrivenEdge driven;
  driven.closed = level_ = edge.closed;
  driven.before = clock_.now();
  auto sent = trigger_.send(edge.time, edge.closed);
  driven.after = clock_.now();
  if (driven_.size() >= kMostDriven) return sent;
  const Nanoseconds contact =
      driven.before - began_ - nanoseconds(machine_.settings().trigger_delay);
  driven.label = machine_.label();
  driven.q = machine_.readings(contact);
  driven.dq = (machine_.readings(contact + kStep) - machine_.readings(contact - kStep)) /
              seconds(2 * kStep);
  driven_.push_back(std::move(driven));
  return sent;
}

/// When the positions are to be taken, on the machine's time; nothing while the mark is awaited.
Result<std::optional<Nanoseconds>> PacedOutput::moment_of_sample() {
  if (!joints_.marks()) return std::optional(now() + preparing_);
  const auto edge = next_edge();
  const Nanoseconds longest =
      edge ? std::min(kLongestMark, *edge - kAwake - kMillisecond - now()) : kLongestMark;
  auto mark = joints_.mark(std::max<Nanoseconds>(longest, 0));
  if (mark && *mark) **mark -= began_;
  return mark;
}

Result<void> PacedOutput::send_sample() {
  const Nanoseconds looked = now();
  const auto moment = moment_of_sample();
  if (!moment || *moment) owed_ = false;
  if (!moment) return tl::unexpected(moment.error());
  if (!*moment) return {};
  const EncoderSample sample = machine_.sample(**moment);
  q_.resize(sample.joints);
  for (int j = 0; j < sample.joints; ++j)
    q_[j] = static_cast<double>(sample.counts[j]) * machine_.scales()[j].step;
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
    line["label"] = edge.label;
    line["q"] = list(edge.q);
    line["dq"] = list(edge.dq);
    text += line.dump() + "\n";
  }
  return text;
}

}  // namespace selfcal
