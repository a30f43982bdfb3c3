// Rows that are moved to a wanted residual, more at once than there are lanes.
#include <gtest/gtest.h>

#include "constraints/sampling/contact.h"
#include "tests/contracts/constrained_positions.h"

namespace selfcal {
namespace {

TEST(MovedRows, AreWhereEachAloneComesAndHaveTheWantedResidual) {
  const auto arm = six_axis_arm();
  const auto [data, sampled] = at_constrained_positions(*arm, 40);
  ASSERT_EQ(sampled.unreached, "");
  Random random(5);
  std::vector<int> rows;
  Eigen::MatrixXd wanted(40, 3);
  std::uniform_real_distribution<double> metres(-2e-3, 2e-3);
  for (int row = 0; row < 40; ++row) {
    rows.push_back(row);
    for (int a = 0; a < 3; ++a) wanted(row, a) = metres(random);
  }
  const auto moved = moved_to_residuals(*arm, data, sampled.truth, rows, wanted, data.rows.q);
  ASSERT_EQ(moved.size(), rows.size());
  DataSet there = data;
  for (const int row : rows) {
    Eigen::VectorXd alone = data.rows.q.row(row).transpose();
    ASSERT_TRUE(
        move_to_residual(*arm, data, sampled.truth, row, wanted.row(row).transpose(), alone));
    const auto& together = moved[static_cast<std::size_t>(row)];
    ASSERT_TRUE(together) << row;
    EXPECT_LT((*together - alone).norm(), 1e-9) << row;
    there.rows.q.row(row) = together->transpose();
  }
  const Equations equations(*arm, there, Use::fit);
  for (const RowResidual& row : equations.residuals(sampled.truth))
    EXPECT_NEAR(row.length, wanted.row(row.row).norm(), 1e-9);
}

/// Farther than a machine gives way the place is another one.
TEST(MovedRows, ThatWouldHaveToGoFarAreNotMoved) {
  const auto arm = six_axis_arm();
  const auto [data, sampled] = at_constrained_positions(*arm, 4);
  Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(4, 3);
  wanted(1, 0) = 50;
  const auto moved =
      moved_to_residuals(*arm, data, sampled.truth, {0, 1, 2, 3}, wanted, data.rows.q);
  EXPECT_TRUE(moved[0]);
  EXPECT_FALSE(moved[1]);
  EXPECT_TRUE(moved[2]);
}

}  // namespace
}  // namespace selfcal
