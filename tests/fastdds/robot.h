// The simulated robot of a cell behind a driver on Fast DDS: joint states and a touch published,
// and moves taken either as the service asks for them or as goals of a trajectory controller.
#pragma once

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "io/wakeup.h"
#include "sim/machine.h"
#include "tests/fastdds/peer.h"
#include "tests/support/cell.h"

namespace selfcal {

class FastRobot {
 public:
  explicit FastRobot(const Cell& cell);
  virtual ~FastRobot() = default;
  /// Moves that were asked for, and those of them that were stopped.
  int moves() const { return moves_; }
  int stopped() const { return stopped_; }

 protected:
  /// Plays until end(), from the end of the constructor of who derives on.
  void begin();
  void end();
  void move(std::uint64_t id, std::vector<double> q, double speed);
  void stop() { machine_->stop("asked to"); }

  FastPeer peer_;

 private:
  virtual void hear() = 0;
  virtual void tell(const MotionReply& reply) = 0;
  virtual void publish_touch(std::int64_t stamp, bool closed) = 0;
  void play();

  std::unique_ptr<Machine> machine_;
  std::vector<std::string> joints_;
  FastWriter states_;
  std::atomic<int> moves_ = 0, stopped_ = 0;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

/// A driver that knows selfcal's messages.
class FastDriver final : public FastRobot {
 public:
  explicit FastDriver(const Cell& cell);
  ~FastDriver() override { end(); }

 private:
  void hear() override;
  void tell(const MotionReply& reply) override;
  void publish_touch(std::int64_t stamp, bool closed) override;

  FastReader requests_;
  FastWriter replies_, touch_;
};

/// A trajectory controller of ROS 2 on rmw_fastrtps, and a touch as std_msgs/Bool.
class FastController final : public FastRobot {
 public:
  FastController(const Cell& cell, const std::string& action, const std::string& touch);
  ~FastController() override { end(); }
  /// Goals are refused from here on.
  void refuse() { refuses_ = true; }

 private:
  using Goal = std::array<std::uint8_t, 16>;
  void hear() override;
  void tell(const MotionReply& reply) override;
  void publish_touch(std::int64_t stamp, bool closed) override;
  void publish_status();

  FastReader goals_, cancels_;
  FastWriter accepted_, cancelled_, status_, touch_;
  std::map<Goal, std::int8_t> known_;
  Goal now_{};
  std::atomic<bool> refuses_ = false;
};

}  // namespace selfcal
