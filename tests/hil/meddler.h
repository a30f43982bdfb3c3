// Between the robot and the service: passes on its frames and its trigger's level, and meddles with
// them when asked.
#pragma once

#include <linux/can.h>

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "io/ports.h"
#include "tests/hil/wiring.h"

namespace selfcal {

/// Puts a frame onto the service's bus, `later` from now.
using PutFrame = std::function<void(const can_frame& frame, Nanoseconds later)>;
/// What becomes of a frame of the robot.
using FrameRule = std::function<void(const can_frame& frame, const PutFrame& put)>;
/// What becomes of the trigger's level.
using LevelRule = std::function<bool(bool closed)>;

class Meddler {
 public:
  /// Makes a bus of the robot's own, and a file that the robot takes for its trigger's line. Needs
  /// root.
  explicit Meddler(const Wiring& service);
  ~Meddler();
  Meddler(const Meddler&) = delete;
  Meddler& operator=(const Meddler&) = delete;

  /// What the robot is to be told of its wires.
  const Wiring& robot() const { return robot_; }

  void frames(FrameRule rule);
  void level(LevelRule rule);
  /// Passes all on again.
  void honest();
  /// Puts one frame of its own onto the service's bus.
  void put(const can_frame& frame) const;
  /// Drives the line whatever the robot says; the next change of the robot's ends it.
  void drive(bool closed) const;

 private:
  void run(const std::stop_token& stop);
  void pass_frames();
  void put_due();
  void pass_level();

  Wiring service_, robot_;
  int from_, to_, watch_, pull_;
  std::mutex mutex_;
  FrameRule frame_rule_;
  LevelRule level_rule_;
  bool closed_ = false;
  std::multimap<Nanoseconds, can_frame> due_;
  std::jthread thread_;
};

}  // namespace selfcal
