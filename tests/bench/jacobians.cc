// Location and derivatives of one configuration and of many at once.
#include <functional>

#include "tests/bench/contenders.h"
#include "tests/bench/kdl_arm.h"
#include "tests/bench/tasks.h"

namespace selfcal::bench {
namespace {

void jacobian_selfcal(benchmark::State& state, int lanes) {
  const Robot& robot = example_robot();
  const Task& task = task_of(1000);
  const ConfigurationBlock block{task.data.rows.q.topRows(lanes).array(), lanes};
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

void jacobian_kdl(benchmark::State& state) {
  const std::function<double()> row = kdl_row(task_of(1000));
  for (auto _ : state) benchmark::DoNotOptimize(row());
  state.SetItemsProcessed(state.iterations());
}

}  // namespace

void add_jacobians() {
  add_task("jacobian/selfcal-batched", [](benchmark::State& s) { jacobian_selfcal(s, kLanes); });
  add_task("jacobian/selfcal-one", [](benchmark::State& s) { jacobian_selfcal(s, 1); });
  add_task("jacobian/plain-eigen", jacobian_plain);
  add_task("jacobian/kdl-joints-alone", jacobian_kdl);
  add_task("jacobian/ceres-automatic", jacobian_ceres);
}

}  // namespace selfcal::bench
