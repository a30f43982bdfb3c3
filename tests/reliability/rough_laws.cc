// Each law moves by about 1e-4 (rad, m) at size 1; the trial sets its size by what is visible.
#include "tests/reliability/rough_laws.h"

#include <algorithm>
#include <cmath>

namespace selfcal {
namespace {

constexpr double kSome = 1e-4;

double sign_of(double x) { return x < 0 ? -1 : 1; }

/// What the load on a joint was before each row, forgotten at `rate` from one configuration to the
/// next.
std::vector<double> memory_of(const TrialWorld& world, int joint, double rate) {
  std::vector<double> list;
  double kept = 0, now = 0;
  for (size_t i = 0; i < world.rows.size(); ++i) {
    if (i > 0 && world.rows[i].configuration != world.rows[i - 1].configuration)
      kept = rate * kept + (1 - rate) * now;
    now = world.torque(world.rows[i], joint);
    list.push_back(kept);
  }
  return list;
}

/// Gives way only beyond friction, softer beyond a stop, and creeps towards what it held before.
TrialCause rough_compliance(const TrialWorld& world, Random& random) {
  const ActingJoint joint = draw_joints(world, random, 0).front();
  const double most = world.largest_torque(joint.joint);
  if (most < 0.1) return {};
  const double friction = uniform(random, 0.03, 0.12) * most,
               stop = uniform(random, 0.4, 0.7) * most;
  const double creep = uniform(random, 0.05, 0.2);
  const std::vector<double> before = memory_of(world, joint.joint, 0.6);
  return {.where = {joint.name},
          .physics = "gives way beyond friction, softer beyond a stop, creeps",
          .act = [=, &world](const Instant& at, Deviation& out) {
            const double tau = world.torque(at, joint.joint), size = std::abs(tau);
            double way = std::max(0.0, size - friction) + 0.3 * std::max(0.0, size - stop);
            way *= sign_of(tau);
            way += creep * (before[static_cast<size_t>(at.row)] - tau);
            out.joints[joint.joint] += kSome * way / most;
          }};
}

/// A beam whose flange opens: it bends twice as far once the moment about it exceeds the preload,
/// and more one way than the other.
TrialCause rough_beam(const TrialWorld& world, Random& random) {
  std::vector<size_t> beams;
  const auto& poses = world.rows.front().poses;
  for (int j = 0; j < world.joints(); ++j) {
    const auto k = static_cast<size_t>(world.robot->statics()->mechanics().link_of(j));
    if (k + 1 < poses.size() && (poses[k + 1].translation() - poses[k].translation()).norm() > 0.1)
      beams.push_back(k);
  }
  if (beams.empty()) return {};
  const size_t link = beams[static_cast<size_t>(pick(random, static_cast<int>(beams.size())))];
  const auto moment_of = [&world, link](const Instant& at) {
    Eigen::Vector3d force, moment;
    world.load(at, static_cast<int>(link) + 1, at.poses[link].translation(), force, moment);
    return moment;
  };
  double most = 0;
  for (const Instant& row : world.rows) most = std::max(most, moment_of(row).norm());
  if (most < 1) return {};
  const double preload = uniform(random, 0.3, 0.7) * most, one_way = uniform(random, 0.7, 1.4);
  return {.where = {world.links()[link].frame, world.links()[link + 1].frame},
          .physics = "a beam whose flange opens beyond its preload",
          .act = [=](const Instant& at, Deviation& out) {
            const Eigen::Vector3d moment = moment_of(at);
            double way = moment.norm() + std::max(0.0, moment.norm() - preload);
            if (moment.dot(at.poses[link].linear().col(1)) > 0) way *= one_way;
            out.tip += kSome / most * way *
                       moment.normalized().cross(
                           at.poses.back().translation() -
                           0.5 * (at.poses[link].translation() + at.poses[link + 1].translation()));
          }};
}

/// Play that is taken up at once, that sticks where the joint hardly moves, and wears in a sector.
TrialCause rough_backlash(const TrialWorld& world, Random& random) {
  const ActingJoint joint = draw_joints(world, random, 0).front();
  const int j = joint.joint;
  const double from = uniform(random, -2, 1), worn = uniform(random, 0.2, 0.6);
  std::vector<double> side;
  double last = 1;
  for (const Instant& row : world.rows) {
    if (std::abs(row.velocity[j]) > 0.1 * row.velocity.norm()) last = sign_of(row.velocity[j]);
    side.push_back(last);
  }
  return {.where = {joint.name},
          .physics = "play that sticks, wider in a worn sector",
          .act = [=](const Instant& at, Deviation& out) {
            const bool in_worn = at.q[j] > from && at.q[j] < from + 1;
            out.joints[j] -= kSome * side[static_cast<size_t>(at.row)] * (in_worn ? 1 + worn : 1);
          }};
}

/// A tooth higher than the others once a turn, and a saw of the gear's order.
TrialCause rough_transmission(const TrialWorld& world, Random& random) {
  const ActingJoint joint = draw_joints(world, random, 0).front();
  const double teeth = static_cast<double>(3 + pick(random, 6)), phase = uniform(random, 0, 1);
  const double asymmetry = uniform(random, 0.55, 0.85);
  return {.where = {joint.name},
          .physics = "a saw of uneven flanks",
          .act = [=](const Instant& at, Deviation& out) {
            const double turns = teeth * at.q[joint.joint] / 6.283185307179586 + phase;
            const double u = turns - std::floor(turns);
            const double saw = u < asymmetry ? u / asymmetry : (1 - u) / (1 - asymmetry);
            out.joints[joint.joint] += kSome * (2 * saw - 1);
          }};
}

/// Follows the other joint, but with a dead band, and otherwise than it came.
TrialCause rough_coupling(const TrialWorld& world, Random& random) {
  const std::vector<ActingJoint> joints = draw_joints(world, random, 1);
  const int to = joints[0].joint, from = joints[1].joint;
  const double band = uniform(random, 0.05, 0.2);
  std::vector<double> followed;
  double kept = 0;
  for (const Instant& row : world.rows) {
    kept = std::clamp(kept, row.q[from] - band, row.q[from] + band);
    followed.push_back(kept);
  }
  return {.where = {joints[0].name},
          .physics = "a cable that slips before it pulls",
          .act = [=](const Instant& at, Deviation& out) {
            out.joints[to] += kSome * followed[static_cast<size_t>(at.row)];
          }};
}

/// A fast and a slow body, and a fan that comes on at a threshold.
TrialCause rough_expansion(const TrialWorld& world, Random& random) {
  const AirRecord fast = world.air.lagged(uniform(random, 200, 600)),
                  slow = world.air.lagged(uniform(random, 2500, 6000));
  const double fan = uniform(random, 0.4, 0.7);
  const double first = world.air.celsius.front();
  const double top = *std::max_element(fast.celsius.begin(), fast.celsius.end());
  return {.where = {},
          .physics = "two bodies, and a fan beyond a temperature",
          .act = [=, &world](const Instant& at, Deviation& out) {
            const double warm = fast.at(at.time) - first;
            const double cooled = warm > fan * (top - first) ? 0.85 : 1;
            const double grown = 0.6 * cooled * warm + 0.4 * (slow.at(at.time) - first);
            for (size_t k = 1; k < at.poses.size(); ++k)
              if (world.links()[k].joint >= 0)
                out.tip +=
                    1.2e-5 * grown * (at.poses[k].translation() - at.poses[k - 1].translation());
          }};
}

/// A foot that slides in jerks, each row of them to another side.
TrialCause rough_drift(const TrialWorld& world, Random& random) {
  constexpr int kJerks = 6;
  std::vector<double> when;
  std::vector<Eigen::Vector3d> by, turned;
  const auto drawn = [&] {
    return Eigen::Vector3d(normal(random), normal(random), normal(random));
  };
  const Eigen::Vector3d along = drawn(), about = drawn();
  for (int i = 0; i < kJerks; ++i) {
    when.push_back(uniform(random, 0.05, 0.95) * world.duration);
    by.push_back(along + 0.4 * drawn());
    turned.push_back(about + 0.4 * drawn());
  }
  return {.where = {"base"},
          .physics = "a foot that slides in jerks",
          .act = [=](const Instant& at, Deviation& out) {
            for (int i = 0; i < kJerks; ++i)
              if (at.time > when[i])
                out.tip +=
                    0.2 * kSome *
                    (by[i] + turned[i].cross(Eigen::Vector3d(at.poses.back().translation())));
          }};
}

/// Slips twice to the same side, the second time less.
TrialCause rough_zero_shift(const TrialWorld& world, Random& random) {
  const ActingJoint joint = draw_joints(world, random, 0).front();
  const double first = uniform(random, 0.25, 0.6) * world.duration;
  const double second = first + uniform(random, 0.02, 0.1) * world.duration;
  return {.where = {joint.name},
          .physics = "a belt that slips twice",
          .act = [=](const Instant& at, Deviation& out) {
            out.joints[joint.joint] +=
                kSome * ((at.time > first ? 1 : 0) + (at.time > second ? 0.3 : 0));
          }};
}

/// Of no list: a table of offsets over the cell, each brick of it as it likes.
Eigen::Vector3d brick(const Eigen::Vector3d& p, double side, unsigned seed) {
  Random random(seed + 73856093U * static_cast<unsigned>(std::lround(std::floor(p.x() / side))) +
                19349663U * static_cast<unsigned>(std::lround(std::floor(p.y() / side))) +
                83492791U * static_cast<unsigned>(std::lround(std::floor(p.z() / side))));
  random.discard(5);
  return {normal(random), normal(random), normal(random)};
}

TrialCause rough_unknown(const TrialWorld& world, Random& random) {
  const int kind = pick(random, 4);
  const auto seed = static_cast<unsigned>(pick(random, 1 << 20));
  const double side = uniform(random, 0.3, 0.6);
  if (kind == 0)
    return {.physics = "bricks of the cell, each with an offset of its own",
            .act = [=](const Instant& at, Deviation& out) {
              out.tip += 0.5 * kSome * brick(at.poses.back().translation(), side, seed);
            }};
  const int a = pick(random, world.joints()), b = (a + 1) % world.joints();
  const double at_angle = uniform(random, -0.8, 0.8);
  if (kind == 1)
    return {.physics = "a cable that pulls only with two joints bent one way",
            .act = [=](const Instant& at, Deviation& out) {
              if (at.q[a] > at_angle && at.q[b] > -at_angle)
                out.tip += kSome * at.poses.back().linear().col(1);
            }};
  if (kind == 2) {
    // The longer the way from the row before, the more is left of it when the reading is taken.
    std::vector<Eigen::Vector3d> left(world.rows.size(), Eigen::Vector3d::Zero());
    for (size_t i = 1; i < world.rows.size(); ++i)
      left[i] = world.rows[i].configuration == world.rows[i - 1].configuration
                    ? left[i - 1]
                    : Eigen::Vector3d(world.rows[i - 1].poses.back().translation() -
                                      world.rows[i].poses.back().translation());
    return {.physics = "has not come to rest after the way there",
            .act = [=](const Instant& at, Deviation& out) {
              out.tip += 0.7 * kSome * left[static_cast<size_t>(at.row)];
            }};
  }
  return {.physics = "sags, and clicks into one of two seats by the way there",
          .act = [=](const Instant& at, Deviation& out) {
            const double way = at.velocity[a] * at.velocity[b];
            out.tip += 0.7 * kSome * sign_of(way) * sign_of(at.q[b] - at_angle) *
                       at.poses.back().linear().col(0);
          }};
}

}  // namespace

std::map<std::string, CauseMaker> rough_laws() {
  return {{"joint_compliance", rough_compliance},
          {"link_compliance", rough_beam},
          {"backlash", rough_backlash},
          {"transmission_error", rough_transmission},
          {"joint_coupling", rough_coupling},
          {"thermal_expansion", rough_expansion},
          {"base_drift", rough_drift},
          {"zero_shift", rough_zero_shift},
          {"unknown", rough_unknown}};
}

}  // namespace selfcal
