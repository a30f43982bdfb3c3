// The answer: many small gains do not outvote one great loss, no row is excused by the model on
// trial, and angles are judged as lengths are.
#include "constraints/estimation/judgement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace selfcal {
namespace {

constexpr double kMicrometre = 1e-6;
constexpr double kMicroradian = 1e-6;

/// Rows of two sets, the second of which only judges. The nominal robot's noise is 100 um a set,
/// as its residuals are; the calibrated one's 30 um.
struct Rows {
  Rows() {
    data.sets.resize(2);
    nominal.aligned = calibrated.aligned = {0, 1};
    nominal.check_scale.assign(2, {100 * kMicrometre, 1000 * kMicroradian});
    calibrated.check_scale.assign(2, {30 * kMicrometre, 1000 * kMicroradian});
  }

  /// `count` rows of a set whose residual goes from `before` to `after` (m).
  void add(int set, int count, double before, double after) {
    for (int i = 0; i < count; ++i) {
      RowResidual row;
      row.row = static_cast<int>(nominal.check.size());
      row.set = set;
      data.rows.set.push_back(set);
      row.lengths = 1;
      row.length = before + i * kMicrometre / 100;  // no ties
      nominal.check.push_back(row);
      row.length = after + i * kMicrometre / 50;
      calibrated.check.push_back(row);
      nominal.check_places.emplace_back();
      calibrated.check_places.emplace_back();
    }
    data.rows.q.setZero(static_cast<Eigen::Index>(nominal.check.size()), 1);
  }

  /// Angles of the last `count` rows (rad).
  void turn(int count, double before, double after) {
    for (size_t i = nominal.check.size() - count; i < nominal.check.size(); ++i) {
      nominal.check[i].angle = before;
      calibrated.check[i].angle = after;
      nominal.check[i].angles = calibrated.check[i].angles = 3;
    }
  }

  Verdict judged(std::vector<std::string> contradictions = {}) const {
    Grounds grounds;
    grounds.workspace.rms = kMicrometre;
    grounds.workspace.poses = poses;
    grounds.target = 1e-3;
    grounds.converged = true;
    grounds.contradictions = std::move(contradictions);
    grounds.strays = strays;
    grounds.most_strays = 10e-3;
    return verdict(nominal, figures(), grounds);
  }
  Answer answer() const { return judged().answer; }

  Residuals figures() const {
    return residual_figures(data, nominal, calibrated, std::vector<char>(nominal.check.size(), 0));
  }

