// Speed as ratios in one run: each task by selfcal and by its contenders, on the same rows and from
// the same start, the peak of this core among them.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <string>

#include "constraints/equations/equations.h"
#include "constraints/equations/streaming_qr.h"
#include "constraints/estimation/identification.h"
#include "constraints/identifiability/observability.h"
#include "constraints/planning/detmax.h"
#include "diagnosis/diagnosis.h"
#include "kinematics/expects.h"
#include "kinematics/inverse/compensation_stream.h"
#include "kinematics/linear_algebra.h"
#include "tests/bench/arm.h"
#include "tests/bench/contenders.h"
#include "tests/bench/peak.h"

namespace selfcal::bench {
namespace {

constexpr double kSame = 1e-4;  // relative: two solutions of one task have the same residual

// ------------------------------------------------------------------------------- the core

Weighting equal_weights(const Task& task) {
  Weighting weighting;
  weighting.scale = {{kMeasured, kMeasured}};
  weighting.outlier.assign(task.data.rows.set.size(), 0);
  return weighting;
}

/// Gauss-Newton on the streamed R, Huber weights, of the unknowns alone.
Eigen::VectorXd solve_by_selfcal(const Task& task) {
  constexpr int kMostSteps = 20;
  constexpr double kSettled = 1e-10;  // relative change of the cost, as Ceres'
  const Equations equations(example_robot(), task.data, Use::fit);
  const Weighting weighting = equal_weights(task);
  State state;
  state.xi = task.xi;
  equations.start(state);
  double before = HUGE_VAL;
  for (int step = 0; step < kMostSteps; ++step) {
    const Linearised at = equations.linearise(state, weighting);
    if (std::abs(before - at.cost) < kSettled * at.cost) break;
    before = at.cost;
    const Eigen::MatrixXd W = at.R(Eigen::all, task.unknowns);
    state.xi(task.unknowns) += least_squares(W, at.R.rightCols(1));
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

/// Both have come to the same place.
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

// ------------------------------------------------------------------------------ Jacobians

void jacobian_selfcal(benchmark::State& state, int lanes) {
  const Robot& robot = example_robot();
  const Task& task = task_of(1000);
  ConfigurationBlock block{task.data.rows.q.topRows(kLanes).array(), lanes};
  for (int lane = lanes; lane < kLanes; ++lane) block.q.row(lane) = block.q.row(0);
  Locations X;
  PsiBlock psi;
  for (auto _ : state) {
    robot.locate(block, task.xi, Body::endpoint, X, &psi);
    benchmark::DoNotOptimize(psi.data());
  }
  state.SetItemsProcessed(state.iterations() * lanes);
}

void jacobian_plain(benchmark::State& state) {
  const Task& task = task_of(1000);
  const Arm arm(example_robot());
  Eigen::Matrix3Xd J;
  const Eigen::VectorXd q = task.data.rows.q.row(0).transpose();
  for (auto _ : state) benchmark::DoNotOptimize(endpoint_and_jacobian(arm, task.xi, q.data(), J));
  state.SetItemsProcessed(state.iterations());
}

void jacobian_ceres(benchmark::State& state) {
  const std::function<double()> row = automatic_row(task_of(1000));
  for (auto _ : state) benchmark::DoNotOptimize(row());
  state.SetItemsProcessed(state.iterations());
}

// ------------------------------------------------------------------------- identification

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

void one_pass(benchmark::State& state) {
  const Task& task = task_of(static_cast<int>(state.range(0)));
  const Equations equations(example_robot(), task.data, Use::fit);
  State at;
  at.xi = task.xi;
  equations.start(at);
  const Weighting weighting = equal_weights(task);
  for (auto _ : state) benchmark::DoNotOptimize(equations.linearise(at, weighting).cost);
  const double columns = equations.columns() + 1;
  state.counters["GFLOP/s"] =
      benchmark::Counter(1e-9 * 2 * 3 * static_cast<double>(state.range(0)) * columns * columns,
                         benchmark::Counter::kIsIterationInvariantRate);
}

// ------------------------------------------------------------------------ rank and choice

Eigen::MatrixXd stored_W(int rows) {
  const Task& task = task_of(rows);
  const Equations equations(example_robot(), task.data, Use::fit);
  State at;
  at.xi = task.xi;
  equations.start(at);
  return equations
      .dense(at, equal_weights(task).scale, std::vector<char>(task.data.rows.set.size(), 0))
      .W;
}

void rank_streamed(benchmark::State& state) {
  const Eigen::MatrixXd W = stored_W(10000);
  for (auto _ : state) {
    StreamingQr qr(static_cast<int>(W.cols()));
    qr.push(W);
    benchmark::DoNotOptimize(Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(qr.R()).rank());
  }
}

void rank_eigen(benchmark::State& state) {
  const Eigen::MatrixXd W = stored_W(10000);
  for (auto _ : state)
    benchmark::DoNotOptimize(Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(W).rank());
}

constexpr int kCandidates = 875, kChosen = 50;

std::vector<Eigen::MatrixXd> candidate_rows() {
  const Task& task = task_of(1000);
  const Eigen::MatrixXd W = stored_W(1000);
  const Eigen::Index rows = W.rows() / 1000;
  std::vector<Eigen::MatrixXd> list;
  for (int i = 0; i < kCandidates; ++i)
    list.push_back(W.middleRows(i * rows, rows)(Eigen::all, task.unknowns));
  return list;
}

double log_determinant_by_cholesky(const Eigen::MatrixXd& H) {
  return 2 * Eigen::LLT<Eigen::MatrixXd>(H).matrixLLT().diagonal().array().log().sum();
}

double log_determinant_by_values(const Eigen::MatrixXd& W) {
  return 2 * Eigen::BDCSVD<Eigen::MatrixXd>(W).singularValues().array().log().sum();
}

/// Add one, drop one, as long as it gains, a decomposition for every trial.
template <class Merit>
double add_and_drop_plainly(const std::vector<Eigen::MatrixXd>& candidates, Merit merit) {
  std::mt19937_64 random(1);
  std::vector<int> chosen = random_choice(kCandidates, kChosen, random);
  double best = merit(chosen);
  for (;;) {
    double most = -HUGE_VAL;
    int in = -1;
    for (int i = 0; i < static_cast<int>(candidates.size()); ++i) {
      if (std::ranges::find(chosen, i) != chosen.end()) continue;
      chosen.push_back(i);
      if (const double value = merit(chosen); value > most) most = value, in = i;
      chosen.pop_back();
    }
    chosen.push_back(in);
    most = -HUGE_VAL;
    std::size_t out = 0;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      std::vector<int> left = chosen;
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
      if (const double value = merit(left); value > most) most = value, out = k;
    }
    if (most <= best + 1e-9 * std::abs(best)) return best;
    chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(out));
    best = most;
  }
}

void choice_selfcal(benchmark::State& state) {
  const auto candidates = candidate_rows();
  for (auto _ : state) {
    std::mt19937_64 random(1);
    Design design(candidates, {});
    design.choose(random_choice(kCandidates, kChosen, random));
    add_and_drop(design);
    state.counters["log det"] = design.merit();
  }
}

void choice_cholesky(benchmark::State& state) {
  const auto candidates = candidate_rows();
  std::vector<Eigen::MatrixXd> H;
  for (const Eigen::MatrixXd& each : candidates) H.push_back(each.transpose() * each);
  for (auto _ : state)
    state.counters["log det"] =
        add_and_drop_plainly(candidates, [&](const std::vector<int>& chosen) {
          Eigen::MatrixXd sum = H[static_cast<std::size_t>(chosen.front())];
          for (std::size_t k = 1; k < chosen.size(); ++k)
            sum += H[static_cast<std::size_t>(chosen[k])];
          return log_determinant_by_cholesky(sum);
        });
}

void choice_values(benchmark::State& state) {
  const auto candidates = candidate_rows();
  for (auto _ : state)
    state.counters["log det"] =
        add_and_drop_plainly(candidates, [&](const std::vector<int>& chosen) {
          Eigen::MatrixXd W(3 * static_cast<Eigen::Index>(chosen.size()), kUnknowns);
          for (std::size_t k = 0; k < chosen.size(); ++k)
            W.middleRows(3 * static_cast<Eigen::Index>(k), 3) =
                candidates[static_cast<std::size_t>(chosen[k])];
          return log_determinant_by_values(W);
        });
}

// ------------------------------------------------------- a plan of many, commands in a loop

constexpr int kMany = 10000, kPlanned = 100;

std::vector<Eigen::MatrixXd> many_rows() {
  const Task& task = task_of(kMany);
  const Eigen::MatrixXd W = stored_W(kMany);
  const Eigen::Index rows = W.rows() / kMany;
  std::vector<Eigen::MatrixXd> list;
  for (int i = 0; i < kMany; ++i)
    list.push_back(W.middleRows(i * rows, rows)(Eigen::all, task.unknowns));
  return list;
}

void plan_of_many(benchmark::State& state) {
  const auto candidates = many_rows();
  for (auto _ : state) {
    std::mt19937_64 random(1);
    benchmark::DoNotOptimize(detmax(candidates, kPlanned, random).o1);
  }
}

/// One evaluation of a choice for each of the candidates.
void observability_of_many(benchmark::State& state) {
  const auto candidates = many_rows();
  Eigen::MatrixXd W(3 * kPlanned, kUnknowns);
  for (int i = 0; i < kPlanned; ++i)
    W.middleRows(3 * i, 3) = candidates[static_cast<std::size_t>(i)];
  for (auto _ : state)
    for (int i = 0; i < kMany; ++i) benchmark::DoNotOptimize(observability(W, kPlanned).o1);
}

/// The example robot, 1 mm and 1 mrad off, along a path of small steps.
void commands_in_a_loop(benchmark::State& state) {
  static const std::shared_ptr<const Robot> nominal(&example_robot(), [](const Robot*) {});
  Eigen::VectorXd xi = values(*nominal);
  for (Eigen::Index i = 0; i < xi.size(); ++i)
    if (nominal->parameters()[static_cast<std::size_t>(i)].free) xi[i] += i % 2 == 0 ? 1e-3 : -1e-3;
  Problems problems;
  const std::shared_ptr<const Robot> calibrated =
      make_robot(nominal->text().describe(xi), problems);
  std::vector<Location> path;
  Eigen::VectorXd q = (Eigen::VectorXd(6) << 0.0, -0.6, 0.9, 0.0, 1.2, 0.0).finished();
  for (int i = 0; i < 1000; ++i) {
    q[0] = 0.5 * std::sin(2 * M_PI * i / 1000);
    q[2] = 0.9 + 0.2 * std::cos(2 * M_PI * i / 1000);
    path.push_back(locate(*nominal, values(*nominal), q));
  }
  auto stream = CompensationStream::of(calibrated, q);
  expects(stream.has_value(), "the example robot is a chain");
  std::size_t i = 0;
  for (auto _ : state) {
    const StreamedCommand command = stream->command(path[i++ % path.size()]);
    expects(command.status == Streamed::reached, "every pose of the path is reached");
  }
}

// --------------------------------------------------------------------------- the diagnosis

void whole_diagnosis(benchmark::State& state) {
  static const std::shared_ptr<const Robot> robot(&example_robot(), [](const Robot*) {});
  DataSet data = task_of(400).data;
  for (int row = 0; row < data.rows.rows(); row += 4) data.rows.check[row] = 1;
  for (auto _ : state) benchmark::DoNotOptimize(diagnose(robot, data, {}, {}).p_value);
}

void register_all() {
  const auto add = [](const char* name, auto function) {
    return benchmark::RegisterBenchmark(name, function);
  };
  add("peak", peak);
  add("jacobian/selfcal-batched", [](benchmark::State& s) { jacobian_selfcal(s, kLanes); });
  add("jacobian/selfcal-one", [](benchmark::State& s) { jacobian_selfcal(s, 1); });
  add("jacobian/plain-eigen", jacobian_plain);
  add("jacobian/ceres-automatic", jacobian_ceres);
  for (const int rows : {1000, 10000, 100000}) {
    add("core/selfcal", [](benchmark::State& s) { identification(s, solve_by_selfcal); })
        ->Arg(rows)
        ->Unit(benchmark::kMillisecond);
    add("core/ceres-automatic-qr",
        [](benchmark::State& s) {
          identification(s, [](const Task& task) {
            return solve_by_ceres(task, Derivatives::automatic, Solver::qr);
          });
        })
        ->Arg(rows)
        ->Unit(benchmark::kMillisecond);
    add("core/ceres-analytic-normal",
        [](benchmark::State& s) {
          identification(s, [](const Task& task) {
            return solve_by_ceres(task, Derivatives::analytic, Solver::normal_equations);
          });
        })
        ->Arg(rows)
        ->Unit(benchmark::kMillisecond);
    add("pass/selfcal", one_pass)->Arg(rows)->Unit(benchmark::kMillisecond);
  }
  for (const int rows : {400, 10000})
    add("whole/selfcal", whole_identification)->Arg(rows)->Unit(benchmark::kMillisecond);
  add("rank/selfcal", rank_streamed)->Unit(benchmark::kMillisecond);
  add("rank/eigen-colpiv", rank_eigen)->Unit(benchmark::kMillisecond);
  add("choice/selfcal", choice_selfcal)->Unit(benchmark::kMillisecond);
  add("choice/cholesky", choice_cholesky)->Unit(benchmark::kMillisecond);
  add("choice/singular-values", choice_values)->Unit(benchmark::kMillisecond)->Iterations(1);
  add("plan/100-of-10000", plan_of_many)->Unit(benchmark::kMillisecond)->Iterations(1);
  add("plan/observability", observability_of_many)->Unit(benchmark::kMillisecond)->Iterations(1);
  add("compensation/loop", commands_in_a_loop);
  add("diagnosis/selfcal", whole_diagnosis)->Unit(benchmark::kMillisecond)->Iterations(1);
}

// ------------------------------------------------------------------------------ the ratios

/// Prints as usual, and keeps the best time of each for the ratios.
class Ratios final : public benchmark::ConsoleReporter {
 public:
  Ratios() : ConsoleReporter(OO_Tabular) {}

  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
      const auto items = run.counters.find("items_per_second");
      const double time = items != run.counters.end() && run.benchmark_name().starts_with("jac")
                              ? 1 / items->second.value
                              : run.cpu_accumulated_time / static_cast<double>(run.iterations);
      double& least = time_.try_emplace(run.benchmark_name(), HUGE_VAL).first->second;
      least = std::min(least, time);
      if (const auto rate = run.counters.find("GFLOP/s"); rate != run.counters.end())
        rate_[run.benchmark_name()] = std::max(rate_[run.benchmark_name()], rate->second.value);
    }
  }

