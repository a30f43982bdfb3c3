// Configurations come from constraints/configurations.h. A touch by a probe's ball of radius rho is
// sampled as one of the plane on which the ball's centre lies, d + rho n . n_out, because the
// sampler knows no outward normals.
#include "sim/rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constraints/methods/plane.h"
#include "constraints/sampling/configurations.h"
#include "sim/streams.h"
#include "sim/true_sets.h"

namespace selfcal {
namespace {

/// Radius of the probe by which the set is touched; 0 for a point.
double probe_radius(const SetScenario& set) {
  const Node* node = set.entry.find("probe_radius");
  return node ? written_number(node->text).value_or(0) : 0;
}

/// Configurations that `rows` rows come from when a share of them is repeated.
int configurations(const SetScenario& set, const Repeats& repeats, const Method& method) {
  // The residual of a pair of equal configurations says nothing.
  if (method.paired()) return set.rows;
  const double rows_each = 1 + repeats.share * (repeats.times - 1);
  return std::max(1, static_cast<int>(std::lround(set.rows / rows_each)));
}

/// The centre's plane of a set touched by a probe, as a set of its own.
void touch_by_point(const Eigen::Vector3d& outward, const Plane& plane, double radius, Set& set,
                    Eigen::VectorXd& nuisance) {
  set.method = point_on_plane();
  set.reference = -1;
  nuisance = set.method->nuisance_of({plane.n, *plane.d + radius * plane.n.dot(outward)});
}

std::vector<int> shuffled(int count, Random& random) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::shuffle(order, random);
  return order;
}

/// Which sampled row each row is taken at; repeats follow each other.
struct Plan {
  std::vector<int> source, repeat;
  std::vector<char> check;
};

class Planner {
 public:
  explicit Planner(const Scenario& scenario)
      : scenario_(scenario),
        repeats_(stream(scenario.seed, Draw::repeats)),
        check_(stream(scenario.seed, Draw::check)) {}

  /// Adds the rows of a set whose `count` configurations begin at `first`.
  void add(int first, int count, int rows) {
    std::vector<int> times(count, 1);
    int missing = rows - count;
    for (const int i : shuffled(count, repeats_)) {
      const int more = std::min(missing, scenario_.repeats.times - 1);
      times[i] += more;
      missing -= more;
    }
    std::vector<char> check(count, 0);
    const std::vector<int> order = shuffled(count, check_);
    for (int i = 0; i < std::lround(scenario_.check * count); ++i) check[order[i]] = 1;
    for (int i = 0; i < count; ++i) {
      const int repeat = times[i] > 1 ? next_repeat_++ : -1;
      plan_.source.insert(plan_.source.end(), times[i], first + i);
      plan_.repeat.insert(plan_.repeat.end(), times[i], repeat);
      plan_.check.insert(plan_.check.end(), times[i], check[i]);
    }
  }

  Plan take() { return std::move(plan_); }

 private:
  const Scenario& scenario_;
  Random repeats_, check_;
  Plan plan_;
  int next_repeat_ = 0;
};

/// The sampled rows as the plan repeats them.
Observations expand(const Observations& sampled, const Plan& plan) {
  Observations rows = taken(sampled, plan.source);
  rows.repeat = plan.repeat;
  rows.check = plan.check;
  return rows;
}

Plan plan_rows(const Scenario& scenario, const DataSet& sampled) {
  Planner planner(scenario);
  const std::vector<int>& set = sampled.rows.set;
  for (int first = 0, end = 0; first < sampled.rows.rows(); first = end) {
    while (end < sampled.rows.rows() && set[end] == set[first]) ++end;
    planner.add(first, end - first, scenario.sets[set[first]].rows);
  }
  return planner.take();
}

}  // namespace

std::vector<std::vector<int>> locked_joints(const Scenario& scenario, const Robot& robot,
                                            Problems& problems) {
  std::vector<std::vector<int>> locked(scenario.sets.size());
  for (std::size_t s = 0; s < locked.size(); ++s)
    for (const std::string& name : scenario.sets[s].locked) {
      const int joint = find_joint(robot, name);
      if (joint < 0)
        problems.add(*scenario.sets[s].locked_place,
                     "set " + scenario.sets[s].name + " locked: the robot has no joint " + name);
      locked[s].push_back(joint);
    }
  return locked;
}

void take_rows(const Scenario& scenario, const Robot& robot, Simulated& made) {
  DataSet sampled;
  sampled.sets = made.data.sets;
  std::vector<SampleRequest> requests;
  std::vector<Eigen::Vector3d> normals(sampled.sets.size(),
                                       Eigen::Vector3d::Constant(std::nan("")));
  for (std::size_t s = 0; s < sampled.sets.size(); ++s) {
    const SetScenario& wanted = scenario.sets[s];
    Set& set = sampled.sets[s];
    Eigen::VectorXd nuisance = made.truth.nuisance[s];
    const int count = configurations(wanted, scenario.repeats, *set.method);
    if (const double radius = probe_radius(wanted); radius > 0) {
      normals[s] = *outward_normal(scenario, made.data.sets, s, made.truth.nuisance);
      touch_by_point(normals[s], *true_plane(made.data.sets, s, made.truth.nuisance), radius, set,
                     nuisance);
    }
    SampleRequest& request = requests.emplace_back();
    request.set = static_cast<int>(s);
    request.rows = count;
    request.rows_per_group = wanted.rows_per_group;
    request.nuisance = std::move(nuisance);
    request.patch = wanted.within;
    request.places = wanted.places;
    request.held = made.locked[s];
  }
  Random random = stream(scenario.seed, Draw::configurations);
  Sampled taken = sample_rows(robot, made.truth.xi, requests, random, sampled);
  made.unreached = std::move(taken.unreached);
  if (!made.unreached.empty()) return;
  made.truth.groups = std::move(taken.truth.groups);
  for (std::size_t s = 0; s < sampled.sets.size(); ++s)
    made.data.sets[s].groups = sampled.sets[s].groups;
  made.data.rows = expand(sampled.rows, plan_rows(scenario, sampled));
  for (int row = 0; row < made.data.rows.rows(); ++row)
    made.data.rows.normal.row(row) = normals[made.data.rows.set[row]].transpose();
}

}  // namespace selfcal
