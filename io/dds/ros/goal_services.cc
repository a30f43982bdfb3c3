// What the encodings of an action's services share.
#include "io/dds/ros/goal_services.h"

#include <algorithm>
#include <cmath>

#include "io/dds/convert.h"

namespace selfcal {
namespace {

selfcal_ros_Duration ros_duration(double time) {
  const auto whole = static_cast<std::int32_t>(std::floor(time));
  return {.sec_ = whole, .nanosec_ = static_cast<std::uint32_t>((time - whole) * 1e9)};
}

template <class Sequence, class Item>
Sequence lent(const std::vector<Item>& items) {
  const auto size = static_cast<std::uint32_t>(items.size());
  return {size, size, const_cast<Item*>(items.data()), false};
}

const std::string kNoFrame;

}  // namespace

BorrowedGoal::BorrowedGoal(const std::vector<std::string>& joints,
                           const std::vector<TrajectoryPoint>& points)
    : points_(points.size()) {
  for (const std::string& joint : joints) names_.push_back(borrowed::text(joint));
  for (std::size_t i = 0; i < points.size(); ++i) {
    points_[i].positions_ = lent<decltype(points_[i].positions_)>(points[i].q);
    points_[i].velocities_ = lent<decltype(points_[i].velocities_)>(points[i].dq);
    points_[i].time_from_start_ = ros_duration(points[i].time);
  }
}

selfcal_ros_Goal BorrowedGoal::goal() const {
  selfcal_ros_Goal goal{};
  auto& trajectory = goal.trajectory_;
  trajectory.header_.frame_id_ = borrowed::text(kNoFrame);  // its stamp of zero: at once
  trajectory.joint_names_ = lent<decltype(trajectory.joint_names_)>(names_);
  trajectory.points_ = lent<decltype(trajectory.points_)>(points_);
  goal.multi_dof_trajectory_.header_.frame_id_ = borrowed::text(kNoFrame);
  return goal;
}

WritersByVendor writers_by_vendor(dds_entity_t reader) {
  WritersByVendor count;
  for (const dds_instance_handle_t writer : writers_heard(reader)) {
    dds_builtintopic_endpoint_t* found = dds_get_matched_publication_data(reader, writer);
    if (!found) continue;
    const bool fast = found->participant_key.v[0] == 0x01 && found->participant_key.v[1] == 0x0f;
    ++(fast ? count.fast_dds : count.others);
    dds_builtintopic_free_endpoint(found);
  }
  return count;
}

}  // namespace selfcal
