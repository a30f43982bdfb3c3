// The figures of a gap, worked by hand on a few rows.
#include "diagnosis/validation/gap.h"

#include <gtest/gtest.h>

#include <cmath>

namespace selfcal {
namespace {

/// Rows that are all alike, each a block of its own; squares in units of the floor's.
std::vector<ValidationRow> rows(double before, double after, double all) {
  std::vector<ValidationRow> list(40, {9, before, after, all, 1});
  for (int i = 0; i < 40; ++i) list[i].block = i;
  return list;
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
  std::vector<ValidationRow> list = rows(4, 3, 1);
  for (size_t i = 0; i < list.size(); i += 2) list[i].after = 6;
  const Gap gap = gap_of(list, 1);
  // Mean of after 4.5, of one row off by 1.5: over 40 rows 0.24, and 1.96 sigma of it over 3.
  const double half = 1.96 * 1.5 / std::sqrt(40.0) / 3;
  EXPECT_NEAR(gap.closed.least, -0.5 / 3 - half, 0.3 * half);
  EXPECT_NEAR(gap.closed.most, -0.5 / 3 + half, 0.3 * half);
  EXPECT_DOUBLE_EQ(gap.closed_all.least, 1);
}

TEST(Gap, HasAWiderIntervalWhereNeighboursErrAlike) {
  std::vector<ValidationRow> list = rows(4, 3, 1);
  for (int i = 0; i < 40; ++i) list[i].after = i / 4 % 2 == 0 ? 6 : 3;
  const Closed apart = gap_of(list, 1).closed;
  for (int i = 0; i < 40; ++i) list[i].block = i / 4;
  const Closed together = gap_of(list, 1).closed;
  EXPECT_EQ(*together.fraction, *apart.fraction);
  // Ten independent numbers in place of forty: twice as wide, within a fifth (1000 resamples).
  EXPECT_NEAR((together.most - together.least) / (apart.most - apart.least), 2, 0.4);
}

TEST(Gap, HasTheFloorsOwnDoubtInItsInterval) {
  // All rows alike: only the floor is in doubt. With 50 freedoms its variance is 0.70 to 1.55 of
  // the stated one (50 over the 2.5 and 97.5 % points of chi-square, 71.4 and 32.4), and closed is
  // 1 - (2 - f) / (4 - f).
  const Closed closed = gap_of(rows(4, 2, 1), 1, 50).closed;
  EXPECT_DOUBLE_EQ(*closed.fraction, 2.0 / 3);
  EXPECT_NEAR(closed.least, 1 - (2 - 0.70) / (4 - 0.70), 0.02);
  EXPECT_NEAR(closed.most, 1 - (2 - 1.55) / (4 - 1.55), 0.02);
}

TEST(Gap, GivesNoIntervalWhereResamplesLieWithinTheFloor) {
  const Closed closed = gap_of(rows(1.2, 1.1, 1), 1, 50).closed;
  EXPECT_TRUE(closed.fraction);
  EXPECT_EQ(closed.least, -INFINITY);
  EXPECT_EQ(closed.most, INFINITY);
}

TEST(Gap, GivesNoIntervalOfFewBlocks) {
  std::vector<ValidationRow> list = rows(4, 3, 1);
  const auto bounded = [&](int blocks) {
    for (size_t i = 0; i < list.size(); ++i) list[i].block = static_cast<int>(i) % blocks;
    const Gap gap = gap_of(list, 1);
    EXPECT_TRUE(gap.closed.fraction);
    return std::isfinite(gap.closed.least) && std::isfinite(gap.closed.most);
  };
  EXPECT_FALSE(bounded(1));
  EXPECT_FALSE(bounded(5));
  EXPECT_TRUE(bounded(6));
}

TEST(Gap, CountsTheRowsThatAreLeftOutAndSaysWhatItIsWithThem) {
  std::vector<ValidationRow> list = rows(4, 3, 1);
  list[7] = {900, 404, 403, 401, 1, 7, true};
  const Gap gap = gap_of(list, 1);
  EXPECT_EQ(gap.rows, 39);
  EXPECT_EQ(gap.false_rows, 1);
  EXPECT_DOUBLE_EQ(gap.rms_before, 2);
  EXPECT_DOUBLE_EQ(gap.with_false_rows.before, std::sqrt(4 + 400.0 / 40));
  EXPECT_DOUBLE_EQ(gap.with_false_rows.after, std::sqrt(3 + 400.0 / 40));
  EXPECT_DOUBLE_EQ(gap.with_false_rows.all, std::sqrt(1 + 400.0 / 40));
}

TEST(Gap, LeavesNoRowOutWhereMoreThanAFifthWouldBe) {
  std::vector<ValidationRow> list = rows(4, 4, 4);
  for (size_t i = 0; i < 8; ++i) list[i].false_reading = true;
  EXPECT_EQ(gap_of(list, 1).false_rows, 8);
  list[8].false_reading = true;
  EXPECT_EQ(gap_of(list, 1).false_rows, 0) << "the machine is another one there";
  EXPECT_EQ(gap_of(list, 1).rows, 40);
}

TEST(Gap, OfNoRowsHasNoFigures) {
  const Gap gap = gap_of({}, 1);
  EXPECT_EQ(gap.rows, 0);
  EXPECT_FALSE(gap.closed.fraction || gap.closed_all.fraction);
}

}  // namespace
}  // namespace selfcal
