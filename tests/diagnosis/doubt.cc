// Rows and files that nothing may be named from, and those that look like them.
#include "diagnosis/report/doubt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "constraints/estimation/identification.h"
#include "diagnosis/constants.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/report/given_wrongly.h"
#include "kinematics/corrected_robot.h"
#include "tests/diagnosis/two_sessions.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

/// Position rows of a calibrated robot, some of them repeated at once.
struct Rows {
  explicit Rows(int repeats = 1) {
    const TwoSessions sessions;
    robot = sessions.robot;
    data = sessions.before;
    std::vector<int> list;
    for (int row = 0; row < data.rows.rows(); ++row) list.insert(list.end(), repeats, row);
    data.rows = taken(data.rows, list);
    data.rows.repeat = list;
  }

  void disturb(double sigma) {
    Random random(11);
    std::normal_distribution<double> normal(0, sigma);
    for (double& each : data.rows.position.reshaped()) each += normal(random);
  }

  std::shared_ptr<const Robot> robot;
  DataSet data;
};

TEST(Doubt, NamesNothingWhereOneJointIsReadWithTheOtherSign) {
  Rows rows;
  rows.data.rows.q.col(3) *= -1;
  const Diagnosis diagnosis = diagnose(rows.robot, rows.data, quick());
  EXPECT_EQ(diagnosis.verdict.effect, kUnknown);
  EXPECT_GT(diagnosis.verdict.probability, 0.9);
  EXPECT_TRUE(diagnosis.named.empty());
  EXPECT_THAT(diagnosis.why, HasSubstr("look at the rows and files first"));
}

TEST(Doubt, NamesTheJointWhoseGearRatioIsNotTheFiles) {
  Rows rows;
  rows.data.rows.q.col(1) *= 1.005;
  const Diagnosis diagnosis = diagnose(rows.robot, rows.data, quick());
  EXPECT_TRUE(diagnosis.named.empty());
  EXPECT_THAT(diagnosis.why, HasSubstr("with the gear ratio of j2 -0.5 % off"));
}

TEST(Doubt, DoesNotCallNoiseWhatIsFarBeyondTheDataSheetsNoise) {
  Rows rows;
  rows.disturb(50 * kTrackerNoise);
  const Diagnosis diagnosis = diagnose(rows.robot, rows.data, quick());
  EXPECT_EQ(diagnosis.verdict.effect, kUnknown);
  EXPECT_THAT(diagnosis.why, HasSubstr("state a noise of 0.02 mm"));
}

/// What is doubted where every third of 60 rows is kept aside and `moved` of them err by `by` more
/// (m), all along one direction, of which `told` are said to be false readings.
std::string doubt_of_rows_kept_aside(int moved, double by, int told = 0) {
  Rows rows;
  std::vector<Outlier> outliers;
  for (int row = 0, kept = 0; row < rows.data.rows.rows(); row += 3, ++kept) {
    rows.data.rows.check[static_cast<std::size_t>(row)] = 1;
    if (kept < moved) rows.data.rows.position(row, 2) += by;
    if (kept < told) outliers.push_back({row + 1, "tracker", by, true, "far"});
  }
  const LinearisedModel linearised(rows.robot, rows.data, quick(), {});
  Diagnosis diagnosis;
  diagnosis.verdict.effect = kNone;
  diagnosis.noise = kTrackerNoise;
  diagnosis.outliers = outliers;
  return doubt_of(linearised, rows.data, identify(linearised.geometry(), rows.data), diagnosis);
}

TEST(Doubt, DoesNotCallNoiseWhatRowsKeptAsideAreFarBeyond) {
  EXPECT_THAT(doubt_of_rows_kept_aside(20, 10 * kTrackerNoise), HasSubstr("times what noise"));
  // The 40 others leave the geometry in doubt, too: three sigma of noise are within that.
  EXPECT_EQ(doubt_of_rows_kept_aside(20, 0), "");
  EXPECT_EQ(doubt_of_rows_kept_aside(5, 3 * kTrackerNoise), "");
}

