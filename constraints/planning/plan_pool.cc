#include "constraints/planning/plan_pool.h"

#include <algorithm>

#include "constraints/sampling/configurations.h"

namespace selfcal {
namespace {

/// What is touched at the configurations taken already. Where an instrument stands only its
/// readings tell, and these are not looked at.
DataSet touched(const DataSet& all) {
  std::vector<int> rows;
  for (int row = 0; row < all.rows.rows(); ++row)
    if (all.sets[all.rows.set[row]].method->constrains()) rows.push_back(row);
  DataSet touches;
  touches.sets = all.sets;
  touches.rows = taken(all.rows, rows);
  return touches;
}

/// The own and group values that the touches taken already have.
State state_of(const Robot& robot, const Eigen::VectorXd& xi, const PoolRequest& request,
               const DataSet& taken) {
  State state;
  state.xi = xi;
  state.nuisance.resize(request.sets.size());
  state.groups.resize(request.sets.size());
  if (taken.rows.rows() > 0) Equations(robot, taken, Use::fit).start(state);
  return state;
}

/// Where the robot was in each group of a set, group by group.
std::vector<Location> places_of(const Robot& robot, const Eigen::VectorXd& xi, const DataSet& taken,
                                int set) {
  std::vector<Location> places;
  const Observations& rows = taken.rows;
  for (int g = 0;; ++g) {
    int row = 0;
    while (row < rows.rows() && (rows.set[row] != set || rows.group[row] != g)) ++row;
    if (row == rows.rows()) return places;
    places.push_back(
        locate(robot, xi, rows.q.row(row).transpose(), taken.sets[set].method->body()));
  }
}

std::vector<SampleRequest> sample_requests(const Robot& robot, const Eigen::VectorXd& xi,
                                           const PoolRequest& request) {
  const DataSet taken = touched(request.taken);
  const State known = state_of(robot, xi, request, taken);
  std::vector<SampleRequest> list;
  const auto sets = static_cast<int>(request.sets.size());
  for (int s = 0; s < sets; ++s) {
    const Method& method = *request.sets[s].method;
    SampleRequest each;
    each.set = s;
    each.held = request.held;
    each.rows = (request.candidates + sets - 1 - s) / sets * (method.paired() ? 2 : 1);
    each.rows_per_group = std::max(1, (each.rows + request.groups - 1) / request.groups);
    each.together = !method.paired() && method.group_freedom() == 0;
    const bool begun = std::ranges::count(taken.rows.set, s) > 0;
    if (begun && method.tangent_dimension() > 0) each.nuisance = known.nuisance[s];
    if (begun && method.group_freedom() > 0) each.places = places_of(robot, xi, taken, s);
    list.push_back(std::move(each));
  }
  return list;
}

/// Rows of a paired method two by two, each pair a group; every other row a unit of its own.
std::vector<Unit> into_units(DataSet& data) {
  std::vector<Unit> units;
  for (int row = 0; row < data.rows.rows(); ++row) {
    Set& set = data.sets[data.rows.set[row]];
    if (!set.method->paired()) {
      units.push_back({row});
      continue;
    }
    const bool whole = row + 1 < data.rows.rows() && data.rows.set[row + 1] == data.rows.set[row];
    data.rows.group[row] = static_cast<int>(set.groups.size());
    set.groups.push_back("p" + std::to_string(set.groups.size()));
    if (!whole) continue;
    data.rows.group[row + 1] = data.rows.group[row];
    units.push_back({row, row + 1});
    ++row;
  }
  return units;
}

/// Leaves out units whose end position is nearer than `spacing` to one before them of their set, or
/// to one of those taken already.
void space(const Robot& robot, const Eigen::VectorXd& xi, const PoolRequest& request, Pool& pool) {
  EndPositions kept = end_positions(robot, xi, request.taken);
  kept.resize(pool.data.sets.size());
  std::erase_if(pool.units, [&](const Unit& unit) {
    const int set = pool.data.rows.set[unit.front()];
    std::vector<Eigen::Vector3d> own;
    for (const int row : unit)
      own.push_back(locate(robot, xi, pool.data.rows.q.row(row).transpose()).p);
    std::vector<Eigen::Vector3d>& others = kept[static_cast<std::size_t>(set)];
    const bool near = std::ranges::any_of(
        own, [&](const Eigen::Vector3d& p) { return nearer_than(request.spacing, p, others); });
    if (!near) others.insert(others.end(), own.begin(), own.end());
    return near;
  });
  if (pool.unreached.empty())
    pool.unreached = "too few of the configurations that were drawn are far enough from each other";
}

}  // namespace

EndPositions end_positions(const Robot& robot, const Eigen::VectorXd& xi, const DataSet& data) {
  EndPositions list(data.sets.size());
  for (int row = 0; row < data.rows.rows(); ++row)
    list[static_cast<std::size_t>(data.rows.set[row])].push_back(
        locate(robot, xi, data.rows.q.row(row).transpose()).p);
  return list;
}

bool nearer_than(double spacing, const Eigen::Vector3d& p,
                 const std::vector<Eigen::Vector3d>& others) {
  return std::ranges::any_of(
      others, [&](const Eigen::Vector3d& other) { return (p - other).norm() < spacing; });
}

Pool draw_pool(const Robot& robot, const Eigen::VectorXd& xi, const PoolRequest& request,
               const Progress& progress) {
  Pool pool;
  pool.data.sets = request.sets;
  Random random(request.seed);
  Sampled sampled =
      sample_rows(robot, xi, sample_requests(robot, xi, request), random, pool.data, progress);
  pool.state = std::move(sampled.truth);
  pool.unreached = std::move(sampled.unreached);
  for (Set& set : pool.data.sets)
    if (set.method->paired()) set.groups.clear();
  pool.units = into_units(pool.data);
  if (request.spacing > 0) space(robot, xi, request, pool);
  return pool;
}

}  // namespace selfcal