  DataSet data;
  Judged nominal, calibrated;
  int poses = kFewestPoses;  // of the workspace
  double strays = 0;         // m
};

TEST(Verdict, IsNotDeterminedWhereTheRobotHardlyReachesTheWorkspace) {
  Rows rows;
  rows.add(0, 60, 100 * kMicrometre, 30 * kMicrometre);
  EXPECT_EQ(rows.answer(), Answer::improved);
  rows.poses = 2;
  EXPECT_EQ(rows.answer(), Answer::not_determined);
  EXPECT_THAT(rows.judged().why, testing::HasSubstr("only 2 of the configurations tried reach"));
}

TEST(Verdict, SaysWhereTheRobotStraysMoreThanIsWanted) {
  Rows rows;
  rows.add(0, 60, 100 * kMicrometre, 30 * kMicrometre);
  EXPECT_THAT(rows.judged().why, testing::Not(testing::HasSubstr("strays")));
  rows.strays = 2e-3;
  EXPECT_EQ(rows.answer(), Answer::improved);
  EXPECT_THAT(rows.judged().why,
              testing::HasSubstr("the robot strays by 2 mm in each direction from any geometry, "
                                 "more than the 1 mm wanted"));
}

TEST(Verdict, IsNotDeterminedByRowsOfWhichMostIsNotTheRobots) {
  Rows rows;
  rows.nominal.check_scale[0].length = rows.calibrated.check_scale[0].length = 10e-3;
  rows.add(0, 60, 15e-3, 14e-3);
  EXPECT_EQ(rows.answer(), Answer::improved) << rows.judged().why;
  rows.strays = 25e-3;
  EXPECT_EQ(rows.answer(), Answer::not_determined);
  EXPECT_THAT(rows.judged().why, testing::HasSubstr("find the set or the rows that are wrong"));
}

TEST(Verdict, IsImprovedWhereTheRowsAreMetBetter) {
  Rows rows;
  rows.add(0, 60, 100 * kMicrometre, 30 * kMicrometre);
  rows.add(1, 10, 200 * kMicrometre, 150 * kMicrometre);
  EXPECT_EQ(rows.answer(), Answer::improved);
}

TEST(Verdict, IsNotImprovedWhereEveryRowIsBetterByNextToNothing) {
  Rows rows;
  rows.add(0, 60, 100 * kMicrometre, 99.5 * kMicrometre);
  EXPECT_EQ(rows.answer(), Answer::not_improved);
  EXPECT_THAT(rows.judged().why, testing::HasSubstr("by less than a hundredth"));
}

TEST(Verdict, IsNotDeterminedByRepeatsOfFewConfigurations) {
  Rows rows;
  rows.add(0, 60, 100 * kMicrometre, 30 * kMicrometre);
  rows.data.rows.repeat.resize(60);
  const auto answer_of = [&](int configurations) {
    for (int i = 0; i < 60; ++i) rows.data.rows.repeat[i] = i % configurations;
    EXPECT_EQ(rows.figures().check.configurations, configurations);
    return rows.answer();
  };
  EXPECT_EQ(answer_of(4), Answer::not_determined);  // four of four are better in one of sixteen
  EXPECT_THAT(rows.judged().why, testing::HasSubstr("no test of so few configurations"));
  EXPECT_EQ(answer_of(10), Answer::improved);
}

TEST(Verdict, IsNotImprovedWhereTheSquaresGrow) {
  Rows rows;
  rows.add(0, 60, 100 * kMicrometre, 90 * kMicrometre);
  rows.add(0, 5, 100 * kMicrometre, 3000 * kMicrometre);
  ASSERT_TRUE(rows.figures().check_rows.back().outlier);  // far, by the noise of the new model
  EXPECT_EQ(rows.answer(), Answer::not_improved);
}

TEST(Verdict, IsNotImprovedWhereFiveRowsInAHundredAreRuined) {
  Rows rows;
  rows.add(0, 95, 100 * kMicrometre, 30 * kMicrometre);
  rows.add(0, 5, 100 * kMicrometre, 3000 * kMicrometre);
  EXPECT_EQ(rows.answer(), Answer::not_improved);
}

TEST(Verdict, IsImprovedWhereFalseReadingsAreFarUnderBothModels) {
  Rows rows;  // the robot moved by 100 um: so do the false readings, to either side
  rows.add(0, 95, 100 * kMicrometre, 30 * kMicrometre);
  rows.add(0, 4, 8000 * kMicrometre, 8100 * kMicrometre);
  rows.add(0, 1, 8000 * kMicrometre, 7900 * kMicrometre);
  EXPECT_EQ(rows.answer(), Answer::improved);
}

TEST(Verdict, IsNotImprovedWhereRowsThatWereFarAreMadeMuchWorse) {
  Rows rows;
  rows.add(0, 95, 100 * kMicrometre, 30 * kMicrometre);
  rows.add(0, 5, 800 * kMicrometre, 8000 * kMicrometre);
  EXPECT_EQ(rows.answer(), Answer::not_improved);
}

TEST(Verdict, IsNotImprovedWhereASetThatOnlyJudgesIsMetWorse) {
  Rows rows;
  rows.add(0, 60, 500 * kMicrometre, 30 * kMicrometre);
  rows.add(1, 10, 200 * kMicrometre, 300 * kMicrometre);
  EXPECT_EQ(rows.answer(), Answer::not_improved);
}

TEST(Verdict, IsNotImprovedWhereTheAnglesAreMetWorse) {
  Rows rows;
  rows.add(0, 60, 100 * kMicrometre, 30 * kMicrometre);
  rows.turn(60, 500 * kMicroradian, 900 * kMicroradian);
  const Verdict verdict = rows.judged();
  EXPECT_EQ(verdict.answer, Answer::not_improved);
  EXPECT_THAT(verdict.why, testing::HasSubstr("angles are met worse"));
}

TEST(Verdict, AddsNoAnglesToLengths) {
  // Inclinometers beside a plane: noise of 500 urad is no length of 500 um.
  Rows rows;
  rows.add(0, 40, 100 * kMicrometre, 30 * kMicrometre);
  rows.add(1, 40, 0, 0);
  rows.turn(40, 500 * kMicroradian, 505 * kMicroradian);
  for (auto* model : {&rows.nominal, &rows.calibrated})
    for (std::size_t i = 40; i < 80; ++i) model->check[i].length = model->check[i].lengths = 0;
  const Figures check = rows.figures().check;
  EXPECT_EQ(check.rows, 80);
  EXPECT_EQ(check.configurations, 40);
  EXPECT_FALSE(check.angle_alone);
  EXPECT_NEAR(check.rms_before, 100 * kMicrometre, kMicrometre);
  EXPECT_NEAR(check.rms_after, 30 * kMicrometre, kMicrometre);
  EXPECT_EQ(check.angle.rows, 40);
  EXPECT_NEAR(check.angle.rms_before, 500 * kMicroradian, kMicroradian);
  EXPECT_EQ(rows.answer(), Answer::improved);
}

TEST(Verdict, IsImprovedWhereTheAnglesAreNoiseBeforeAndAfter) {
  Rows rows;
  rows.add(0, 60, 100 * kMicrometre, 30 * kMicrometre);
  rows.turn(60, 1000 * kMicroradian, 1040 * kMicroradian);  // squares grow by less than a tenth
  EXPECT_EQ(rows.answer(), Answer::improved);
}

TEST(Verdict, IsNotDeterminedWhereTheDataContradictThemselves) {
  Rows rows;
  rows.add(0, 60, 100 * kMicrometre, 30 * kMicrometre);
  const Verdict verdict = rows.judged({"the gauge says otherwise"});
  EXPECT_EQ(verdict.answer, Answer::not_determined);
  EXPECT_THAT(verdict.why, testing::HasSubstr("the gauge says otherwise"));
}

TEST(Figures, HaveTheAnglesOfTheRowsThatHaveAny) {
  Rows rows;
  rows.add(0, 10, 100 * kMicrometre, 30 * kMicrometre);
  rows.add(1, 4, 100 * kMicrometre, 30 * kMicrometre);
  rows.turn(4, 800 * kMicroradian, 200 * kMicroradian);
  const Residuals residual = rows.figures();
  EXPECT_EQ(residual.check.angle.rows, 4);
  EXPECT_DOUBLE_EQ(residual.check.angle.rms_before, 800 * kMicroradian);
  EXPECT_DOUBLE_EQ(residual.check.angle.rms_after, 200 * kMicroradian);
  ASSERT_EQ(residual.check_by_set.size(), 2u);
  EXPECT_EQ(residual.check_by_set[0].figures.angle.rows, 0);
  EXPECT_EQ(residual.check_by_set[1].figures.angle.rows, 4);
}

}  // namespace
}  // namespace selfcal
