// Own values come from Method::through, which knows what the options fix, unless the scenario gives
// them: a surface's as the method keeps them, any others by the names under which the method
// reports them, found by Newton steps of least length on report's gradients.
#include "sim/true_sets.h"

#include <cmath>

#include "constraints/sampling/random_poses.h"
#include "kinematics/linear_algebra.h"
#include "sim/streams.h"

namespace selfcal {
namespace {

constexpr int kBlockTries = 60;      // blocks of random configurations
constexpr int kValueSteps = 100;     // Newton steps
constexpr double kValuesMet = 1e-9;  // what is left of the wanted values (m, rad)

/// A random location of the set's body within the patch, or the patch's centre if it is out of
/// reach.
Location anywhere(const Robot& robot, const Eigen::VectorXd& xi, Body body, const Patch& patch,
                  Random& random) {
  ConfigurationBlock block;
  Locations X;
  for (int attempt = 0; attempt < kBlockTries; ++attempt) {
    block.q = random_poses(robot, nullptr, kLanes, random()).array();
    block.count = kLanes;
    const Closure closure = robot.locate(block, xi, body, X, nullptr);
    for (int lane = 0; lane < kLanes; ++lane)
      if (closure.closes(lane) && patch.contains(X.p(lane))) return X.at(lane);
  }
  return {Eigen::Matrix3d::Identity(), patch.centre};
}

const NuisanceReport* find(const std::vector<NuisanceReport>& reports, const std::string& name) {
  for (const NuisanceReport& report : reports)
    if (report.name == name) return &report;
  return nullptr;
}

/// False, with a problem, when the method reports no such name.
bool check_names(const SetScenario& wanted, const std::vector<NuisanceReport>& reports,
                 Problems& problems) {
  std::string known;
  for (const NuisanceReport& report : reports) known += (known.empty() ? "" : ", ") + report.name;
  for (const NamedNumber& each : wanted.truth) {
    if (find(reports, each.name)) continue;
    problems.add(each.place, "set " + wanted.name + " truth: no own unknown is called '" +
                                 each.name + "'; known: " + (known.empty() ? "none" : known));
    return false;
  }
  return true;
}

void bring_to_truth(const SetScenario& wanted, const Method& method,
                    const Eigen::VectorXd* reference, Eigen::VectorXd& nuisance,
                    Problems& problems) {
  if (!check_names(wanted, method.report(nuisance, reference), problems)) return;
  const auto count = static_cast<Eigen::Index>(wanted.truth.size());
  Eigen::MatrixXd A(count, method.tangent_dimension());
  Eigen::VectorXd miss(count);
  for (int step = 0; step < kValueSteps; ++step) {
    const std::vector<NuisanceReport> reports = method.report(nuisance, reference);
    for (Eigen::Index i = 0; i < count; ++i) {
      const NuisanceReport* report = find(reports, wanted.truth[i].name);
      if (!report) break;  // a plane through the origin has no a b c
      A.row(i) = report->D_own.transpose();
      miss[i] = wanted.truth[i].value - report->value;
    }
    if (miss.norm() < kValuesMet) return;
    method.retract(nuisance, least_squares(A, miss));
  }
  problems.add(wanted.truth.front().place,
               "set " + wanted.name + " truth: no own values have these numbers together");
}

}  // namespace

std::vector<Set> make_sets(const Scenario& scenario, Problems& problems) {
  Node entries = Node::map();
  for (const SetScenario& each : scenario.sets) entries.set(each.name, each.entry);
  std::vector<Set> sets = read_sets(entries, problems);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const SetScenario& each = scenario.sets[s];
    const Set& set = sets[s];
    if (!set.method) continue;
    const bool plane = set.method->touches() == TouchedSurface::plane;
    const bool free_plane =
        plane && set.method->tangent_dimension() > 0 && set.method->reference().empty();
    if (each.surface && !free_plane)
      problems.add(each.entry.place,
                   "set " + each.name + ": `surface` is for planes whose place is unknown");
    if (each.noise_angle_true && !set.method->has_angles())
      problems.add(*each.noise_angle_true, "set " + each.name +
                                               ": `noise_angle_true` is for methods with angles, " +
                                               std::string(set.method->name()) + " has none");
    if (each.outward && !plane)
      problems.add(each.entry.place, "set " + each.name + ": `outward` is for planes");
  }
  return sets;
}

std::vector<Eigen::VectorXd> true_own_values(const Scenario& scenario, const std::vector<Set>& sets,
                                             const Robot& robot, const Eigen::VectorXd& xi,
                                             Problems& problems) {
  Random random = stream(scenario.seed, Draw::own_values);
  std::vector<Eigen::VectorXd> nuisance(sets.size());
  // A set that refers to another comes after it.
  for (const bool referring : {false, true})
    for (std::size_t s = 0; s < sets.size(); ++s) {
      if ((sets[s].reference >= 0) != referring) continue;
      const Method& method = *sets[s].method;
      const SetScenario& wanted = scenario.sets[s];
      const Eigen::VectorXd* reference = referring ? &nuisance[sets[s].reference] : nullptr;
      const Location X = anywhere(robot, xi, method.body(), wanted.within, random);
      if (const auto& surface = wanted.surface)
        nuisance[s] = method.nuisance_of({surface->normal, surface->normal.dot(surface->point)});
      else
        nuisance[s] = method.through(X, reference, random);
      if (!wanted.truth.empty()) bring_to_truth(wanted, method, reference, nuisance[s], problems);
    }
  return nuisance;
}

std::optional<Plane> true_plane(const std::vector<Set>& sets, std::size_t set,
                                const std::vector<Eigen::VectorXd>& nuisance) {
  const int reference = sets[set].reference;
  return sets[set].method->plane(nuisance[set], reference < 0 ? nullptr : &nuisance[reference]);
}

std::optional<Eigen::Vector3d> outward_normal(const Scenario& scenario,
                                              const std::vector<Set>& sets, std::size_t set,
                                              const std::vector<Eigen::VectorXd>& nuisance) {
  const std::optional<Plane> plane = true_plane(sets, set, nuisance);
  if (!plane) return std::nullopt;
  const SetScenario& wanted = scenario.sets[set];
  double side = 1;  // a normal alone is the outward one
  if (wanted.surface)
    side = plane->n.dot(wanted.surface->normal);
  else if (wanted.outward)
    side = plane->n.dot(*wanted.outward);
  else if (plane->d)
    side = -*plane->d;
  return side < 0 ? Eigen::Vector3d(-plane->n) : plane->n;
}

}  // namespace selfcal
