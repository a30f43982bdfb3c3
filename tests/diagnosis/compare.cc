// What changed between two sessions of one robot.
#include "diagnosis/comparison/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/diagnosis/two_sessions.h"

namespace selfcal {
namespace {

using testing::ElementsAre;
using testing::IsSupersetOf;
using testing::UnorderedElementsAre;

constexpr double kShift = 1e-3;  // rad: 0.5 mm at half a metre, 25 times the noise

void expect_zero_of_j3(const Comparison& comparison) {
  ASSERT_FALSE(comparison.changes.empty()) << comparison.why;
  const Change& change = comparison.changes.front();
  EXPECT_EQ(change.effect, "zero_shift");
  EXPECT_EQ(change.where, "j3");
  EXPECT_GT(change.probability, 0.95);
  ASSERT_EQ(change.values.size(), 1U);
  // The reading says more, so that the zero is less.
  EXPECT_NEAR(change.values[0].value, -kShift, 4 * change.values[0].sigma);
  EXPECT_LT(comparison.none, 0.01);
  EXPECT_LE(comparison.unknown, 1);
}

TEST(Compare, NamesTheJointWhoseZeroShifted) {
  TwoSessions sessions;
  sessions.after.rows.q.col(2).array() += kShift;
  expect_zero_of_j3(compare(sessions.robot, sessions.before, sessions.after));
}

TEST(Compare, IsNotMisledByATimeThatOneOfThemLacks) {
  TwoSessions sessions;
  const int rows = sessions.before.rows.rows();
  sessions.before.rows.time = Eigen::VectorXd::LinSpaced(rows, 0, rows);
  sessions.after.rows.q.col(2).array() += kShift;
  expect_zero_of_j3(compare(sessions.robot, sessions.before, sessions.after));
}

TEST(Compare, TakesEachSessionsTimeForItsOwn) {
  TwoSessions sessions;
  const int rows = sessions.before.rows.rows();
  sessions.before.rows.time = sessions.after.rows.time = Eigen::VectorXd::LinSpaced(rows, 0, rows);
  sessions.after.rows.q.col(2).array() += kShift;
  expect_zero_of_j3(compare(sessions.robot, sessions.before, sessions.after));
}

TEST(Compare, SaysThatNothingChangedWhereNothingDid) {
  const TwoSessions sessions;
  const Comparison comparison = compare(sessions.robot, sessions.before, sessions.after);
  EXPECT_GT(comparison.none, 0.5) << comparison.why;
}

TEST(Compare, DoesNotTakeForAChangeWhatBothShow) {
  TwoSessions sessions(100);
  for (DataSet* each : {&sessions.before, &sessions.after}) {
    auto q2 = each->rows.q.col(1);
    q2.array() += 3e-4 * (3 * q2.array()).sin();
  }
  const Comparison comparison = compare(sessions.robot, sessions.before, sessions.after);
  EXPECT_GT(comparison.none, 0.5) << comparison.why;
  EXPECT_GT(comparison.unknown, 0.5);
}

TEST(Compare, SaysWhereMoreChangedThanParametersStandFor) {
  TwoSessions sessions;
  Eigen::MatrixXd& q = sessions.after.rows.q;
  q.col(2).array() += kShift;
  q.col(1).array() += 1e-3 * (3 * q.col(1).array()).sin() * q.col(2).array().cos();
  const Comparison comparison =
      compare(sessions.robot, sessions.before, sessions.after, Between::sessions, quick());
  EXPECT_GT(comparison.unknown, 0.9);
  EXPECT_THAT(comparison.why,
              testing::StartsWith("something changed that no known change explains"));
}

TEST(Compare, ListsMoreChangesThanAreSearchedTogether) {
  TwoSessions sessions(100);
  const std::vector<double> shifts = {0, 1e-3, -7e-4, 5e-4, -9e-4, 0};
  for (int j = 0; j < 6; ++j) sessions.after.rows.q.col(j).array() += shifts[j];
  const Comparison comparison = compare(sessions.robot, sessions.before, sessions.after);
  std::vector<std::string> where;
  for (const Change& each : comparison.changes) {
    EXPECT_EQ(each.effect, "zero_shift");
    EXPECT_GT(each.probability, 0.9);
    where.push_back(each.where);
    EXPECT_NEAR(each.values[0].value, -shifts[each.where[1] - '1'], 4 * each.values[0].sigma);
  }
  std::ranges::sort(where);
  EXPECT_EQ(where, (std::vector<std::string>{"j2", "j3", "j4", "j5"})) << comparison.why;
}

TEST(Compare, PutsFalseRowsAsideButNotTheChange) {
  TwoSessions sessions;
  sessions.after.rows.q.col(2).array() += kShift;
  for (const int row : {4, 20}) sessions.after.rows.position(row, 2) += 2e-3;
  sessions.before.rows.position(9, 0) -= 1e-3;
  const Comparison comparison = compare(sessions.robot, sessions.before, sessions.after);
  expect_zero_of_j3(comparison);
  EXPECT_LT(comparison.unknown, 0.5);
}

// 2400 equations: weighed as they are they would take gigabytes and minutes.
TEST(Compare, WeighsOnlyAPartOfLargeSessions) {
  TwoSessions sessions(600);
  sessions.after.rows.q.col(2).array() += kShift;
  std::string stages;
  const Comparison comparison =
      compare(sessions.robot, sessions.before, sessions.after, Between::sessions, {},
              [&](std::string_view stage, double) { stages += std::string(stage) + "\n"; });
  expect_zero_of_j3(comparison);
  EXPECT_NE(stages.find("weighing what changed"), std::string::npos) << stages;
}

/// What an instrument reads that has been turned about the vertical by `angle` (rad) and moved by
/// `by` (m).
void stand_elsewhere(DataSet& session, double angle, const Eigen::Vector3d& by) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Eigen::MatrixXd& p = session.rows.position;
  p = ((p * R.transpose()).rowwise() + by.transpose()).eval();
}

std::vector<std::string> surely(const Comparison& comparison) {
  std::vector<std::string> list;
  for (const Change& each : comparison.changes)
    if (each.probability > 0.5) list.push_back(each.effect + "@" + each.where);
  return list;
}

TEST(Compare, SeesAZeroThatShiftedUnderATrackerThatStandsElsewhere) {
  TwoSessions sessions;
  sessions.after.rows.q.col(2).array() += kShift;
  stand_elsewhere(sessions.after, 3, {5, -2, 0.3});
  EXPECT_THAT(surely(compare(sessions.robot, sessions.before, sessions.after)),
              UnorderedElementsAre("fixture_shift@tracker", "zero_shift@j3"));
}

TEST(Compare, SaysOfATrackerThatWasPushedThatItAndNothingElseMoved) {
  TwoSessions sessions;
  stand_elsewhere(sessions.after, 2e-3, {3e-3, -1e-3, 2e-3});
  const Comparison comparison = compare(sessions.robot, sessions.before, sessions.after);
  EXPECT_THAT(surely(comparison), ElementsAre("fixture_shift@tracker"));
  EXPECT_LT(comparison.none, 0.01);
  std::vector<std::string> values;
  for (const NamedValue& each : comparison.changes.front().values)
    values.push_back(each.name + " " + each.unit);
  EXPECT_THAT(values, IsSupersetOf({"shift1 m", "shift3 m", "turn1 rad", "turn3 rad"}));
}

TEST(Incomparable, IsADataSetWithoutRowsToFit) {
  TwoSessions sessions;
  EXPECT_EQ(incomparable(sessions.before), "");
  sessions.before.rows.check.assign(sessions.before.rows.check.size(), 1);
  EXPECT_THAT(incomparable(sessions.before), testing::HasSubstr("has 0 equations"));
}

TEST(Incomparable, AreDataSetsOfDifferentRobots) {
  const TwoSessions sessions;
  const auto other = load_robot(SELFCAL_SOURCE_DIR "/app/examples/irb1600.robot.yaml");
  ASSERT_TRUE(other);
  EXPECT_EQ(incomparable(*sessions.robot, *sessions.robot), "");
  EXPECT_NE(incomparable(**other, *sessions.robot).find("only data sets of one robot"),
            std::string::npos);
}

}  // namespace
}  // namespace selfcal
