// Each law moves by about 1e-4 (m) at size 1; the trial sets its size by what is visible.
#include <algorithm>
#include <cmath>

#include "tests/reliability/rough_laws.h"

namespace selfcal {
namespace {

constexpr double kTenth = 1e-4;  ///< m

Eigen::Vector3d drawn_vector(Random& random) {
  return {normal(random), normal(random), normal(random)};
}

/// Works loose twice, the second time partly back, and turns in its thread.
TrialCause loose_tool(const TrialWorld& world, Random& random) {
  const double first = uniform(random, 0.2, 0.6) * world.duration;
  const double second = first + uniform(random, 0.03, 0.12) * world.duration;
  const Eigen::Vector3d aside = drawn_vector(random);
  const double back = uniform(random, 0.1, 0.3), creep = uniform(random, 0, 0.2);
  return {.where = {"probe"},
          .physics = "a stylus that works loose, partly back, and creeps on",
          .act = [=, &world](const Instant& at, Deviation& out) {
            if (at.time < first) return;
            const double kept = at.time < second ? 1 : 1 - back;
            const double on = creep * (at.time - first) / (world.duration - first);
            out.tip += kTenth * (kept + on) * (at.poses.back().linear() * aside);
          }};
}

/// A rubber mount: turns with the root of the moment, and sticks to where it was.
TrialCause rubber_mount(const TrialWorld& world, Random& random) {
  const int last = world.robot->statics()->mechanics().link_of(world.joints() - 1);
  const double sticks = uniform(random, 0, 0.3), mass = uniform(random, 0.5, 3);
  const auto turn_of = [=, &world](const Instant& at) -> Eigen::Vector3d {
    const Eigen::Isometry3d& mount = at.poses[static_cast<size_t>(last)];
    const Eigen::Vector3d arm = at.poses.back().translation() - mount.translation();
    Eigen::Vector3d force, moment;
    world.load(at, last + 1, mount.translation(), force, moment);
    moment += arm.cross(mass * Eigen::Vector3d(0, 0, -9.81));
    Eigen::Vector3d about = mount.linear().transpose() * moment;
    about.z() = 0;
    return about / std::pow(about.norm() + 0.1, 0.3);
  };
  std::vector<Eigen::Vector3d> turns;
  for (const Instant& row : world.rows) {
    const Eigen::Vector3d now = turn_of(row);
    turns.emplace_back(turns.empty() ? now
                                     : Eigen::Vector3d(sticks * turns.back() + (1 - sticks) * now));
  }
  return {.where = {"probe"},
          .physics = "a rubber mount that follows late, and less the more it carries",
          .act = [=](const Instant& at, Deviation& out) {
            const Eigen::Isometry3d& mount = at.poses[static_cast<size_t>(last)];
            const Eigen::Vector3d arm = at.poses.back().translation() - mount.translation();
            out.tip +=
                3 * kTenth * (mount.linear() * turns[static_cast<size_t>(at.row)]).cross(arm);
          }};
}

/// The wrong unit of length with a ripple of the counter, and another after it was switched on
/// again.
TrialCause wrong_scale(const TrialWorld& world, Random& random) {
  if (world.touches()) return {};
  const double again = uniform(random, 0.3, 0.7) * world.duration;
  const double other = uniform(random, 0.5, 1.5), period = uniform(random, 0.02, 0.1);
  return {.where = {"tracker"},
          .physics = "a wrong refractive index with a ripple, another after a restart",
          .act = [=](const Instant& at, Deviation& out) {
            const Eigen::Vector3d p = at.poses.back().translation();
            const double size = at.time < again ? 1 : other;
            out.tip +=
                kTenth * (size * p + 0.15 * std::sin(6.2832 * p.norm() / period) * p.normalized());
          }};
}

/// Three feet of unequal stiffness, one of them worn on one side.
TrialCause worn_probe(const TrialWorld& world, Random& random) {
  if (!world.touches()) return {};
  const double turned = uniform(random, 0, 2.1), worn = uniform(random, 0.3, 1);
  const double even = uniform(random, 0.2, 0.6);
  return {.where = {"probe"},
          .physics = "three feet with corners between them, one worn",
          .act = [=](const Instant& at, Deviation& out) {
            const Eigen::Vector3d n = at.poses.back().linear().transpose() * at.normal;
            const double around = std::fmod(std::atan2(n.y(), n.x()) - turned + 12.5664, 2.0944);
            const double foot = std::abs(around - 1.0472) / 1.0472;
            const double aside = std::hypot(n.x(), n.y());
            const bool at_worn = n.x() * std::cos(turned) + n.y() * std::sin(turned) > 0.5 * aside;
            out.tip += kTenth * aside * (even + foot) * (at_worn ? 1 + worn : 1) * at.normal;
          }};
}

/// A controller that reads the switch in its own time: up to a cycle late.
TrialCause late_cycle(const TrialWorld& world, Random& random) {
  if (!world.touches()) return {};
  std::vector<double> late;
  const double least = uniform(random, 0.3, 1.5);
  for (size_t i = 0; i < world.rows.size(); ++i) late.push_back(least + uniform(random, 0, 1));
  return {.where = {"probe"},
          .physics = "a switch that is read in the controller's cycle",
          .act = [=](const Instant& at, Deviation& out) {
            out.readings -= 1e-3 * late[static_cast<size_t>(at.row)] * at.velocity;
          }};
}

/// A plate that sags between its supports and has a step where two of it meet.
TrialCause bent_plate(const TrialWorld& world, Random& random) {
  if (!world.touches()) return {};
  const int set = pick(random, static_cast<int>(world.surfaces.size()));
  const TrialSurface surface = world.surfaces[static_cast<size_t>(set)];
  const Eigen::Vector3d u = surface.normal.cross(drawn_vector(random)).normalized();
  const Eigen::Vector3d v = surface.normal.cross(u);
  const double pitch = uniform(random, 0.25, 0.6), step = uniform(random, -0.5, 0.5);
  return {.where = {surface.name},
          .physics = "a plate that sags between supports, with a step in it",
          .act = [=](const Instant& at, Deviation& out) {
            if (at.set != set) return;
            const Eigen::Vector3d from = at.poses.back().translation() - surface.centre;
            const double sag = std::abs(std::sin(3.1416 * u.dot(from) / pitch));
            out.tip -= kTenth * (sag + (v.dot(from) > 0 ? step : 0)) * surface.normal;
          }};
}

/// Knocked, and slowly back by a part of it.
TrialCause knocked_fixture(const TrialWorld& world, Random& random) {
  if (!world.touches()) return {};
  const int set = pick(random, static_cast<int>(world.surfaces.size()));
  const TrialSurface surface = world.surfaces[static_cast<size_t>(set)];
  const double when = uniform(random, 0.25, 0.75) * world.duration;
  const Eigen::Vector3d tilt = surface.normal.cross(drawn_vector(random));
  const double back = uniform(random, 0, 0.4), shift = chance(random, 0.5) ? 1 : -1;
  return {.where = {surface.name},
          .physics = "a fixture that is knocked and creeps part of the way back",
          .act = [=, &world](const Instant& at, Deviation& out) {
            if (at.set != set || at.time < when) return;
            const Eigen::Vector3d from = at.poses.back().translation() - surface.centre;
            const double kept = 1 - back * (1 - std::exp(-8 * (at.time - when) / world.duration));
            out.tip -=
                kTenth * kept * (shift + surface.normal.dot(tilt.cross(from))) * surface.normal;
          }};
}

}  // namespace

std::map<std::string, CauseMaker> rough_site_laws() {
  return {{"tool_shift", loose_tool},        {"tool_compliance", rubber_mount},
          {"scale_error", wrong_scale},      {"probe_pretravel", worn_probe},
          {"trigger_latency", late_cycle},   {"plane_form_error", bent_plate},
          {"fixture_shift", knocked_fixture}};
}

}  // namespace selfcal
