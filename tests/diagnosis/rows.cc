#include "diagnosis/evidence/rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace selfcal {
namespace {

TEST(WeighedRows, AreOneOfSoManyConfigurationsWithAllItsRepeats) {
  Observations rows;
  rows.q.setZero(8, 1);
  rows.check = {0, 0, 0, 1, 0, 0, 0, 0};
  rows.repeat = {5, 5, -1, -1, -1, 6, 6, -1};
  // Five configurations that judge nothing; one of the first two, of the next two, the last.
  EXPECT_EQ(weighed_rows(rows, 8, 4), (std::vector<char>{1, 1, 0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(weighed_rows(rows, 8, 8), (std::vector<char>{1, 1, 1, 0, 1, 1, 1, 1}));
}

TEST(WeighedRows, DoNotKeepStepWithHowASessionAlternates) {
  for (const int period : {2, 3, 4, 5}) {
    Observations rows;
    rows.q.setZero(1200, 1);
    rows.check.assign(1200, 0);
    for (const double step : {2.0, 3.0, 4.0, 4.5, 6.0}) {
      const std::vector<char> take = weighed_rows(rows, 1200, 1200 / step);
      std::vector<int> of_kind(static_cast<size_t>(period), 0);
      for (size_t row = 0; row < take.size(); ++row) of_kind[row % period] += take[row];
      EXPECT_NEAR(std::accumulate(of_kind.begin(), of_kind.end(), 0), 1200 / step, 1);
      for (const int count : of_kind)
        EXPECT_NEAR(count, 1200 / step / period, 0.2 * 1200 / step / period + 1)
            << period << " kinds, one of " << step;
    }
  }
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
