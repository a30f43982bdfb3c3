// A whole session: the service in a process of its own, the bridge in another, and here a
// trajectory controller that moves the simulated robot, publishes its joint states and a touch
// without a stamp.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "app/report/format.h"
#include "io/dds/context.h"
#include "io/dds/names.h"
#include "io/dds/senders.h"
#include "tests/bridge/controller.h"
#include "tests/support/bridged_session.h"
#include "tests/support/program.h"

namespace selfcal {
namespace {

constexpr const char* kArm = "/arm/follow_joint_trajectory";

class RosRobot {
 public:
  explicit RosRobot(const Cell& cell)
      : machine_(cell.machine()),
        participant_(must(DdsParticipant::open(cell.domain, "ros robot"))),
        config_(must(load_config(cell.folder / "config.yaml"))),
        joints_(must(config_.encoders->open_sender({{participant_}, wakeup_, {}}))),
        touch_(must(DdsWriter<dds::Bool>::open(participant_, ros_topic("touch"), {.depth = 64}))),
        controller_(participant_, kArm, wakeup_),
        thread_([this] { play(); }) {}
  ~RosRobot() {
    ends_ = true;
    thread_.join();
  }
  int goals() const { return goals_; }
  int cancelled() const { return cancelled_; }

 private:
  void play() {
    const Nanoseconds began = monotonic_now(), wall = unix_now_ms() * kMillisecond;
    while (!ends_) {
      machine_->advance(monotonic_now() - began);
      controller_.hear();
      obey();
      samples_.clear();
      edges_.clear();
      machine_->take(samples_);
      machine_->take(edges_);
      for (const EncoderSample& sample : samples_) {
        std::vector<double> q(sample.joints);
        for (int j = 0; j < sample.joints; ++j)
          q[j] = static_cast<double>(sample.counts[j]) * machine_->scales()[j].step;
        (void)joints_->send(wall + sample.time, q);
      }
      for (const Edge& edge : edges_) publish_touch(wall + edge.time, edge.closed);
      if (machine_->now() - published_ > kSecond / 10)
        publish_touch(wall + machine_->now(), machine_->closed());
      answer();
      wakeup_.wait(2 * kMillisecond);
    }
  }
  void publish_touch(Nanoseconds stamp, bool closed) {
    published_ = machine_->now();
    const dds::Bool level{closed};
    EXPECT_EQ(dds_write_ts(touch_.handle(), &level, stamp), 0);
  }
  void obey() {
    for (const auto& goal : controller_.goals) {
      double speed = 0;
      for (const TrajectoryPoint& point : goal.points)
        for (const double dq : point.dq) speed = std::max(speed, std::abs(dq));
      controller_.accept(goal);
      now_ = goal.goal;
      machine_->request({.id = static_cast<std::uint64_t>(++goals_),
                         .label = "",
                         .q = goal.points.back().q,
                         .speed = std::max(speed, 1e-6)});
    }
    for (const auto& cancel : controller_.cancels) {
      controller_.confirm_cancel(cancel);
      if (cancel.goal == now_ || cancel.goal == GoalId{}) machine_->stop("cancelled");
    }
    controller_.goals.clear();
    controller_.cancels.clear();
  }
  void answer() {
    std::vector<MotionReply> replies;
    machine_->take(replies);
    for (const MotionReply& reply : replies) {
      if (reply.outcome == MotionReply::Outcome::accepted) continue;
      if (reply.outcome == MotionReply::Outcome::stopped) ++cancelled_;
      status_[now_] = reply.outcome == MotionReply::Outcome::done      ? 4
                      : reply.outcome == MotionReply::Outcome::stopped ? 5
                                                                       : 6;
    }
    std::erase_if(controller_.asked, [&](const FakeController::Call& asked) {
      const auto found = status_.find(asked.goal);
      if (found == status_.end()) return false;
      controller_.finish(asked, found->second);
      return true;
    });
  }

  Wakeup wakeup_;
  std::unique_ptr<Machine> machine_;
  DdsParticipant participant_;
  Config config_;
  std::unique_ptr<JointSender> joints_;
  DdsWriter<dds::Bool> touch_;
  FakeController controller_;
  GoalId now_{};
  std::map<GoalId, int> status_;
  std::vector<EncoderSample> samples_;
  std::vector<Edge> edges_;
  Nanoseconds published_ = 0;
  std::atomic<int> goals_ = 0, cancelled_ = 0;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

TEST(BridgedSession, TouchesThroughAControllerOfRosAndImprovesTheRobot) {
  CellOptions options;
  options.live = true;
  options.touches = 12;
  Cell cell(options);
  RosRobot robot(cell);
  const std::size_t taken = calibrate_through_bridge(cell, kArm);
  std::printf("%d goals, %d of them cancelled\n", robot.goals(), robot.cancelled());
  // A machine that stalls for longer than the way beyond the surface takes lets a goal end by
  // itself.
  EXPECT_GE(robot.cancelled(), 0.95 * static_cast<double>(taken))
      << "each touch ends by a cancelled goal";
}

TEST(BridgeCommand, RefusesATouchWhereTheKernelStampsTheTrigger) {
  const Ran ran = run_selfcal("bridge " SELFCAL_SOURCE_DIR
                              "/app/examples/rx90_can_gpio.config.yaml --action /a --touch t");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.out.find("need a trigger of kind dds"), std::string::npos) << ran.out;
}

}  // namespace
}  // namespace selfcal
