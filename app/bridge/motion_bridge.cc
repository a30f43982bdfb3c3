// Motion requests of the service as goals of a trajectory controller.
#include "app/bridge/motion_bridge.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "app/bridge/approach.h"
#include "app/report/format.h"

namespace selfcal {
namespace {

using Outcome = MotionReply::Outcome;

constexpr Nanoseconds kCancelAgain = kSecond / 10;
constexpr const char* kEnds = "the bridge ends";

GoalId new_goal() {
  std::random_device random;
  GoalId goal;
  for (auto& byte : goal) byte = static_cast<std::uint8_t>(random());
  return goal;
}

}  // namespace

void MotionBridge::see(std::vector<double> q, Nanoseconds time) {
  here_ = std::move(q);
  seen_ = time;
}

Result<void> MotionBridge::look(EncoderSource& encoders, Nanoseconds now) {
  samples_.clear();
  if (auto taken = encoders.take(samples_); !taken) return taken;
  if (samples_.empty()) return {};
  const EncoderSample& last = samples_.back();
  std::vector<double> q(last.joints);
  for (int j = 0; j < last.joints; ++j) q[j] = encoders.scales()[j].reading(last.counts[j]);
  see(std::move(q), now);
  return {};
}

Result<void> MotionBridge::refuse(const MotionRequest& request, const std::string& why) {
  return service_.reply({request.id, Outcome::refused, why});
}

Result<void> MotionBridge::end(Outcome outcome, const std::string& why) {
  const MotionReply reply{move_->request.id, outcome, why};
  move_.reset();
  return service_.reply(reply);
}

std::string MotionBridge::why_not(const MotionRequest& request, Nanoseconds now) const {
  const MoveKind kind = request.kind;
  if (kind != MoveKind::travel && kind != MoveKind::touch && kind != MoveKind::retract)
    return "a trajectory controller holds every joint: it cannot " + std::string(to_string(kind));
  if (request.q.size() != joints_.size())
    return "the robot has " + std::to_string(joints_.size()) + " joints";
  for (std::size_t j = 0; j < joints_.size(); ++j)
    if (!std::isfinite(request.q[j]) || !joints_[j].allows(request.q[j]))
      return joints_[j].name + " cannot go to " + format_number(request.q[j]);
  if (!std::isfinite(request.speed) || request.speed <= 0) return "the speed is none";
  if (here_.empty()) return "no joint states have come";
  if (now - seen_ > options_.freshest) return "the joint states have ceased";
  return {};
}

Result<void> MotionBridge::begin(const MotionRequest& request, Nanoseconds now) {
  if (const std::string why = why_not(request, now); !why.empty()) return refuse(request, why);
  move_ = Move{.request = request, .goal = new_goal(), .since = now};
  return {};
}

Result<void> MotionBridge::stop(const std::string& why, Nanoseconds now) {
  if (next_) {
    const MotionReply reply{next_->id, Outcome::stopped, why};
    next_.reset();
    if (auto sent = service_.reply(reply); !sent) return sent;
  }
  if (!move_) return action_.connected() ? action_.cancel(GoalId{}) : Result<void>{};
  if (!move_->sent) return end(Outcome::stopped, why);
  if (!move_->stopping) {
    move_->why = why;
    move_->until = std::min(move_->until, now + options_.patience);
  }
  move_->stopping = true;
  move_->cancelled = now;
  return action_.cancel(move_->goal);
}

Result<void> MotionBridge::hear(const RobotRequest& request, Nanoseconds now) {
  if (request.stop) return stop(request.why, now);
  if (ending_) return refuse(request.move, kEnds);
  if (!move_) return begin(request.move, now);
  if (!move_->stopping) return refuse(request.move, "the move before has not ended");
  if (next_)
    if (auto sent = refuse(*next_, "another move was asked for"); !sent) return sent;
  next_ = request.move;
  return {};
}

Result<void> MotionBridge::send(Nanoseconds now) {
  const auto points =
      approach(here_, move_->request.q, move_->request.speed, options_.acceleration);
  move_->sent = true;
  move_->since = now;
  move_->until = now + 2 * nanoseconds(points.back().time) + options_.slack;
  return action_.send(move_->goal, points);
}

Result<void> MotionBridge::hear(const GoalNews& news, Nanoseconds now) {
  using What = GoalNews::What;
  // A goal that was given up before its server answered moves the robot where it is accepted yet.
  if (!move_ || news.goal != move_->goal)
    return news.what == What::accepted ? action_.cancel(news.goal) : Result<void>{};
  switch (news.what) {
    case What::accepted:
      move_->accepted = true;
      // A cancellation that came before the goal has found nothing to cancel.
      if (move_->stopping) {
        move_->cancelled = now;
        return action_.cancel(move_->goal);
      }
      return service_.reply({move_->request.id, Outcome::accepted, {}});
    case What::rejected:
      return end(move_->stopping ? Outcome::stopped : Outcome::refused,
                 move_->stopping ? move_->why : options_.action + " rejected the goal");
    case What::done:
      return move_->stopping ? end(Outcome::stopped, move_->why) : end(Outcome::done, {});
    case What::cancelled:
      return end(Outcome::stopped,
                 move_->stopping ? move_->why : options_.action + ": somebody else cancelled");
    case What::aborted:
      return end(Outcome::stopped,
                 move_->stopping ? move_->why : options_.action + ": " + news.why);
  }
  return {};
}

/// What does not come.
Result<void> MotionBridge::watch(Nanoseconds now) {
  if (!move_) return {};
  const bool late = now - move_->since > options_.patience;
  if (!move_->sent) {
    if (action_.connected()) return send(now);
    if (late) return end(Outcome::refused, "there is no action server " + options_.action);
    return {};
  }
  if (!action_.connected()) return end(Outcome::stopped, options_.action + " is gone");
  if (!move_->accepted && !move_->stopping && late) {
    (void)action_.cancel(move_->goal);
    return end(Outcome::refused, options_.action + " does not answer");
  }
  if (now > move_->until) {
    (void)action_.cancel(move_->goal);
    return end(Outcome::stopped,
               options_.action + (move_->stopping ? " has not confirmed the stop"
                                                  : " has not ended the move in time"));
  }
  if (!move_->stopping && now - seen_ > options_.freshest)
    return stop("the joint states have ceased", now);
  if (!move_->stopping && !service_.connected()) return stop("the service is gone", now);
  if (move_->stopping && now - move_->cancelled > kCancelAgain) {
    move_->cancelled = now;
    return action_.cancel(move_->goal);
  }
  return {};
}

Result<void> MotionBridge::turn(Nanoseconds now) {
  std::vector<RobotRequest> requests;
  if (auto taken = service_.take(requests); !taken) return taken;
  for (const RobotRequest& request : requests)
    if (auto heard = hear(request, now); !heard) return heard;
  std::vector<GoalNews> news;
  if (auto taken = action_.take(news); !taken) return taken;
  for (const GoalNews& each : news)
    if (auto heard = hear(each, now); !heard) return heard;
  if (auto watched = watch(now); !watched) return watched;
  if (move_ || !next_) return {};
  const MotionRequest request = *std::exchange(next_, std::nullopt);
  if (auto begun = begin(request, now); !begun) return begun;
  return watch(now);
}

Result<void> MotionBridge::give_up(Nanoseconds now) {
  ending_ = true;
  return move_ ? stop(kEnds, now) : Result<void>{};
}

}  // namespace selfcal