  void print() const {
    std::printf("\nratios of this run            times  wanted\n");
    line("Jacobian, one, over Ceres", "jacobian/ceres-automatic", "jacobian/selfcal-one", 30);
    line("Jacobian, batched, over Ceres", "jacobian/ceres-automatic", "jacobian/selfcal-batched",
         300);
    for (const char* rows : {"1000", "10000", "100000"}) {
      const std::string n = std::string("/") + rows, of = std::string(rows) + " rows, core over ";
      line(of + "Ceres automatic", "core/ceres-automatic-qr" + n, "core/selfcal" + n, 40);
      line(of + "analytic", "core/ceres-analytic-normal" + n, "core/selfcal" + n, 10);
    }
    line("whole identify over its core, 10000", "whole/selfcal/10000", "core/selfcal/10000", 10,
         true);
    line("rank over Eigen", "rank/eigen-colpiv", "rank/selfcal", 3);
    line("choice over a Cholesky a trial", "choice/cholesky", "choice/selfcal", 15);
    line("choice over singular values a trial", "choice/singular-values/iterations:1",
         "choice/selfcal", 1000);
    line("100 of 10000 over an observability each", "plan/100-of-10000/iterations:1",
         "plan/observability/iterations:1", 100, true);
    if (time_.contains("compensation/loop"))
      std::printf("%-38s %6.3g us\n", "a command in a control loop",
                  1e6 * time_.at("compensation/loop"));
    line("diagnosis over identification, 400", "diagnosis/selfcal/iterations:1",
         "whole/selfcal/400", 20, true);
    if (rate_.contains("peak") && rate_.contains("pass/selfcal/10000"))
      std::printf("%-38s %6.0f %%   40 %%\n", "a pass of the peak",
                  100 * rate_.at("pass/selfcal/10000") / rate_.at("peak"));
  }

 private:
  void line(const std::string& what, const std::string& slow, const std::string& fast,
            double wanted, bool at_most = false) const {
    if (!time_.contains(slow) || !time_.contains(fast)) return;
    std::printf("%-38s %6.3g  %s%g\n", what.c_str(), time_.at(slow) / time_.at(fast),
                at_most ? "at most " : "", wanted);
  }

  std::map<std::string, double> time_, rate_;
};

}  // namespace
}  // namespace selfcal::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  selfcal::bench::register_all();
  selfcal::bench::Ratios ratios;
  benchmark::RunSpecifiedBenchmarks(&ratios);
  ratios.print();
  return 0;
}
