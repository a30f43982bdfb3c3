// The core of an identification by everyone, and the whole of it by selfcal.
#include <cmath>
#include <map>

#include "constraints/estimation/identification.h"
#include "diagnosis/diagnosis.h"
#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"
#include "tests/bench/contenders.h"
#include "tests/bench/peak.h"
#include "tests/bench/plain.h"
#include "tests/bench/tasks.h"

namespace selfcal::bench {
namespace {

constexpr double kSame = 1e-4;  // relative: two solutions of one task have the same residual
constexpr int kMostSteps = 20;
constexpr double kSettled = 1e-10;  // relative change of the cost, as Ceres'

/// Gauss-Newton on the normal equations, Huber weights, of the unknowns alone.
Eigen::VectorXd solve_by_selfcal(const Task& task) {
  const Equations equations(example_robot(), task.data, Use::fit);
  const Weighting weighting = equal_weights(task);
  State state;
  state.xi = task.xi;
  equations.start(state);
  double before = HUGE_VAL;
  for (int step = 0; step < kMostSteps; ++step) {
    const NormalEquations at = equations.normal_equations(state, weighting, task.unknowns);
    if (std::abs(before - at.cost) < kSettled * at.cost) break;
    before = at.cost;
    const Eigen::MatrixXd L = cholesky_root(at.H.topLeftCorner(kUnknowns, kUnknowns));
    const Eigen::MatrixXd z = solve_lower(L, at.H.rightCols(1).topRows(kUnknowns));
    state.xi(task.unknowns) += solve_lower_transposed(L, z);
  }
  return state.xi(task.unknowns);
}

/// Root mean square of the rows' distances (m).
double residual_of(const Task& task, const Eigen::VectorXd& unknowns) {
  Eigen::VectorXd xi = task.xi;
  xi(task.unknowns) = unknowns;
  const Arm arm(example_robot());
  double sum = 0;
  for (int row = 0; row < task.data.rows.rows(); ++row) {
    const Eigen::VectorXd q = task.data.rows.q.row(row).transpose();
    const Eigen::Vector3d p = endpoint_of<double>(
        arm, [&](int i) { return xi[i]; }, q.data());
    sum += (p - task.data.rows.position.row(row).transpose()).squaredNorm();
  }
  return std::sqrt(sum / task.data.rows.rows());
}

/// All have come to the same place.
void expect_same(const Task& task, const Eigen::VectorXd& one) {
  static std::map<const Task*, double> first;
  const double residual = residual_of(task, one);
  const auto [found, fresh] = first.try_emplace(&task, residual);
  expects(fresh || std::abs(residual / found->second - 1) < kSame,
          "all contenders come to the same residual");
}

void peak(benchmark::State& state) {
  double operations = 0, sum = 0;
  for (auto _ : state) {
    operations += multiply_and_add(10000, sum);
    benchmark::DoNotOptimize(sum);
  }
  state.counters["GFLOP/s"] = benchmark::Counter(1e-9 * operations, benchmark::Counter::kIsRate);
}

/// What any program must read: a column of a million numbers.
void stream(benchmark::State& state) {
  const Eigen::VectorXd numbers = Eigen::VectorXd::Ones(1000000);
  for (auto _ : state) benchmark::DoNotOptimize(numbers.sum());
  state.SetBytesProcessed(state.iterations() * 8 * numbers.size());
}

template <class Solve>
void identification(benchmark::State& state, Solve solve) {
  const Task& task = task_of(static_cast<int>(state.range(0)));
  Eigen::VectorXd found;
  for (auto _ : state) found = solve(task);
  expect_same(task, found);
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void whole_identification(benchmark::State& state) {
  const Task& task = task_of(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(identify(example_robot(), task.data).verdict);
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

/// One pass over the rows: frames, W and its products. Counted are the products of W's columns with
/// each other and with Delta Y, each pair once, and those of the chain rule.
void one_pass(benchmark::State& state) {
  const Task& task = task_of(static_cast<int>(state.range(0)));
  const Equations equations(example_robot(), task.data, Use::fit);
  State at;
  at.xi = task.xi;
  equations.start(at);
  const Weighting weighting = equal_weights(task);
  for (auto _ : state)
    benchmark::DoNotOptimize(equations.normal_equations(at, weighting, task.unknowns).cost);
  const double columns = kUnknowns + 1, scalars = 3 * static_cast<double>(state.range(0));
  state.counters["GFLOP/s"] =
      benchmark::Counter(1e-9 * scalars * (columns * (columns + 1) + 2 * 3 * kUnknowns),
                         benchmark::Counter::kIsIterationInvariantRate);
}

void whole_diagnosis(benchmark::State& state) {
  static const std::shared_ptr<const Robot> robot(&example_robot(), [](const Robot*) {});
  DataSet data = task_of(400).data;
  for (int row = 0; row < data.rows.rows(); row += 4) data.rows.check[row] = 1;
  for (auto _ : state) benchmark::DoNotOptimize(diagnose(robot, data, {}, {}).p_value);
}

}  // namespace

void add_identifications() {
  add_task("peak", peak);
  add_task("stream", stream);
  for (const int rows : {1000, 10000, 100000}) {
    const auto add = [rows](const char* name, auto solve) {
      add_task(name, [solve](benchmark::State& s) { identification(s, solve); })
          ->Arg(rows)
          ->Unit(benchmark::kMillisecond);
    };
    add("core/selfcal", solve_by_selfcal);
    add("core/plain-eigen", solve_plainly);
    add("core/ceres-automatic-qr",
        [](const Task& task) { return solve_by_ceres(task, Derivatives::automatic, Solver::qr); });
    add("core/ceres-automatic-normal", [](const Task& task) {
      return solve_by_ceres(task, Derivatives::automatic, Solver::normal_equations);
    });
    add("core/ceres-analytic-normal", [](const Task& task) {
      return solve_by_ceres(task, Derivatives::analytic, Solver::normal_equations);
    });
    add_task("pass/selfcal", one_pass)->Arg(rows)->Unit(benchmark::kMillisecond);
  }
  for (const int rows : {400, 10000})
    add_task("whole/selfcal", whole_identification)->Arg(rows)->Unit(benchmark::kMillisecond);
  add_task("diagnosis/selfcal", whole_diagnosis)->Unit(benchmark::kMillisecond)->Iterations(1);
}

}  // namespace selfcal::bench
