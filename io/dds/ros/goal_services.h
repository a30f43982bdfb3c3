// An action's services as one implementation of ROS 2's middleware has them on the wire: what
// TrajectoryAction speaks through, once it knows whose the server is.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/dds/endpoint.h"
#include "io/dds/ros/action_types.h"

namespace selfcal {

using GoalId = std::array<std::uint8_t, 16>;

struct TrajectoryPoint {
  double time = 0;            ///< s after the start
  std::vector<double> q, dq;  ///< by joint (rad or m, and per second)
};

/// What an action's server said of a goal.
struct GoalNews {
  enum class What : std::uint8_t { accepted, rejected, done, cancelled, aborted };
  GoalId goal{};
  What what = What::rejected;
  std::string why;  ///< of `aborted`: the error's name and the server's words
};

class GoalServices {
 public:
  virtual ~GoalServices() = default;
  /// Whether a server is there that all of it reaches, and that encodes as this does.
  virtual bool connected() const = 0;
  /// Whether the server that is there encodes in another way.
  virtual bool other_encoding() const = 0;
  virtual Result<void> send(const GoalId& goal, const std::vector<TrajectoryPoint>& points) = 0;
  virtual Result<void> cancel(const GoalId& goal) = 0;
  virtual Result<void> take(std::vector<GoalNews>& out) = 0;
};

/// Points as a goal of the library's, for as long as this lives.
class BorrowedGoal {
 public:
  BorrowedGoal(const std::vector<std::string>& joints, const std::vector<TrajectoryPoint>& points);
  selfcal_ros_Goal goal() const;

 private:
  std::vector<char*> names_;
  std::vector<selfcal_ros_JointTrajectoryPoint> points_;
};

/// Whose participants write to a reader: those of Fast DDS are known by their ids, which begin with
/// their vendor's number (01 0f).
struct WritersByVendor {
  int fast_dds = 0, others = 0;
};
WritersByVendor writers_by_vendor(dds_entity_t reader);

}  // namespace selfcal
