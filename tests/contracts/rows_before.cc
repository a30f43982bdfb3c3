// What readings in either row of an equation of two do, against equations of one moved reading.
#include "constraints/equations/rows_before.h"

#include <gtest/gtest.h>

#include "tests/contracts/equations_case.h"

namespace selfcal {
namespace {

TEST(RowsBefore, MoveTheirShareOfAnEquation) {
  constexpr double kOff = 1e-5;
  EquationsCase of(3);
  for (std::size_t i = 0; i < of.robot->parameters().size(); ++i)
    if (of.robot->parameters()[i].part == Part::gear)  // a reading is its zero then
      of.state.xi[static_cast<Eigen::Index>(i)] = of.robot->parameters()[i].nominal;
  const std::vector<Scale>& scale = of.weighting.scale;
  const std::vector<char>& outlier = of.weighting.outlier;
  const Equations equations(*of.robot, of.data, Use::fit);
  const DenseEquations dense = equations.dense(of.state, scale, outlier);
  const RowsBefore before = rows_before(equations, of.state, scale, outlier, dense);
  ASSERT_EQ(before.of.size(), static_cast<std::size_t>(of.data.rows.rows()));
  int pairs = 0;
  for (int row = 0; row < of.data.rows.rows(); row += 3) {
    const int j = row % static_cast<int>(of.robot->joints().size());
    DataSet moved = of.data;
    moved.rows.q(row, j) += kOff;
    const Eigen::VectorXd y =
        Equations(*of.robot, moved, Use::fit).dense(of.state, scale, outlier).y;
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const int now = dense.row[static_cast<std::size_t>(i)];
      const int former = now < 0 ? -1 : before.of[static_cast<std::size_t>(now)];
      double by = 0;
      if (now == row) by = dense.W(i, of.robot->variable_parameter(j)) - before.by_joint(i, j);
      if (former == row) by = before.by_joint(i, j);
      pairs += former == row;
      EXPECT_NEAR((dense.y[i] - y[i]) / kOff, by, 2e-3) << "row " << row << ", equation " << i;
    }
  }
  EXPECT_GT(pairs, 5);
}

TEST(RowsBefore, AreNoneWhereEachEquationHasOneRow) {
  EquationsCase of(3);
  for (int row = 0; row < of.data.rows.rows(); ++row)
    if (of.data.sets[static_cast<std::size_t>(of.data.rows.set[row])].method->paired())
      of.data.rows.check[static_cast<std::size_t>(row)] = 1;
  const Equations equations(*of.robot, of.data, Use::fit);
  const DenseEquations dense = equations.dense(of.state, of.weighting.scale, of.weighting.outlier);
  EXPECT_TRUE(
      rows_before(equations, of.state, of.weighting.scale, of.weighting.outlier, dense).of.empty());
}

}  // namespace
}  // namespace selfcal