TEST(Doubt, LeavesOutAFewRowsKeptAsideThatAreFalseAndNoMore) {
  EXPECT_EQ(doubt_of_rows_kept_aside(3, 1000 * kTrackerNoise), "");
  EXPECT_EQ(doubt_of_rows_kept_aside(3, 1000 * kTrackerNoise, 3), "");
  EXPECT_THAT(doubt_of_rows_kept_aside(20, 1000 * kTrackerNoise, 20),
              HasSubstr("times what noise"));
}

TEST(Doubt, NamesNothingThatHardlyClosesWhatSoMuchNoiseLeaves) {
  Rows rows;
  rows.disturb(50 * kTrackerNoise);
  const DiagnosisOptions options = quick();
  const LinearisedModel linearised(rows.robot, rows.data, options, {});
  Diagnosis diagnosis;
  diagnosis.verdict.effect = "joint_compliance";
  diagnosis.named = {{.effect = "joint_compliance", .where = {"j2"}}};
  diagnosis.gap.rms_before = 1e-3;
  diagnosis.gap.rms_after = 0.9e-3;
  EXPECT_THAT(
      doubt_of(linearised, rows.data, identify(linearised.geometry(), rows.data), diagnosis),
      HasSubstr("state a noise of 0.02 mm"));
  diagnosis.gap.rms_after = 0.5e-3;
  EXPECT_EQ(doubt_of(linearised, rows.data, identify(linearised.geometry(), rows.data), diagnosis),
            "");
}

TEST(Doubt, BelievesTheRepeatsWhereTheySayThatTheNoiseIsSo) {
  Rows rows(2);
  rows.disturb(50 * kTrackerNoise);
  const Diagnosis diagnosis = diagnose(rows.robot, rows.data, quick());
  EXPECT_EQ(diagnosis.verdict.effect, kNone) << diagnosis.why;
}

TEST(Doubt, NamesNothingWhereTheInstrumentWasMoved) {
  Rows rows;
  for (int row = 35; row < rows.data.rows.rows(); ++row)
    rows.data.rows.position.row(row) += Eigen::RowVector3d(0.003, -0.002, 0.001);
  const Diagnosis diagnosis = diagnose(rows.robot, rows.data, quick());
  EXPECT_EQ(diagnosis.verdict.effect, kUnknown);
  EXPECT_TRUE(diagnosis.named.empty());
  EXPECT_THAT(diagnosis.why, HasSubstr("between rows 35 and 36 the instrument of set tracker"));
}

/// A drift of the base that settles, most of it while nothing is measured: rows 0 to 29 and 30 on.
TEST(Doubt, TellsADriftThatSettlesBetweenTwoPassesFromAMove) {
  Rows rows;
  Observations& o = rows.data.rows;
  o.time.resize(o.rows());
  for (int row = 0; row < o.rows(); ++row) {
    o.time[row] = 20.0 * row + (row < 30 ? 0 : 2000);
    const double settled = 1 - std::exp(-o.time[row] / 900);
    o.position.row(row) += settled * Eigen::RowVector3d(4e-4, -3e-4, 1e-4);
  }
  const Diagnosis diagnosis = diagnose(rows.robot, rows.data, quick());
  EXPECT_EQ(diagnosis.verdict.effect, "base_drift") << diagnosis.why;
}

/// What is doubted of rows of which `cause` is named.
std::string doubt_of_named(const CauseResult& cause) {
  const Rows rows;
  const LinearisedModel linearised(rows.robot, rows.data, quick(), {});
  Diagnosis diagnosis;
  diagnosis.verdict.effect = cause.effect;
  diagnosis.named = {cause};
  diagnosis.gap.rms_before = 1e-4;
  diagnosis.gap.rms_after = 0.5e-4;
  return doubt_of(linearised, rows.data, identify(linearised.geometry(), rows.data), diagnosis);
}

