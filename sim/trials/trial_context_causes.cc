// What happens around the arm: heat, the base, the probe, the surfaces.
//   thermal_expansion  every link grows with a temperature that lags the air by a lag of its own
//   base_drift         the base wanders smoothly, its shift and its turn each on a walk of its own
//   tool_shift         the tip moves aside within some seconds, and a little back later
//   tool_compliance    a tool of a true mass on a spring that stiffens, askew to the flange
//   scale_error        the tracker's unit follows the air, with a lag
//   probe_pretravel    p0 + sin(phi) (p1 + p3 cos(3 (psi - psi0)))
//   trigger_latency    a delay that jitters
//   plane_form_error   quadratic and a little cubic
//   fixture_shift      one surface shifts and tilts at a moment
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/trials/trial_causes.h"

namespace selfcal {
namespace {

Eigen::Vector3d random_vector(Random& random) {
  return {normal(random), normal(random), normal(random)};
}

TrialCause thermal_expansion(const TrialWorld& world, Random& random) {
  const double lag = std::min(uniform(random, 1800, 7200), 0.5 * world.duration);
  std::vector<AirRecord> body;
  for (size_t k = 0; k < world.links().size(); ++k)
    body.push_back(world.air.lagged(lag * uniform(random, 0.8, 1.25)));
  return {.where = {},
          .physics = "links lag behind the air, each by its own time",
          .act = [=, &world](const Instant& at, Deviation& out) {
            for (size_t k = 1; k < at.poses.size(); ++k)
              if (world.links()[k].joint >= 0)
                out.tip += 1.2e-5 * (body[k].at(at.time) - body[k].celsius.front()) *
                           (at.poses[k].translation() - at.poses[k - 1].translation());
          }};
}

TrialCause base_drift(const TrialWorld& world, Random& random) {
  const AirRecord shift = smooth_walk(world.duration, random);
  const AirRecord turn = smooth_walk(world.duration, random);
  const Eigen::Vector3d along = 5e-5 * random_vector(random);
  const Eigen::Vector3d about = 5e-5 * random_vector(random);
  return {.where = {"base"},
          .physics = "a smooth random walk",
          .act = [=](const Instant& at, Deviation& out) {
            out.tip += shift.at(at.time) * along +
                       turn.at(at.time) * about.cross(at.poses.back().translation());
          }};
}

TrialCause tool_shift(const TrialWorld& world, Random& random) {
  const double moment = uniform(random, 0.2, 0.8) * world.duration;
  const Eigen::Vector3d aside = random_vector(random), back = 0.1 * random_vector(random);
  return {.where = {"probe"},
          .physics = "the tool moves in its clamp, and settles a little",
          .act = [=](const Instant& at, Deviation& out) {
            const double since = at.time - moment;
            if (since < 0) return;
            out.tip +=
                1e-4 * at.poses.back().linear() * (aside + (1 - std::exp(-since / 600)) * back);
          }};
}

TrialCause tool_compliance(const TrialWorld& world, Random& random) {
  const int last = world.robot->statics()->mechanics().link_of(world.joints() - 1);
  const double other = uniform(random, 0.5, 1), askew = uniform(random, 0, 3.14);
  const double stiffening = uniform(random, 0, 0.01);  // 1/(N m)
  const Eigen::Vector3d axis = {std::cos(askew), std::sin(askew), 0};
  return {.where = {"probe"},
          .physics = "a clamp that gives way more about one axis than about the other",
          .act = [=, &world](const Instant& at, Deviation& out) {
            const Eigen::Isometry3d& mount = at.poses[static_cast<size_t>(last)];
            const Eigen::Vector3d arm = at.poses.back().translation() - mount.translation();
            Eigen::Vector3d force, moment;
            world.load(at, last + 1, mount.translation(), force, moment);
            moment += arm.cross(2.0 * world.gravity());  // a tool of 2 kg
            const Eigen::Vector3d M = mount.linear().transpose() * moment;
            Eigen::Vector3d turn = M.cwiseProduct(Eigen::Vector3d(1, 1, 0));
            turn -= (1 - other) * axis * axis.dot(turn);
            out.tip += 1e-5 / (1 + stiffening * M.norm()) * (mount.linear() * turn).cross(arm);
          }};
}

TrialCause scale_error(const TrialWorld& world, Random& random) {
  const AirRecord air = world.air.lagged(uniform(random, 0, 600));
  return {.where = {"tracker"},
          .physics = "the air bends and slows the beam as it grows warm",
          .act = [=](const Instant& at, Deviation& out) {
            out.tip +=
                1e-6 * (air.at(at.time) - air.celsius.front()) * at.poses.back().translation();
          }};
}

TrialCause probe_pretravel(const TrialWorld&, Random& random) {
  const double lobes = uniform(random, 0.15, 0.6), common = uniform(random, 0, 0.5);
  const double twist = uniform(random, -0.1, 0.1);
  return {.where = {"probe"},
          .physics = "three lobes, mounted a little turned",
          .act = [=](const Instant& at, Deviation& out) {
            const Eigen::Vector3d n = at.poses.back().linear().transpose() * at.normal;
            const double sine = std::sqrt(n.x() * n.x() + n.y() * n.y());
            const double psi = std::atan2(n.y(), n.x()) - twist;
            out.tip += 1e-5 * (common + sine * (1 + lobes * std::cos(3 * psi))) * at.normal;
          }};
}

TrialCause trigger_latency(const TrialWorld& world, Random& random) {
  std::vector<double> jitter;
  for (size_t i = 0; i < world.rows.size(); ++i) jitter.push_back(1 + 0.1 * normal(random));
  return {.where = {"probe"},
          .physics = "a delay that jitters by a tenth",
          .act = [=](const Instant& at, Deviation& out) {
            out.readings -= 2e-3 * jitter[static_cast<size_t>(at.row)] * at.velocity;
          }};
}

/// Two tangents of a surface, turned at random.
struct Tangents {
  Eigen::Vector3d u, v;
};
Tangents tangents(const Eigen::Vector3d& n, Random& random) {
  const Eigen::Vector3d u = n.cross(random_vector(random)).normalized();
  return {u, n.cross(u)};
}

TrialCause plane_form_error(const TrialWorld& world, Random& random) {
  const int set = pick(random, static_cast<int>(world.surfaces.size()));
  const TrialSurface surface = world.surfaces[static_cast<size_t>(set)];
  const Tangents t = tangents(surface.normal, random);
  const Eigen::Vector3d a = random_vector(random);
  const double cubic = uniform(random, -0.2, 0.2);
  return {.where = {surface.name},
          .physics = "quadratic and a little cubic",
          .act = [=](const Instant& at, Deviation& out) {
            if (at.set != set) return;
            const Eigen::Vector3d from = at.poses.back().translation() - surface.centre;
            const double u = t.u.dot(from), v = t.v.dot(from);
            out.tip -= 3e-4 * (a[0] * u * u + a[1] * u * v + a[2] * v * v + cubic * u * u * u) *
                       surface.normal;
          }};
}

TrialCause fixture_shift(const TrialWorld& world, Random& random) {
  const int set = pick(random, static_cast<int>(world.surfaces.size()));
  const TrialSurface surface = world.surfaces[static_cast<size_t>(set)];
  const double moment = uniform(random, 0.2, 0.8) * world.duration;
  const Eigen::Vector3d tilt = surface.normal.cross(random_vector(random)) * uniform(random, 0, 1);
  const double shift = chance(random, 0.5) ? 1 : -1;
  return {.where = {surface.name},
          .physics = "a surface shifts and tilts at a moment",
          .act = [=](const Instant& at, Deviation& out) {
            if (at.set != set || at.time < moment) return;
            const Eigen::Vector3d from = at.poses.back().translation() - surface.centre;
            out.tip -= 3e-5 * (shift + surface.normal.dot(tilt.cross(from))) * surface.normal;
          }};
}

}  // namespace

const std::map<std::string, CauseMaker>& site_causes() {
  static const std::map<std::string, CauseMaker> causes{{"thermal_expansion", thermal_expansion},
                                                        {"base_drift", base_drift},
                                                        {"tool_shift", tool_shift},
                                                        {"tool_compliance", tool_compliance}};
  return causes;
}

const std::map<std::string, CauseMaker>& tracked_causes() {
  static const std::map<std::string, CauseMaker> causes{{"scale_error", scale_error}};
  return causes;
}

const std::map<std::string, CauseMaker>& touch_causes() {
  static const std::map<std::string, CauseMaker> causes{{"probe_pretravel", probe_pretravel},
                                                        {"trigger_latency", trigger_latency},
                                                        {"plane_form_error", plane_form_error},
                                                        {"fixture_shift", fixture_shift}};
  return causes;
}

}  // namespace selfcal
