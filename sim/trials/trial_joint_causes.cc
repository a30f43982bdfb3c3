// What happens in joints and links.
//   joint_compliance   delta q = c tau / (1 + k |tau|), by true masses
//   link_compliance    curvature of a beam times its bending moment, integrated along it
//   transmission_error A (sin(q + a) + B sin(2 q + b) + C sin(N q + c))
//   backlash           -play / 2 (1 - w |tau| / most) tanh(dq / dq0): load takes up some of it
//   joint_coupling     kappa (q_i + 0.1 sin q_i)
//   zero_shift         a step within some seconds
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/trials/trial_causes.h"

namespace selfcal {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kLeastTorque = 0.1;  // N m

TrialCause joint_compliance(const TrialWorld& world, Random& random) {
  std::vector<ActingJoint> joints = draw_joints(world, random, 0.4);
  std::vector<double> stiffening;
  for (ActingJoint& each : joints) {
    const double most = world.largest_torque(each.joint);
    if (most < kLeastTorque) return {};  // an upright axis
    stiffening.push_back(uniform(random, 0, 0.5) / most);
    each.share *= 1e-4 / most;
  }
  return {.where = names_of(joints),
          .physics = "stiffening springs, true masses",
          .act = [=, &world](const Instant& at, Deviation& out) {
            for (size_t i = 0; i < joints.size(); ++i) {
              const double tau = world.torque(at, joints[i].joint);
              out.joints[joints[i].joint] +=
                  joints[i].share * tau / (1 + stiffening[i] * std::abs(tau));
            }
          }};
}

/// Links of some length, by the joint that moves them.
std::vector<int> beams(const TrialWorld& world) {
  std::vector<int> found;
  const auto& poses = world.rows.front().poses;
  for (int j = 0; j < world.joints(); ++j) {
    const auto k = static_cast<size_t>(world.robot->statics()->mechanics().link_of(j));
    if (k + 1 < poses.size() && (poses[k + 1].translation() - poses[k].translation()).norm() > 0.08)
      found.push_back(j);
  }
  return found;
}

TrialCause link_compliance(const TrialWorld& world, Random& random) {
  const std::vector<int> long_ones = beams(world);
  if (long_ones.empty()) return {};
  const int joint =
      long_ones[static_cast<size_t>(pick(random, static_cast<int>(long_ones.size())))];
  const auto link = static_cast<size_t>(world.robot->statics()->mechanics().link_of(joint));
  const Eigen::Vector3d give(1, uniform(random, 0.6, 1.5), uniform(random, 0.3, 1.2));
  return {.where = {world.links()[link].frame, world.links()[link + 1].frame},
          .physics = "a beam under the moment along it",
          .act = [=, &world](const Instant& at, Deviation& out) {
            const Eigen::Vector3d foot = at.poses[link].translation();
            const Eigen::Vector3d end = at.poses[link + 1].translation();
            const Eigen::Vector3d tip = at.poses.back().translation();
            const Eigen::Matrix3d R = at.poses[link].linear();
            constexpr int kPieces = 6;
            for (int i = 0; i < kPieces; ++i) {
              const Eigen::Vector3d here = foot + (i + 0.5) / kPieces * (end - foot);
              Eigen::Vector3d force, moment;
              world.load(at, static_cast<int>(link) + 1, here, force, moment);
              const Eigen::Vector3d turned =
                  R * give.cwiseProduct(R.transpose() * moment) * (1e-6 / kPieces);
              out.tip += turned.cross(tip - here);
            }
          }};
}

TrialCause transmission_error(const TrialWorld& world, Random& random) {
  const std::vector<ActingJoint> joints = draw_joints(world, random, 0.4);
  struct Gear {
    double phase[3], second, order, share;
  };
  std::vector<Gear> gears;
  for (size_t i = 0; i < joints.size(); ++i)
    gears.push_back(
        {{uniform(random, 0, kTurn), uniform(random, 0, kTurn), uniform(random, 0, kTurn)},
         uniform(random, 0.1, 0.5),
         static_cast<double>(7 + pick(random, 44)),
         uniform(random, 0.1, 0.3)});
  return {.where = names_of(joints),
          .physics = "first and second harmonic and a gear order, with phases",
          .act = [=](const Instant& at, Deviation& out) {
            for (size_t i = 0; i < joints.size(); ++i) {
              const Gear& g = gears[i];
              const double q = at.q[joints[i].joint];
              out.joints[joints[i].joint] +=
                  1e-4 * joints[i].share *
                  (std::sin(q + g.phase[0]) + g.second * std::sin(2 * q + g.phase[1]) +
                   g.share * std::sin(g.order * q + g.phase[2]));
            }
          }};
}

TrialCause backlash(const TrialWorld& world, Random& random) {
  const std::vector<ActingJoint> joints = draw_joints(world, random, 0.5);
  std::vector<double> most;
  for (const ActingJoint& each : joints) most.push_back(world.largest_torque(each.joint));
  const double taken_up = uniform(random, 0, 0.5);
  return {.where = names_of(joints),
          .physics = "play that load takes up in part",
          .act = [=, &world](const Instant& at, Deviation& out) {
            for (size_t i = 0; i < joints.size(); ++i) {
              const int j = joints[i].joint;
              const double loaded = std::abs(world.torque(at, j)) / most[i];
              out.joints[j] -= 5e-5 * joints[i].share * (1 - taken_up * loaded) *
                               std::tanh(at.velocity[j] / 1e-4);
            }
          }};
}

TrialCause joint_coupling(const TrialWorld& world, Random& random) {
  const int n = world.joints();
  if (n < 2) return {};
  const int from = pick(random, n);
  int to = chance(random, 0.6) ? std::min(from + 1, n - 1) : pick(random, n);
  if (to == from) to = from > 0 ? from - 1 : 1;
  return {.where = {world.robot->joints()[static_cast<size_t>(to)].name},
          .physics = "nearly proportional to another joint",
          .act = [=](const Instant& at, Deviation& out) {
            out.joints[to] += 1e-4 * (at.q[from] + 0.1 * std::sin(at.q[from]));
          }};
}

TrialCause zero_shift(const TrialWorld& world, Random& random) {
  const std::vector<ActingJoint> joints = draw_joints(world, random, 0);
  const double moment = uniform(random, 0.2, 0.8) * world.duration;
  return {.where = names_of(joints),
          .physics = "a step of one joint's zero",
          .act = [=](const Instant& at, Deviation& out) {
            out.joints[joints.front().joint] +=
                1e-4 / (1 + std::exp(-std::clamp((at.time - moment) / 2, -50.0, 50.0)));
          }};
}

}  // namespace

const std::map<std::string, CauseMaker>& joint_causes() {
  static const std::map<std::string, CauseMaker> causes{
      {"joint_compliance", joint_compliance},     {"link_compliance", link_compliance},
      {"transmission_error", transmission_error}, {"backlash", backlash},
      {"joint_coupling", joint_coupling},         {"zero_shift", zero_shift}};
  return causes;
}

}  // namespace selfcal
