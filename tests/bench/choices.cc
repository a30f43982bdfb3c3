// Rank of many rows, the choice of few among many, commands in a loop.
#include <cmath>

#include "constraints/equations/streaming_qr.h"
#include "constraints/identifiability/observability.h"
#include "constraints/planning/detmax.h"
#include "kinematics/expects.h"
#include "kinematics/inverse/compensation_stream.h"
#include "kinematics/make_robot.h"
#include "tests/bench/tasks.h"

namespace selfcal::bench {
namespace {

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

std::vector<Eigen::MatrixXd> candidate_rows(int count = kCandidates) {
  const Task& task = task_of(count);
  const Eigen::MatrixXd W = stored_W(count);
  const Eigen::Index rows = W.rows() / count;
  std::vector<Eigen::MatrixXd> list;
  for (int i = 0; i < count; ++i)
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
  const auto count = static_cast<int>(state.range(0));
  const auto candidates = candidate_rows(count);
  for (auto _ : state) {
    std::mt19937_64 random(1);
    Design design(candidates, {});
    design.choose(random_choice(count, kChosen, random));
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

constexpr int kMany = 10000, kPlanned = 100;

void plan_of_many(benchmark::State& state) {
  const auto candidates = candidate_rows(kMany);
  for (auto _ : state) {
    std::mt19937_64 random(1);
    benchmark::DoNotOptimize(detmax(candidates, kPlanned, random).o1);
  }
}

/// One evaluation of a choice for each of the candidates.
void observability_of_many(benchmark::State& state) {
  const auto candidates = candidate_rows(kMany);
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

}  // namespace

void add_choices() {
  add_task("rank/selfcal", rank_streamed)->Unit(benchmark::kMillisecond);
  add_task("rank/eigen-colpiv", rank_eigen)->Unit(benchmark::kMillisecond);
  add_task("choice/selfcal", choice_selfcal)->Arg(kCandidates)->Unit(benchmark::kMillisecond);
  for (const int candidates : {200, 400, 1600, 3200})
    add_task("choice/selfcal", choice_selfcal)->Arg(candidates)->Unit(benchmark::kMillisecond);
  add_task("choice/cholesky", choice_cholesky)->Unit(benchmark::kMillisecond);
  add_task("choice/singular-values", choice_values)->Unit(benchmark::kMillisecond)->Iterations(1);
  add_task("plan/100-of-10000", plan_of_many)->Unit(benchmark::kMillisecond)->Iterations(1);
  add_task("plan/observability", observability_of_many)
      ->Unit(benchmark::kMillisecond)
      ->Iterations(1);
  add_task("compensation/loop", commands_in_a_loop);
}

}  // namespace selfcal::bench
