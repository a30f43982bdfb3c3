// Rows put aside that have something in common, and such that have nothing.
#include "diagnosis/report/shared_by_outliers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/diagnosis/two_sessions.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

class SharedByOutliers : public testing::Test {
 protected:
  SharedByOutliers() {
    Observations& rows = data.rows;
    rows.velocity = Eigen::MatrixXd::Ones(rows.rows(), rows.q.cols());
    rows.time.resize(rows.rows());
    double now = 0;
    for (int row = 0; row < rows.rows(); ++row) {
      rows.velocity(row, 1) = row % 6 == 0 ? -1 : 1;
      rows.time[row] = now += row % 10 == 3 ? 600 : 20;
    }
  }
  std::string of(const std::vector<int>& rows) const {
    std::vector<Outlier> outliers;
    for (const int row : rows) outliers.push_back({row + 1, "tracker", 0, false, ""});
    return shared_by_outliers(data, sessions.robot->joints(), outliers);
  }
  const TwoSessions sessions;
  DataSet data = sessions.before;  // of 60 rows
};

TEST_F(SharedByOutliers, IsTheWayThatAJointWasApproached) {
  // Ten of sixty go downwards: five of five by chance in 252 of 5.46 million draws.
  EXPECT_THAT(of({0, 12, 24, 36, 48}),
              HasSubstr("of the 5 rows put aside as false 5 were approached with j2 going "
                        "downwards, as 10 of all 60 rows were"));
}

TEST_F(SharedByOutliers, IsAPauseBefore) {
  EXPECT_THAT(of({3, 13, 23, 43, 53}), HasSubstr("5 were taken after a pause, as 6 of all 60"));
}

TEST_F(SharedByOutliers, IsNoPauseWhereNotEveryRowHasItsTime) {
  data.rows.time[7] = std::nan("");
  EXPECT_EQ(of({3, 13, 23, 43, 53}), "");
}

TEST_F(SharedByOutliers, CountsNoRowThatTakesNoPart) {
  for (int row = 6; row < 12; ++row) data.rows.check[row] = kCopy;
  EXPECT_THAT(of({0, 12, 24, 36, 48}), HasSubstr("as 9 of all 54 rows were"));
}

TEST_F(SharedByOutliers, IsNothingWhereChanceDoesAsMuch) {
  EXPECT_EQ(of({1, 14, 25, 38, 47, 56}), "");
  EXPECT_EQ(of({0, 12, 24}), "") << "three rows say little";
  EXPECT_EQ(of({}), "");
}

}  // namespace
}  // namespace selfcal
