// A pose is Trans(x) Trans(z) · Rot(x, -90) Trans(z, y) · Rot(x, 90) R with R = Rot(z, theta1)
// Rot(x, alpha) Rot(z, theta2): rows that exist for every pose, unlike the common normal of two
// axes, which lies anywhere where they are parallel.
#include "io/models/dh_rows.h"

#include <cmath>
#include <numbers>

namespace selfcal {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;
constexpr double kNone = 1e-12;  // m, rad: below what a table can say

/// Angles of R = Rot(z, theta1) Rot(x, alpha) Rot(z, theta2).
struct Turns {
  double theta1, alpha, theta2;
};

Turns turns_of(const Eigen::Matrix3d& R) {
  const double sine = std::hypot(R(0, 2), R(1, 2));
  const double alpha = std::atan2(sine, R(2, 2));
  if (sine < kNone) return {std::atan2(R(1, 0), R(0, 0)), alpha, 0};
  return {std::atan2(R(0, 2), -R(1, 2)), alpha, std::atan2(R(2, 0), R(2, 1))};
}

std::vector<DhRow> rows_of_pose(const Eigen::Isometry3d& X) {
  const Eigen::Vector3d p = X.translation();
  const Turns turns = turns_of(X.linear());
  DhRow first;
  first.a = p.x();
  first.d = p.z();
  std::vector<DhRow> rows = {first};
  if (std::abs(p.y()) > kNone) {
    rows.resize(3);
    rows[1].alpha = -kQuarter;
    rows[1].d = p.y();
    rows[2].alpha = kQuarter;
  }
  rows.back().theta = turns.theta1;
  if (std::abs(turns.alpha) <= kNone && std::abs(turns.theta2) <= kNone) return rows;
  rows.emplace_back();
  rows.back().alpha = turns.alpha;
  rows.back().theta = turns.theta2;
  return rows;
}

}  // namespace

std::vector<DhRow> modified_rows(const serial::Model& robot) {
  std::vector<DhRow> rows;
  for (const serial::Frame& frame : robot.frames) {
    const bool fixed = frame.motion == serial::Motion::fixed;
    if (fixed && (frame.whole || std::abs(frame.value[serial::kBeta]) > kNone)) {
      int part = 0;
      for (DhRow& row : rows_of_pose(serial::pose_in_parent(frame, 0))) {
        row.name = frame.name + (part++ == 0 ? "" : "_" + std::to_string(part));
        rows.push_back(std::move(row));
      }
      continue;
    }
    rows.push_back({frame.name, frame.motion, frame.value[serial::kAlpha], frame.value[serial::kD],
                    frame.value[serial::kR], frame.value[serial::kTheta]});
  }
  return rows;
}

std::vector<DhRow> standard_rows(const std::vector<DhRow>& modified) {
  std::vector<DhRow> rows;
  const DhRow& first = modified.front();
  if (std::abs(first.alpha) > kNone || std::abs(first.a) > kNone) {
    rows.push_back({first.name + "_0"});
    rows.back().alpha = first.alpha;
    rows.back().a = first.a;
  }
  for (std::size_t i = 0; i < modified.size(); ++i) {
    const bool last = i + 1 == modified.size();
    rows.push_back(modified[i]);
    rows.back().alpha = last ? 0 : modified[i + 1].alpha;
    rows.back().a = last ? 0 : modified[i + 1].a;
  }
  return rows;
}

}  // namespace selfcal
