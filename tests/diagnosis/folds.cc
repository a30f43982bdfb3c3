// Each row judges once, and repeats stay together.
#include "diagnosis/validation/folds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "diagnosis/constants.h"

namespace selfcal {
namespace {

/// 40 rows of two sets in turn; rows 10 to 15 are repeats of one configuration of the first set.
DataSet forty_rows() {
  DataSet data;
  data.sets.resize(2);
  data.rows.q.setZero(40, 1);
  for (int row = 0; row < 40; ++row) {
    const bool repeat = row >= 10 && row < 16;
    data.rows.set.push_back(repeat ? 0 : row % 2);
    data.rows.repeat.push_back(repeat ? 7 : -1);
    data.rows.check.push_back(0);
  }
  return data;
}

TEST(Folds, LetEachRowJudgeOnce) {
  const DataSet data = forty_rows();
  std::vector<int> judged(40, 0);
  for (int fold = 0; fold < kDiagnosis.validation.folds; ++fold) {
    const DataSet part = with_fold(data, fold);
    for (int row = 0; row < 40; ++row) judged[row] += part.rows.check[row];
  }
  EXPECT_EQ(judged, std::vector<int>(40, 1));
}

TEST(Folds, KeepRepeatsTogetherAndLeaveOutStretches) {
  const DataSet data = forty_rows();
  for (int fold = 0; fold < kDiagnosis.validation.folds; ++fold) {
    const DataSet part = with_fold(data, fold);
    for (int row = 11; row < 16; ++row)
      EXPECT_EQ(part.rows.check[row], part.rows.check[10]) << fold << " " << row;
    int changes = 0;  // along the second set: two stretches of six
    for (int row = 3, last = part.rows.check[1]; row < 40; row += 2)
      if (data.rows.set[row] == 1 && part.rows.check[row] != last) {
        last = part.rows.check[row];
        ++changes;
      }
    EXPECT_GE(changes, 2);
    EXPECT_LE(changes, 4);
  }
}

TEST(Folds, AndBlocksGoByTheTimesAndNotByTheOrderInTheFile) {
  DataSet data = forty_rows();
  data.rows.time = Eigen::VectorXd::LinSpaced(40, 0, 39);
  std::vector<int> order(40);
  for (int row = 0; row < 40; ++row) order[row] = (row * 7) % 40;
  DataSet shuffled = data;
  shuffled.rows = taken(data.rows, order);
  const DataSet part = with_fold(data, 1), other = with_fold(shuffled, 1);
  const auto judging = [](DataSet whole) {
    for (int row = 0; row < 40; ++row) whole.rows.check[row] = whole.rows.time[row] >= 4;
    return validation_blocks(whole);
  };
  const std::vector<int> block = judging(data), other_block = judging(shuffled);
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(other.rows.check[i], part.rows.check[order[i]]) << i;
    for (int j = 0; j < 40; ++j)
      EXPECT_EQ(other_block[i] == other_block[j], block[order[i]] == block[order[j]]) << i << j;
  }
}

TEST(ValidationBlocks, HoldAFewNeighboursOfOneSetAndTheirRepeats) {
  DataSet data = forty_rows();  // 19 and 16 configurations: 35 rows beyond the repeats
  for (int row = 0; row < 40; ++row) data.rows.check[row] = row >= 4;
  const std::vector<int> block = validation_blocks(data);
  for (int row = 0; row < 4; ++row) EXPECT_EQ(block[row], -1);
  for (int row = 11; row < 16; ++row) EXPECT_EQ(block[row], block[10]);
  // Of the second set's rows 5, 7, 9, 17, ... 39 (15 of them): as many as the cube root, 2.5, says.
  std::map<int, int> of_block;
  int most = 0;
  for (int row = 5; row < 40; row += 2)
    if (data.rows.set[row] == 1) most = std::max(most, ++of_block[block[row]]);
  EXPECT_EQ(most, 2);
  EXPECT_EQ(of_block.size(), 8u);
  for (int row = 4; row < 40; ++row)
    EXPECT_EQ(of_block.contains(block[row]), data.rows.set[row] == 1) << row;
}

}  // namespace
}  // namespace selfcal