/// Where a fixture is said to have moved by `shift` (m).
std::string doubt_of_fixture(double shift) {
  return doubt_of_named({.effect = "fixture_shift",
                         .where = {"side"},
                         .parameters = {{.name = "side.shift",
                                         .unit = "m",
                                         .value = shift,
                                         .sigma = 1e-4,
                                         .usual_least = 1e-5,
                                         .usual_most = 2e-4}}});
}

TEST(Doubt, KnowsAnotherSurfaceFromOneThatMoved) {
  EXPECT_EQ(doubt_of_fixture(5e-3), "");
  EXPECT_THAT(doubt_of_fixture(-0.2), HasSubstr("some touches of side are of another surface"));
}

TEST(Doubt, TakesAStepAtTheFirstRowsOfASetForItsPlaceInTheFile) {
  Rows rows;
  const LinearisedModel linearised(rows.robot, rows.data, quick(), {});
  const int count = rows.data.rows.rows();
  rows.data.rows.time = Eigen::VectorXd::LinSpaced(count, 0, count - 1);
  const auto doubt = [&](double from) {
    Diagnosis diagnosis;
    diagnosis.verdict.effect = "fixture_shift";
    diagnosis.named = {{.effect = "fixture_shift",
                        .where = {rows.data.sets.front().name},
                        .between = std::pair(from, from + 1)}};
    diagnosis.gap.rms_before = 1e-4;
    diagnosis.gap.rms_after = 0.5e-4;
    return doubt_of(linearised, rows.data, identify(linearised.geometry(), rows.data), diagnosis);
  };
  EXPECT_THAT(doubt(0), HasSubstr("lie elsewhere than its set says"));
  EXPECT_EQ(doubt(10), "");
}

/// Where joint j2 is said to give way by `compliance`, to `sigma`.
std::string doubt_of_spring(double compliance, double sigma) {
  return doubt_of_named({.effect = "joint_compliance",
                         .where = {"j2"},
                         .parameters = {{.name = "j2.c",
                                         .unit = "rad/(N m)",
                                         .value = compliance,
                                         .sigma = sigma,
                                         .usual_least = 2e-7,
                                         .usual_most = 1e-4,
                                         .positive = true}}});
}

TEST(Doubt, TakesAWaveThatIsNearlyALineForTheUnitOfALegsReading) {
  const auto hexapod = load_robot(SELFCAL_SOURCE_DIR "/app/examples/stewart.robot.yaml");
  ASSERT_TRUE(hexapod.has_value());
  const std::string leg = (*hexapod)->joints()[4].name;
  Eigen::MatrixXd q = Eigen::MatrixXd::Constant(30, 6, 0.9);
  q.col(4).setLinSpaced(0.45, 0.55);  // sin(2 pi q) falls as a line there
  const auto doubt = [&](double waves, const Robot& robot, const std::string& at) {
    return reading_scaled_wrongly(
        robot, q,
        {{.effect = "transmission_error",
          .where = {at},
          .parameters = {{.name = at + ".sin" + std::to_string(static_cast<int>(waves)),
                          .unit = "m",
                          .value = 1e-3}}}});
  };
  EXPECT_THAT(doubt(1, **hexapod, leg),
              HasSubstr("at " + leg + " grows with its reading, by -0.6"));
  EXPECT_EQ(doubt(20, **hexapod, leg), "") << "waves of 5 cm";
  const Rows arm;
  EXPECT_EQ(doubt(1, *arm.robot, "j5"), "") << "whose ratio is free";
}

TEST(Doubt, NamesNoSpringThatPushesBack) {
  EXPECT_THAT(doubt_of_spring(-4e-6, 1e-6), HasSubstr("no machine has j2.c below"));
  EXPECT_EQ(doubt_of_spring(-4e-6, 2e-6), "") << "noise may make it of nothing";
}

