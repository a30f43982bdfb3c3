// Own values come from Method::through, which knows what the options fix, unless the scenario gives
// them: a surface's as the plane methods keep them ([n d], n), any others by the names under which
// the method reports them, found by Newton steps of least length on report's gradients.
#include "sim/true_sets.h"

#include <cmath>

#include "constraints/endpoint_sigma.h"
#include "kinematics/linear_algebra.h"
#include "sim/streams.h"

namespace selfcal {
namespace {

constexpr int kTries = 60;     // blocks of random configurations
constexpr int kSteps = 100;    // Newton steps
constexpr double kMet = 1e-9;  // what is left of the wanted values (m, rad)

bool is_plane(const Method& method) {
  return method.name() == "plane" || method.name() == "plane-normal";
}

/// A random location of the set's body within the patch, or the patch's centre if it is out of
/// reach.
Location anywhere(const Robot& robot, const Eigen::VectorXd& xi, Body body, const Patch& patch,
                  Random& random) {
  ConfigurationBlock block;
  Locations X;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    block.q = random_poses(robot, nullptr, kLanes, random()).array();
    block.count = kLanes;
    robot.locate(block, xi, body, X, nullptr);
    for (int lane = 0; lane < kLanes; ++lane)
      if (patch.contains(X.p(lane))) return X.at(lane);
  }
  return {Eigen::Matrix3d::Identity(), patch.centre};
}

/// Own values of the plane with this surface; d >= 0 as the result reports it.
Eigen::VectorXd values_of(const Surface& surface, const Method& method) {
  const double d = surface.normal.dot(surface.point);
  if (method.name() == "plane-normal") return surface.normal;
  Eigen::VectorXd own(4);
  own << (d < 0 ? -1.0 : 1.0) * surface.normal, std::abs(d);
  return own;
}

const OwnReport* find(const std::vector<OwnReport>& reports, const std::string& name) {
  for (const OwnReport& report : reports)
    if (report.name == name) return &report;
  return nullptr;
}

/// False, with a problem, when the method reports no such name.
bool check_names(const SetScenario& wanted, const std::vector<OwnReport>& reports,
                 Problems& problems) {
  std::string known;
  for (const OwnReport& report : reports) known += (known.empty() ? "" : ", ") + report.name;
  for (const NamedNumber& each : wanted.truth) {
    if (find(reports, each.name)) continue;
    problems.add(each.place, "set " + wanted.name + " truth: no own unknown is called '" +
                                 each.name + "'; known: " + (known.empty() ? "none" : known));
    return false;
  }
  return true;
}

void bring_to_truth(const SetScenario& wanted, const Method& method,
                    const Eigen::VectorXd* reference, Eigen::VectorXd& own, Problems& problems) {
  if (!check_names(wanted, method.report(own, reference), problems)) return;
  const auto count = static_cast<Eigen::Index>(wanted.truth.size());
  Eigen::MatrixXd A(count, method.own_freedom());
  Eigen::VectorXd miss(count);
  for (int step = 0; step < kSteps; ++step) {
    const std::vector<OwnReport> reports = method.report(own, reference);
    for (Eigen::Index i = 0; i < count; ++i) {
      const OwnReport* report = find(reports, wanted.truth[i].name);
      if (!report) break;  // a plane through the origin has no a b c
      A.row(i) = report->D_own.transpose();
      miss[i] = wanted.truth[i].value - report->value;
    }
    if (miss.norm() < kMet) return;
    method.retract(own, least_squares(A, miss));
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
    const bool free_plane =
        is_plane(*set.method) && set.method->own_freedom() > 0 && set.method->reference().empty();
    if (each.surface && !free_plane)
      problems.add(each.entry.place,
                   "set " + each.name + ": `surface` is for planes whose place is unknown");
    if (each.noise_angle_true && !set.method->has_angles())
      problems.add(*each.noise_angle_true, "set " + each.name +
                                               ": `noise_angle_true` is for methods with angles, " +
                                               std::string(set.method->name()) + " has none");
    if (each.outward && !is_plane(*set.method))
      problems.add(each.entry.place, "set " + each.name + ": `outward` is for planes");
  }
  return sets;
}

std::vector<Eigen::VectorXd> true_own_values(const Scenario& scenario, const std::vector<Set>& sets,
                                             const Robot& robot, const Eigen::VectorXd& xi,
                                             Problems& problems) {
  Random random = stream(scenario.seed, Draw::own_values);
  std::vector<Eigen::VectorXd> own(sets.size());
  // A set that refers to another comes after it.
  for (const bool referring : {false, true})
    for (std::size_t s = 0; s < sets.size(); ++s) {
      if ((sets[s].reference >= 0) != referring) continue;
      const Method& method = *sets[s].method;
      const SetScenario& wanted = scenario.sets[s];
      const Eigen::VectorXd* reference = referring ? &own[sets[s].reference] : nullptr;
      const Location X = anywhere(robot, xi, method.body(), wanted.within, random);
      own[s] = wanted.surface ? values_of(*wanted.surface, method)
                              : method.through(X, reference, random);
      if (!wanted.truth.empty()) bring_to_truth(wanted, method, reference, own[s], problems);
    }
  return own;
}

std::optional<Eigen::Vector3d> residual_normal(const std::vector<Set>& sets, std::size_t set,
                                               const std::vector<Eigen::VectorXd>& own) {
  if (!is_plane(*sets[set].method)) return std::nullopt;
  const int reference = sets[set].reference;
  return Eigen::Vector3d(own[reference < 0 ? set : reference].head<3>());
}

std::optional<Eigen::Vector3d> outward_normal(const Scenario& scenario,
                                              const std::vector<Set>& sets, std::size_t set,
                                              const std::vector<Eigen::VectorXd>& own) {
  const std::optional<Eigen::Vector3d> n = residual_normal(sets, set, own);
  if (!n) return std::nullopt;
  const SetScenario& wanted = scenario.sets[set];
  double side = 1;  // the normal of a plane-normal is the outward one
  if (wanted.surface)
    side = n->dot(wanted.surface->normal);
  else if (wanted.outward)
    side = n->dot(*wanted.outward);
  else if (sets[set].method->name() == "plane")
    side = sets[set].reference < 0 ? -own[set][3] : -own[set][0];
  return side < 0 ? Eigen::Vector3d(-*n) : *n;
}

}  // namespace selfcal
