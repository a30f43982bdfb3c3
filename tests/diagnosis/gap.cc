// The figures of a gap, worked by hand on a few rows.
#include "diagnosis/validation/gap.h"

#include <gtest/gtest.h>

#include <cmath>

namespace selfcal {
namespace {

/// Rows that are all alike; squares in units of the floor's.
std::vector<JudgedRow> rows(double before, double after, double all) {
  return std::vector<JudgedRow>(40, {9, before, after, all, 1});
}

TEST(Gap, TellsWhatIsNamedFromEverythingFound) {
  const Gap gap = gap_of(rows(4, 3, 1.5), 1);
  EXPECT_DOUBLE_EQ(gap.rms_nominal, 3);
  EXPECT_DOUBLE_EQ(gap.rms_before, 2);
  EXPECT_DOUBLE_EQ(gap.rms_after, std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(gap.rms_all, std::sqrt(1.5));
  EXPECT_DOUBLE_EQ(gap.max_after, std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(gap.max_all, std::sqrt(1.5));
  ASSERT_TRUE(gap.closed.fraction && gap.closed_all.fraction);
  EXPECT_DOUBLE_EQ(*gap.closed.fraction, 1 - 2.0 / 3);
  EXPECT_DOUBLE_EQ(*gap.closed_all.fraction, 1 - 0.5 / 3);
}

TEST(Gap, CutsNeitherWhatOpensItNorWhatIsBelowTheFloor) {
  const Gap gap = gap_of(rows(4, 5, 0.5), 1);
  EXPECT_DOUBLE_EQ(*gap.closed.fraction, 1 - 4.0 / 3);
  EXPECT_DOUBLE_EQ(*gap.closed_all.fraction, 1 + 0.5 / 3);
  // Of rows that are all alike every resample says the same.
  EXPECT_DOUBLE_EQ(gap.closed.least, *gap.closed.fraction);
  EXPECT_DOUBLE_EQ(gap.closed.most, *gap.closed.fraction);
  EXPECT_DOUBLE_EQ(gap.closed_all.most, *gap.closed_all.fraction);
}

TEST(Gap, ClosesBySoMuchOnlyWhereItIsMoreThanFivePercentOfTheFloor) {
  const Gap within = gap_of(rows(1.05 * 1.05 - 1e-6, 0.5, 0.5), 1);
  EXPECT_FALSE(within.closed.fraction || within.closed_all.fraction);
  const Gap beyond = gap_of(rows(1.05 * 1.05 + 1e-6, 0.5, 0.5), 1);
  EXPECT_TRUE(beyond.closed.fraction && beyond.closed_all.fraction);
}

TEST(Gap, HasAnIntervalAsWideAsItsRowsDiffer) {
  std::vector<JudgedRow> list = rows(4, 3, 1);
  for (size_t i = 0; i < list.size(); i += 2) list[i].after = 6;
  const Gap gap = gap_of(list, 1);
  // Mean of after 4.5, of one row off by 1.5: over 40 rows 0.24, and 1.96 sigma of it over 3.
  const double half = 1.96 * 1.5 / std::sqrt(40.0) / 3;
  EXPECT_NEAR(gap.closed.least, -0.5 / 3 - half, 0.3 * half);
  EXPECT_NEAR(gap.closed.most, -0.5 / 3 + half, 0.3 * half);
  EXPECT_DOUBLE_EQ(gap.closed_all.least, 1);
}

TEST(Gap, OfNoRowsHasNoFigures) {
  const Gap gap = gap_of({}, 1);
  EXPECT_EQ(gap.rows, 0);
  EXPECT_FALSE(gap.closed.fraction || gap.closed_all.fraction);
}

}  // namespace
}  // namespace selfcal
