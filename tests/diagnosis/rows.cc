#include "diagnosis/evidence/rows.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace selfcal {
namespace {

TEST(WeighedRows, AreEverySoManyConfigurationsWithAllTheirRepeats) {
  Observations rows;
  rows.q.setZero(8, 1);
  rows.check = {0, 0, 0, 1, 0, 0, 0, 0};
  rows.repeat = {5, 5, -1, -1, -1, 6, 6, -1};
  // Five configurations that judge nothing; every second of them.
  EXPECT_EQ(weighed_rows(rows, 8, 4), (std::vector<char>{1, 1, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(weighed_rows(rows, 8, 8), (std::vector<char>{1, 1, 1, 0, 1, 1, 1, 1}));
}

TEST(Kept, HoldsWhatNoRowCarries) {
  DenseEquations all;
  all.W = Eigen::MatrixXd::Identity(3, 3);
  all.y = Eigen::Vector3d(1, 2, 3);
  all.shift.setZero(3, 3);
  all.row = {0, 1, -1};
  const DenseEquations some = kept(all, {0, 1});
  EXPECT_EQ(some.row, (std::vector<int>{1, -1}));
  EXPECT_EQ(some.y, Eigen::Vector2d(2, 3));
  EXPECT_EQ(some.W(1, 2), 1);
}

}  // namespace
}  // namespace selfcal
