#include "constraints/planning/configuration_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constraints/planning/detmax.h"
#include "constraints/planning/refinement.h"
#include "constraints/planning/tour.h"
#include "constraints/statistics.h"

namespace selfcal {
namespace {

constexpr int kRandomChoices = 25;  // of which the median is told
constexpr int kLeftAfresh = 10;     // left out, after which the design is made anew

std::vector<Unit> some(const std::vector<Unit>& units, const std::vector<int>& which) {
  std::vector<Unit> list;
  for (const int each : which) list.push_back(units[static_cast<std::size_t>(each)]);
  return list;
}

/// The median of each figure over random choices.
PlanFigures random_figures(const PlanSystem& system, const Pool& pool, int count, Random& random,
                           const Progress& progress) {
  std::vector<PlanFigures> all;
  for (int i = 0; i < kRandomChoices; ++i) {
    if (progress) progress("looking at random choices", i / static_cast<double>(kRandomChoices));
    all.push_back(system.figures(
        pool.data,
        some(pool.units, random_choice(static_cast<int>(pool.units.size()), count, random))));
  }
  const auto of = [&](auto get) {
    std::vector<double> values;
    for (PlanFigures& each : all) values.push_back(get(each));
    return median(values);
  };
  PlanFigures result;
  result.sigma = of([](const PlanFigures& f) { return f.sigma; });
  for (double Observability::*index :
       {&Observability::condition, &Observability::o1, &Observability::o2, &Observability::o3,
        &Observability::o4, &Observability::o5})
    result.observability.*index = of([&](const PlanFigures& f) { return f.observability.*index; });
  return result;
}

/// The rows of the units alone, in their order, and the units as they then are.
DataSet rows_alone(const DataSet& data, std::vector<Unit>& units) {
  DataSet alone = data;
  std::vector<int> rows;
  for (Unit& unit : units)
    for (int& row : unit) {
      rows.push_back(row);
      row = static_cast<int>(rows.size()) - 1;
    }
  alone.rows = taken(data.rows, rows);
  return alone;
}

std::vector<Visit> visits_of(const DataSet& data, const std::vector<Unit>& units) {
  std::vector<Visit> list;
  for (const Unit& unit : units)
    list.push_back(
        {data.rows.q.row(unit.front()).transpose(), data.rows.q.row(unit.back()).transpose()});
  return list;
}

/// All units of the plan chosen, by the end position's sigma.
Design whole_design(const PlanSystem& system, const ConfigurationPlan& plan) {
  Design design(system.rows(plan.data, plan.units, Criterion::sigma),
                system.objective(Criterion::sigma));
  std::vector<int> all(plan.units.size());
  std::iota(all.begin(), all.end(), 0);
  design.choose(all);
  return design;
}

std::vector<double> curve_of(const PlanSystem& system, const ConfigurationPlan& plan,
                             const Progress& progress) {
  Design design = whole_design(system, plan);
  std::vector<double> sigma;
  for (const double merit : left_out_one_by_one(design, progress))
    sigma.push_back(std::sqrt(-merit));
  return sigma;
}

/// Pairs of a paired method are groups of their own, named in the order of visiting.
void name_pairs(const std::vector<Unit>& units, DataSet& data) {
  for (Set& set : data.sets)
    if (set.method->paired()) set.groups.clear();
  for (const Unit& unit : units) {
    Set& set = data.sets[data.rows.set[unit.front()]];
    if (!set.method->paired()) continue;
    for (const int row : unit) data.rows.group[row] = static_cast<int>(set.groups.size());
    set.groups.push_back("p" + std::to_string(set.groups.size() + 1));
  }
}

/// Leaves out those that tell least for the time they take, until the way is short enough.
std::vector<int> short_enough(const PlanSystem& system, const ConfigurationPlan& plan,
                              const std::vector<Visit>& visits, const PlanRequest& request,
                              std::vector<int> order) {
  Design design = whole_design(system, plan);
  int left = 0;
  leave_out(
      visits, request.speed, request.longest,
      [&](int unit) { return std::log(design.merit_without(unit) / design.merit()); },
      [&](int unit) {
        design.change(unit, -1);
        if (++left % kLeftAfresh == 0) design.refresh();
      },
      order);
  std::vector<Visit> visited;
  for (const int each : order) visited.push_back(visits[static_cast<std::size_t>(each)]);
  const std::vector<int> anew = short_tour(visited, request.speed);
  if (way_time(visited, anew, request.speed) >= way_time(visits, order, request.speed))
    return order;
  std::vector<int> shorter;
  for (const int each : anew) shorter.push_back(order[static_cast<std::size_t>(each)]);
  return shorter;
}

void order_visits(const PlanSystem& system, const PlanRequest& request, Random& random,
                  ConfigurationPlan& plan) {
  const std::vector<Visit> visits = visits_of(plan.data, plan.units);
  std::vector<int> order = short_tour(visits, request.speed);
  if (request.longest > 0 && way_time(visits, order, request.speed) > request.longest)
    order = short_enough(system, plan, visits, request, std::move(order));
  plan.way = way_time(visits, order, request.speed);
  plan.units = some(plan.units, order);
  plan.data = rows_alone(plan.data, plan.units);
  name_pairs(plan.units, plan.data);
  std::shuffle(order.begin(), order.end(), random);
  plan.way_random = way_time(visits, order, request.speed);
}

/// Chooses `count` units of the pool, moves and orders them, and says what they are worth.
void choose_units(const Robot& robot, const PlanRequest& request, const PlanSystem& system,
                  const Pool& pool, int count, Random& random, const Progress& progress,
                  ConfigurationPlan& plan) {
  const Objective objective = system.objective(request.criterion);
  Design design(system.rows(pool.data, pool.units, request.criterion), objective);
  design.choose(random_choice(design.candidates(), count, random));
  exchange(design, progress);
  plan.units = some(pool.units, design.chosen());
  plan.data = rows_alone(pool.data, plan.units);
  refine(robot, system.equations(), objective,
         {plan.data, plan.units, system.columns(request.criterion), system.most(),
          request.pool.held, request.pool.spacing,
          end_positions(robot, system.equations().state().xi, request.pool.taken)},
         progress);
  if (progress) progress("ordering configurations", 0);
  order_visits(system, request, random, plan);

  plan.sigma_before = system.figures(plan.data, {}).sigma;
  plan.sigma_beyond = system.sigma_beyond(pool, plan.data, plan.units);
  plan.planned = system.figures(plan.data, plan.units);
  plan.curve = curve_of(system, plan, progress);
}

}  // namespace

double ConfigurationPlan::rest(double sigma) const {
  return std::sqrt(std::max(0.0, sigma * sigma - sigma_beyond * sigma_beyond));
}

ConfigurationPlan plan_configurations(const Robot& robot, const Eigen::VectorXd& xi,
                                      const PlanRequest& request, const Progress& progress) {
  ConfigurationPlan plan;
  Pool pool = draw_pool(robot, xi, request.pool, progress);
  if (static_cast<int>(pool.units.size()) < request.count) {
    plan.problem = pool.unreached;
    return plan;
  }
  if (progress) progress("looking at configurations", 0);
  const PlanSystem system(robot, request.pool, request.workspace, request.count, pool);
  plan.problem = system.lacking();
  if (static_cast<int>(pool.units.size()) < request.count)
    plan.problem = "the robot cannot take enough of the configurations that were drawn";
  if (!plan.problem.empty()) return plan;
  plan.candidates = static_cast<int>(pool.units.size());
  plan.parameters = system.parameters();
  plan.aligned = system.aligned();
  Random random(request.pool.seed);
  choose_units(robot, request, system, pool, request.count, random, progress, plan);
  // The best of so many may be shorter and tell more than what is left of more.
  for (int count = request.count; static_cast<int>(plan.units.size()) < count;) {
    count = static_cast<int>(plan.units.size());
    ConfigurationPlan fewer = plan;
    choose_units(robot, request, system, pool, count, random, progress, fewer);
    if (fewer.planned.sigma < plan.planned.sigma) plan = std::move(fewer);
  }
  plan.random = random_figures(system, pool, static_cast<int>(plan.units.size()), random, progress);
  if (!std::isfinite(plan.planned.sigma) || !std::isfinite(plan.curve.back()))
    plan.problem =
        "the rows are so much surer than what is known beforehand that rounding hides what they "
        "tell: give a larger noise";
  if (request.longest > 0 && plan.way > request.longest)
    plan.problem = "the way between the configurations takes longer than it may";
  return plan;
}

}  // namespace selfcal