TEST(Doubt, NamesNoSpringThatIsStifferThanAnyMachine) {
  EXPECT_THAT(doubt_of_spring(1.2e-8, 1e-10), HasSubstr("no machine is so stiff as j2.c"));
  EXPECT_EQ(doubt_of_spring(3e-8, 1e-10), "");
}

TEST(LeaveOutImpossible, LeavesWhatElseIsNamed) {
  const CauseResult play{.effect = "joint_clearance", .where = {"leg3"}};
  const auto spring = [](double value) {
    return CauseResult{.effect = "leg_compliance",
                       .where = {"leg3"},
                       .parameters = {{"leg3.c", "m/N", value, 1e-7, 1e-8, 5e-6, true}}};
  };
  std::vector<CauseResult> named{play, spring(-1e-6)};
  EXPECT_THAT(leave_out_impossible(named, play),
              HasSubstr("leg_compliance is not named: no machine has leg3.c below zero"));
  ASSERT_EQ(named.size(), 1U);
  EXPECT_EQ(named.front().effect, "joint_clearance");
  // What may be noise stays; so does a verdict that is one itself, which is withdrawn whole.
  named = {play, spring(-1e-7)};
  EXPECT_EQ(leave_out_impossible(named, play), "");
  EXPECT_EQ(named.size(), 2U);
  named = {spring(-1e-6), play};
  EXPECT_EQ(leave_out_impossible(named, named.front()), "");
  EXPECT_EQ(named.size(), 2U);
}

TEST(Withdraw, LeavesNothingNamedAndNothingClosedByIt) {
  Diagnosis diagnosis;
  diagnosis.named = {{.effect = "backlash", .where = {"j1"}}};
  diagnosis.found = {{.what = {"backlash", "j1", {}}, .values = {{"play", 1e-4}}, .named = true}};
  Problems problems;
  diagnosis.model = correct(Rows().robot, entries_of(diagnosis.found), {}, problems);
  ASSERT_FALSE(problems.any()) << problems.list.front();
  for (int row = 0; row < 10; ++row)
    diagnosis.validation_rows.push_back(
        {.before = 100, .after = 10, .all = 10, .floor = 1, .block = row});
  diagnosis.gap = gap_of(diagnosis.validation_rows, 1);
  withdraw("the instrument was moved", quick(), diagnosis);
  EXPECT_TRUE(diagnosis.named.empty());
  EXPECT_FALSE(diagnosis.found.front().named);
  EXPECT_EQ(effect_entries(*diagnosis.model).front().find("named")->text, "false");
  EXPECT_EQ(diagnosis.gap.rms_after, diagnosis.gap.rms_before);
  EXPECT_EQ(diagnosis.gap.max_after, diagnosis.gap.max_before);
  EXPECT_EQ(diagnosis.gap.closed.fraction, 0);
  // What is found closes what it closes.
  EXPECT_LT(diagnosis.gap.rms_all, diagnosis.gap.rms_before);
  EXPECT_GT(diagnosis.gap.closed_all.fraction, 0.5);
  EXPECT_EQ(diagnosis.verdict.effect, kUnknown);
  EXPECT_EQ(diagnosis.verdict.probability, kDiagnosis.report.withdrawn);
}

TEST(Withdraw, IsLessSureWhereWhatIsNamedOnlyClosesNothing) {
  Diagnosis diagnosis;
  diagnosis.named = {{.effect = "backlash", .where = {"j1"}}};
  diagnosis.model = Rows().robot;
  for (int row = 0; row < 30; ++row)
    diagnosis.validation_rows.push_back(
        {.before = 100, .after = 101, .all = 101, .floor = 1, .block = row});
  diagnosis.gap = gap_of(diagnosis.validation_rows, 1);
  ASSERT_NE(closes_nothing(diagnosis), "");
  withdraw(closes_nothing(diagnosis), quick(), diagnosis);
  EXPECT_EQ(diagnosis.verdict.effect, kUnknown);
  EXPECT_EQ(diagnosis.verdict.probability, kDiagnosis.report.withdrawn_idle);
}

}  // namespace
}  // namespace selfcal
