// Rows that are false beside a cause: neither a part of it nor a cause of their own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "diagnosis/diagnosis.h"
#include "tests/diagnosis/two_sessions.h"

namespace selfcal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// The step makes the noise look so large that the false row is not put aside before it is known.
TEST(FalseRows, AreNoStepAwayAndBack) {
  DataSet data = TwoSessions(110).before;
  const int rows = data.rows.rows(), false_row = 11;
  data.rows.time = Eigen::VectorXd::LinSpaced(rows, 0, 1000);
  for (int row = rows / 2; row < rows; ++row)
    data.rows.position.row(row) += Eigen::RowVector3d(2e-4, -3e-4, 7e-4);
  data.rows.position.row(false_row) += Eigen::RowVector3d(-3e-4, 4e-4, -7e-4);
  const Diagnosis found = diagnose(TwoSessions(2).robot, data, quick());
  EXPECT_EQ(found.verdict.effect, "base_drift") << found.why;
  EXPECT_THAT(found.verdict.shape, Not(HasSubstr("again")));
  EXPECT_GT(found.verdict.probability, 0.9);
  EXPECT_EQ(std::ranges::count(found.outliers, false_row + 1, &Outlier::row), 1);
}

}  // namespace
}  // namespace selfcal
