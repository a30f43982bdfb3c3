// Ranks of columns made by hand: one that depends on others, one that is zero.
#include "constraints/identifiability/identifiability.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

constexpr int kRows = 50;
constexpr double kRounding = 1e-12;  // of columns of length 7

/// Columns a, b, c = 2 a - 3 b and 0.
Eigen::MatrixXd hand_made() {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(kRows, 4);
  for (int i = 0; i < kRows; ++i) W.row(i).head<2>() << normal(random), normal(random);
  W.col(2) = 2 * W.col(0) - 3 * W.col(1);
  triangularise(W);
  return W.topRows(4);
}

RankRule structural_rule() {
  RankRule rule;
  rule.rows = kRows;
  return rule;
}

std::vector<Status> statuses(const std::vector<ColumnRank>& ranks) {
  std::vector<Status> list;
  for (const ColumnRank& rank : ranks) list.push_back(rank.status);
  return list;
}

auto carrier(int position, double coefficient) {
  return Pair(position, testing::DoubleNear(coefficient, kRounding));
}

TEST(RankColumns, GroupsTheDependentColumnWithTheOnesBeforeItAndFindsTheZeroOne) {
  const auto ranks = rank_columns(hand_made(), {0, 1, 2, 3}, 0, structural_rule());
  EXPECT_THAT(statuses(ranks), ElementsAre(Status::identified, Status::identified, Status::grouped,
                                           Status::no_effect));
  EXPECT_THAT(ranks[2].carriers, ElementsAre(carrier(0, 2), carrier(1, -3)));
  EXPECT_THAT(ranks[3].carriers, IsEmpty());
}

TEST(RankColumns, FollowsTheOrderOfPreference) {
  const auto ranks = rank_columns(hand_made(), {3, 2, 0, 1}, 0, structural_rule());
  EXPECT_THAT(statuses(ranks), ElementsAre(Status::no_effect, Status::identified,
                                           Status::identified, Status::grouped));
  // b = (2 a - c) / 3; c stands at position 1 of the order, a at 2.
  EXPECT_THAT(ranks[3].carriers, ElementsAre(carrier(1, -1.0 / 3), carrier(2, 2.0 / 3)));
}

TEST(RankColumns, TakesLeadingUnknownsFirstAndDoesNotRankThem) {
  const auto ranks = rank_columns(hand_made(), {2, 3, 1, 0}, 2, structural_rule());
  ASSERT_EQ(ranks.size(), 2u);
  EXPECT_THAT(statuses(ranks), ElementsAre(Status::identified, Status::grouped));
  // a = (c + 3 b) / 2: the leading c carries too.
  EXPECT_THAT(ranks[1].carriers, ElementsAre(carrier(0, 0.5), carrier(2, 1.5)));
}

TEST(RankColumns, OfRealRowsAsksWhatTheNoiseAllows) {
  // Whitened columns: a parameter is known to 1 / (length beyond the others); least_sigma 2e-3.
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(4, 4);
  R(0, 0) = 1000;               // known to 1e-3
  R(1, 1) = 400;                // known to 2.5e-3: hardly seen
  R.col(2) << 1000, 0, 400, 0;  // seen, but not told from the first to better than 2.5e-3
  R.col(3) << 5, 0, 0, 600;     // known, its share of the first is noise
  const auto ranks = rank_columns(R, {0, 1, 2, 3}, 0, RankRule{});
  EXPECT_THAT(statuses(ranks), ElementsAre(Status::identified, Status::no_effect, Status::grouped,
                                           Status::identified));
  EXPECT_THAT(ranks[2].carriers, ElementsAre(carrier(0, 1)));
}

TEST(RankColumns, OfRealRowsAsksMoreOfAGearRatioThanOfAnAngle) {
  // Both known to 5e-4: of an angle enough, of a ratio (least_ratio_sigma 1e-4) hardly seen; the
  // third, a ratio too, to 5e-5.
  const Eigen::MatrixXd R = Eigen::Vector4d(2000, 2000, 20000, 1).asDiagonal();
  RankRule rule;
  rule.least = {2e-3, 1e-4, 1e-4, 2e-3};
  EXPECT_THAT(statuses(rank_columns(R, {0, 1, 2}, 0, rule)),
              ElementsAre(Status::identified, Status::no_effect, Status::identified));
  rule.rows = kRows;  // the structural question knows no units
  EXPECT_THAT(statuses(rank_columns(R, {0, 1, 2}, 0, rule)),
              ElementsAre(Status::identified, Status::identified, Status::identified));
}

}  // namespace
}  // namespace selfcal
