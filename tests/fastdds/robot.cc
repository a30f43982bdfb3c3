#include "tests/fastdds/robot.h"

#include <gtest/gtest.h>

#include "app/service/config/config.h"
#include "io/clock.h"
#include "tests/fastdds/cdr.h"

namespace selfcal {
namespace {

using Outcome = MotionReply::Outcome;

FastTopic of_robot(const Cell& cell, const std::string& name, const std::string& type) {
  return {"rt/selfcal/" + cell.options.id + "/" + name, "selfcal_msgs::msg::dds_::" + type + "_"};
}

// action_msgs/msg/GoalStatus
constexpr std::int8_t kExecuting = 2, kSucceeded = 4, kCanceled = 5, kAborted = 6;

}  // namespace

FastRobot::FastRobot(const Cell& cell)
    : peer_(cell.domain),
      machine_(cell.machine()),
      joints_(must(load_config(cell.folder / "config.yaml")).joint_names),
      states_(peer_.writer({"rt/joint_states", "sensor_msgs::msg::dds_::JointState_"})) {}

void FastRobot::begin() {
  thread_ = std::thread([this] { play(); });
}

void FastRobot::end() {
  ends_ = true;
  thread_.join();
}

void FastRobot::move(std::uint64_t id, std::vector<double> q, double speed) {
  ++moves_;
  machine_->request({.id = id, .label = "", .q = std::move(q), .speed = std::max(speed, 1e-6)});
}

void FastRobot::play() {
  const Nanoseconds began = monotonic_now(), wall = realtime_now();
  Nanoseconds changed = wall, repeated = 0;
  Wakeup pace;
  std::vector<EncoderSample> samples;
  std::vector<Edge> edges;
  std::vector<MotionReply> replies;
  while (!ends_) {
    machine_->advance(monotonic_now() - began);
    hear();
    samples.clear(), edges.clear(), replies.clear();
    machine_->take(samples);
    machine_->take(edges);
    machine_->take(replies);
    for (const EncoderSample& sample : samples) {
      std::vector<double> q(sample.joints);
      for (int j = 0; j < sample.joints; ++j)
        q[j] = static_cast<double>(sample.counts[j]) * machine_->scales()[j].step;
      CdrOut out;
      out.header(wall + sample.time).texts(joints_).numbers(q).numbers({}).numbers({});
      states_.write(out.bytes());
    }
    for (const Edge& edge : edges) publish_touch(changed = wall + edge.time, edge.closed);
    // Repeated with the stamp of the change, for who comes late and for what gets lost on the way.
    if (machine_->now() - repeated > kSecond / 10) {
      repeated = machine_->now();
      publish_touch(changed, machine_->closed());
    }
    for (const MotionReply& reply : replies) {
      stopped_ += reply.outcome == Outcome::stopped;
      tell(reply);
    }
    pace.wait(2 * kMillisecond);
  }
}

FastDriver::FastDriver(const Cell& cell)
    : FastRobot(cell),
      requests_(peer_.reader(of_robot(cell, "motion_request", "MotionRequest"))),
      replies_(peer_.writer(of_robot(cell, "motion_reply", "MotionReply"))),
      touch_(peer_.writer(of_robot(cell, "trigger", "StampedBool"))) {
  begin();
}

void FastDriver::hear() {
  for (const auto& message : requests_.take()) {
    CdrIn in(message.bytes);
    const auto id = in.number<std::uint64_t>();
    const std::string kind = in.text();
    (void)in.text();  // the label
    std::vector<double> q = in.numbers();
    const double speed = in.number<double>();
    (void)in.text();  // why
    ASSERT_TRUE(in.ended()) << message.bytes.size() << " bytes";
    kind == "stop" ? stop() : move(id, std::move(q), speed);
  }
}

void FastDriver::tell(const MotionReply& reply) {
  CdrOut out;
  out.add(reply.id);
  out.text(reply.outcome == Outcome::accepted  ? "accepted"
           : reply.outcome == Outcome::done    ? "done"
           : reply.outcome == Outcome::stopped ? "stopped"
                                               : "refused");
  replies_.write(out.text(reply.why).bytes());
}

void FastDriver::publish_touch(std::int64_t stamp, bool closed) {
  touch_.write(CdrOut().header(stamp).add(static_cast<std::uint8_t>(closed)).bytes());
}

FastController::FastController(const Cell& cell, const std::string& action,
                               const std::string& touch)
    : FastRobot(cell),
      goals_(peer_.reader({"rq" + action + "/_action/send_goalRequest",
                           "control_msgs::action::dds_::FollowJointTrajectory_SendGoal_Request_"})),
      cancels_(peer_.reader({"rq" + action + "/_action/cancel_goalRequest",
                             "action_msgs::srv::dds_::CancelGoal_Request_"})),
      accepted_(
          peer_.writer({"rr" + action + "/_action/send_goalReply",
                        "control_msgs::action::dds_::FollowJointTrajectory_SendGoal_Response_"})),
      cancelled_(peer_.writer({"rr" + action + "/_action/cancel_goalReply",
                               "action_msgs::srv::dds_::CancelGoal_Response_"})),
      status_(peer_.writer({"rt" + action + "/_action/status",
                            "action_msgs::msg::dds_::GoalStatusArray_", true, true})),
      touch_(peer_.writer({"rt/" + touch, "std_msgs::msg::dds_::Bool_"})) {
  begin();
}

void FastController::hear() {
  for (const auto& message : goals_.take()) {
    CdrIn in(message.bytes);
    for (auto& byte : now_) byte = in.number<std::uint8_t>();
    EXPECT_EQ(in.time(), 0);  // at once
    (void)in.text();          // the frame
    (void)in.texts();         // the joints
    std::vector<double> q;
    double speed = 0;
    for (auto left = in.number<std::uint32_t>(); left > 0 && in.good(); --left) {
      q = in.numbers();
      for (const double dq : in.numbers()) speed = std::max(speed, std::abs(dq));
      (void)in.numbers(), (void)in.numbers();  // accelerations, effort
      (void)in.time();
    }
    ASSERT_TRUE(in.good() && !q.empty());
    accepted_.reply(CdrOut().add(static_cast<std::uint8_t>(!refuses_)).add(0).add(0u).bytes(),
                    message.identity);
    if (refuses_) continue;
    known_[now_] = kExecuting;
    publish_status();
    move(1, std::move(q), speed);
  }
  for (const auto& message : cancels_.take()) {
    CdrIn in(message.bytes);
    Goal goal;
    for (auto& byte : goal) byte = in.number<std::uint8_t>();
    (void)in.time();
    ASSERT_TRUE(in.ended());
    cancelled_.reply(CdrOut().add(std::int8_t{0}).add(0u).bytes(), message.identity);
    if (goal == now_ || goal == Goal{}) stop();
  }
}

void FastController::tell(const MotionReply& reply) {
  if (reply.outcome == Outcome::accepted) return;
  known_[now_] = reply.outcome == Outcome::done      ? kSucceeded
                 : reply.outcome == Outcome::stopped ? kCanceled
                                                     : kAborted;
  publish_status();
}

void FastController::publish_status() {
  CdrOut out;
  out.add(static_cast<std::uint32_t>(known_.size()));
  for (const auto& [goal, status] : known_) {
    for (const std::uint8_t byte : goal) out.add(byte);
    out.add(0).add(0u).add(status);
  }
  status_.write(out.bytes());
}

void FastController::publish_touch(std::int64_t stamp, bool closed) {
  touch_.write(CdrOut().add(static_cast<std::uint8_t>(closed)).bytes(), stamp);
}

}  // namespace selfcal
