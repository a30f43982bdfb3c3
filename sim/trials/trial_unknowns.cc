// Causes that no list has: what is right to say of them is `unknown`.
#include <algorithm>
#include <cmath>

#include "sim/trials/trial_causes.h"

namespace selfcal {
namespace {

/// After-effect of a joint: it keeps a part of how it gave way to what it carried before. (Play of
/// the torque would not do: reached from anywhere, it follows the torque as compliance does.)
TrialCause hysteresis(const TrialWorld& world, Random& random) {
  const int j = std::min(1 + pick(random, 2), world.joints() - 1);
  const double most = world.largest_torque(j);
  std::vector<double> kept;
  double before = 0, now = 0;
  for (size_t i = 0; i < world.rows.size(); ++i) {
    if (i == 0 || world.rows[i].configuration != world.rows[i - 1].configuration) before = now;
    now = world.torque(world.rows[i], j) / most;
    kept.push_back(before);
  }
  return {.physics = "after-effect of the torque before",
          .act = [=](const Instant& at, Deviation& out) {
            out.joints[j] += 5e-5 * kept[static_cast<size_t>(at.row)];
          }};
}

/// Of both angles together only: what is left of the product by one of them alone would be a
/// coupling or a transmission error, which have names.
TrialCause cross_coupling(const TrialWorld& world, Random& random) {
  const int n = world.joints();
  const int j = pick(random, n), a = std::min(1, n - 1), b = std::min(2, n - 1);
  const double phase = uniform(random, 0.1, 0.6);
  double mean_a = 0, mean_b = 0;
  for (const Instant& row : world.rows) {
    mean_a += std::sin(row.q[a]) / static_cast<double>(world.rows.size());
    mean_b += std::sin(row.q[b] + phase) / static_cast<double>(world.rows.size());
  }
  return {.physics = "the product of two angles", .act = [=](const Instant& at, Deviation& out) {
            out.joints[j] +=
                1e-4 * (std::sin(at.q[a]) - mean_a) * (std::sin(at.q[b] + phase) - mean_b);
          }};
}

TrialCause wobble(const TrialWorld& world, Random& random) {
  const int elbow =
      world.on_legs()
          ? 0
          : world.robot->statics()->mechanics().link_of(std::min(3, world.joints() - 1));
  const double waves = uniform(random, 6, 12), phase = uniform(random, 0, 6.28);
  const int axis = pick(random, 3);
  return {.physics = "the tool wobbles with the elbow's height",
          .act = [=](const Instant& at, Deviation& out) {
            const double height = at.poses[static_cast<size_t>(elbow)].translation().z();
            out.tip += 5e-5 * std::sin(waves * height + phase) * at.poses.back().linear().col(axis);
          }};
}

TrialCause settled_differently(const TrialWorld& world, Random& random) {
  std::vector<Eigen::Vector3d> offset;
  for (size_t i = 0; i < world.rows.size(); ++i)
    offset.emplace_back(normal(random), normal(random), normal(random));
  return {.physics = "an offset of its own in every configuration, shared by its repeats",
          .act = [=](const Instant& at, Deviation& out) {
            out.tip += 3e-5 * offset[static_cast<size_t>(at.configuration)];
          }};
}

TrialCause far_from_base(const TrialWorld&, Random& random) {
  const bool aside = chance(random, 0.5);  // not downwards: that is what compliance does
  return {.physics = "quadratic in the distance from the base",
          .act = [=](const Instant& at, Deviation& out) {
            const Eigen::Vector3d p = at.poses.back().translation();
            const Eigen::Vector3d out_there(p.x(), p.y(), 0), left(-p.y(), p.x(), 0);
            out.tip += 1e-4 * p.head<2>().norm() * (aside ? left : out_there);
          }};
}

}  // namespace

TrialCause draw_unknown(const TrialWorld& world, Random& random) {
  constexpr CauseMaker kMakers[] = {hysteresis, cross_coupling, wobble, settled_differently,
                                    far_from_base};
  TrialCause cause = kMakers[pick(random, 5)](world, random);
  cause.effect = "unknown";
  return cause;
}

}  // namespace selfcal
