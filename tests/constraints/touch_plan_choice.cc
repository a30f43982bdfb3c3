// Planned touches tell more than others would.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "constraints/configurations.h"
#include "constraints/equations.h"
#include "kinematics/linear_algebra.h"
#include "tests/constraints/touch_plan_cell.h"

namespace selfcal {
namespace {

/// log det of what rows at these readings and the priors say of the robot and the plane.
double information(const Cell& cell, const std::vector<Eigen::VectorXd>& rows) {
  DataSet data;
  data.sets = cell.sets;
  const auto count = static_cast<Eigen::Index>(rows.size());
  data.rows.q.resize(count, 6);
  for (Eigen::Index row = 0; row < count; ++row) data.rows.q.row(row) = rows[row].transpose();
  data.rows.set.assign(rows.size(), 0);
  data.rows.group.assign(rows.size(), -1);
  data.rows.check.assign(rows.size(), 0);
  const Equations equations(rx90(), data, Use::fit);
  State state;
  state.xi = values(rx90());
  equations.start(state);
  Weighting weighting;
  weighting.scale = {{2e-5, 1}};
  weighting.put_aside.assign(rows.size(), 0);
  const Eigen::MatrixXd R = equations.linearise(state, weighting).R;
  const Eigen::Index columns = equations.columns();
  Eigen::MatrixXd A = R.leftCols(columns).transpose() * R.leftCols(columns);
  for (Eigen::Index i = 0; i < columns; ++i) {
    const bool own = i >= equations.robot_columns();
    const Parameter* each = own ? nullptr : &rx90().parameters()[i];
    const double sigma = own ? 1 : each->free ? each->tolerance : 1e-9;
    A(i, i) += 1 / (sigma * sigma);
  }
  return symmetric_eigen(A).values.array().max(1e-12).log().sum();
}

TEST(TouchPlan, TellsMoreThanTouchesByChanceDo) {
  constexpr int kTouches = 20;
  Cell cell;
  cell.plane({0.75, 0, 0.15}, {0, 0, 1}, 0.25, kTouches);
  std::vector<Eigen::VectorXd> planned;
  for (const PlannedTouch& each : cell.plan().touches) planned.push_back(each.touch);
  double best_by_chance = -HUGE_VAL;
  for (unsigned seed = 1; seed <= 9; ++seed) {
    Random random(seed);
    DataSet data;
    data.sets = cell.sets;
    SampleRequest request;
    request.rows = kTouches;
    request.own = cell.targets[0].own;
    request.patch = cell.targets[0].within;
    sample_rows(rx90(), values(rx90()), {request}, random, data);
    std::vector<Eigen::VectorXd> rows;
    for (int row = 0; row < data.rows.rows(); ++row)
      rows.push_back(data.rows.q.row(row).transpose());
    best_by_chance = std::max(best_by_chance, information(cell, rows));
  }
  // Those by chance may lie anywhere on the plane; the planned ones must be reached from home.
  EXPECT_GT(information(cell, planned), best_by_chance);
}

}  // namespace
}  // namespace selfcal
