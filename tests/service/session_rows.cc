// Touches of a session as rows of a data set.
#include <gmock/gmock.h>

#include "tests/service/stored_session.h"

namespace selfcal {
namespace {

using testing::ElementsAre;

TEST(RowsOf, HasTheGoodTouchesInTheOrderOfThePlanWithTheirRepeats) {
  const Config config = two_planes();
  Session session = session_of(4);
  session.touches = {
      touch_of(2, TouchOutcome::taken, 0.2), touch_of(0, TouchOutcome::outlier, 0.9),
      touch_of(0, TouchOutcome::taken, 0.1), touch_of(0, TouchOutcome::taken, 0.1),
      touch_of(1, TouchOutcome::taken, 0.3), touch_of(3, TouchOutcome::outlier, 0.9)};
  const DataSet data = rows_of(rx90(), session, decoding_of(config));
  ASSERT_EQ(data.rows.rows(), 4);
  constexpr double kHalfCount = kStep / 2;
  EXPECT_NEAR(data.rows.q(0, 0), 0.1, kHalfCount);
  EXPECT_NEAR(data.rows.q(2, 5), 0.3, kHalfCount);
  EXPECT_NEAR(data.rows.q(3, 0), 0.2, kHalfCount);
  EXPECT_THAT(data.rows.set, ElementsAre(0, 0, 1, 0));
  EXPECT_THAT(data.rows.repeat, ElementsAre(0, 0, -1, -1));
  EXPECT_THAT(data.rows.check, ElementsAre(0, 0, 1, 0));
  EXPECT_EQ(data.rows.normal.row(2).transpose(), Eigen::Vector3d::UnitZ());
  EXPECT_THAT(rows_of(rx90(), session, decoding_of(config), Parts::all_check).rows.check,
              ElementsAre(1, 1, 1, 1));
  EXPECT_THAT(rows_of(rx90(), session, decoding_of(config), Parts::all_fit).rows.check,
              ElementsAre(0, 0, 0, 0));
}

TEST(RowsOf, LeavesOutTouchesBeforeOneThatDiffers) {
  Session session = session_of(1);
  session.touches = {touch_of(0, TouchOutcome::taken, 0.1), touch_of(0, TouchOutcome::differs, 0.2),
                     touch_of(0, TouchOutcome::taken, 0.3)};
  const DataSet data = rows_of(rx90(), session, decoding_of(two_planes()));
  ASSERT_EQ(data.rows.rows(), 1);
  EXPECT_NEAR(data.rows.q(0, 0), 0.3, kStep / 2);
}

TEST(RowsOf, ReadsTheJointsAtTheContactNotAtTheDelayedEdge) {
  Session session = session_of(1);
  TouchRecord touch = touch_of(0);
  touch.before.counts.fill(1000);         // 0 rad, 10 ms before the edge
  touch.after.counts.fill(1000 + 20000);  // 0.02 rad, 10 ms after it: 1 rad/s
  session.touches = {touch};
  const DataSet data = rows_of(rx90(), session, decoding_of(two_planes()));
  EXPECT_NEAR(data.rows.q(0, 3), 0.009, 1e-15) << "1 ms before the edge";  // rounding
}

TEST(RowsOf, WeighsATouchByWhatItsReadingLeavesOpen) {
  Session session = session_of(2);
  TouchRecord moving = touch_of(0), standing = touch_of(0);
  moving.edge += kMillisecond;  // in the middle of 20 ms, the trigger's delay off
  // The table's normal is z: 20 ms at 0.1 rad/s of the second joint, whose arm to the tip is level.
  moving.before.counts[1] = standing.before.counts[1] - 1000;
  moving.after.counts[1] = standing.after.counts[1] + 1000;
  moving.temperature = 31;
  moving.unix_ms = standing.unix_ms + 50'000;  // the wall clock stepped: the edges did not
  session.touches = {standing, moving};
  const DataSet data = rows_of(rx90(), session, decoding_of(two_planes()));
  ASSERT_EQ(data.rows.rows(), 2);
  EXPECT_EQ(data.rows.factor(0), 1);
  const Eigen::VectorXd q = data.rows.q.row(1).transpose();
  const Eigen::VectorXd dq = data.rows.velocity.row(1).transpose();
  EXPECT_NEAR(dq[1], 0.1, 1e-12);
  const double speed =
      (endpoint(rx90(), q + 1e-4 * dq) - endpoint(rx90(), q - 1e-4 * dq)).z() / 2e-4;
  EXPECT_GT(std::abs(speed), 0.01) << "else nothing was shown";
  // Uniform within v T / 4, T = 20 ms, over 20 um of the set.
  const double open = speed * 0.02 / 4 / std::sqrt(3);
  EXPECT_NEAR(data.rows.factor(1), std::hypot(1, open / 2e-5), 1e-4 * data.rows.factor(1));
  EXPECT_EQ(data.rows.temperature[1], 31);
  EXPECT_EQ(data.rows.time[1], 1e-3);
}

TEST(RowsOf, TakeTheWallClockForTheTimeThatTheComputerWasOff) {
  Session session = session_of(2);
  TouchRecord before = touch_of(0), after = touch_of(0);
  after.edge = before.edge - kMillisecond;
  after.unix_ms = before.unix_ms + 2500;
  session.touches = {before, after};
  EXPECT_EQ(rows_of(rx90(), session, decoding_of(two_planes())).rows.time[1], 2.5);
}

/// How far apart two touches are (s) with these edges (s) and so much between them on the wall.
double apart(double before, double after, double wall) {
  Session session = session_of(2);
  session.touches = {touch_of(0), touch_of(0)};
  for (TouchRecord& touch : session.touches) {
    const bool first = &touch == &session.touches.front();
    const Nanoseconds shift = nanoseconds(first ? before : after) - touch.edge;
    for (Nanoseconds* time : {&touch.edge, &touch.before.time, &touch.after.time}) *time += shift;
    if (!first) touch.unix_ms += std::llround(1000 * wall);
  }
  return rows_of(rx90(), session, decoding_of(two_planes())).rows.time[1];
}

TEST(RowsOf, NoticeThatTheComputerWasOffThoughItsClockIsPastTheEdgeBefore) {
  EXPECT_NEAR(apart(300, 320, 36'000), 36'000, 1e-3) << "ten hours off";
  EXPECT_NEAR(apart(300, 320, 20), 20, 1e-3);
  EXPECT_NEAR(apart(300, 320, 70), 20, 1e-3) << "less than a minute more";
  EXPECT_NEAR(apart(7200, 7220, 3600), 20, 1e-3) << "up for longer: the wall clock stepped";
  EXPECT_NEAR(apart(300, 320, -3600), 20, 1e-3);
}

TEST(RowsOf, MakesNoRowsOfNoTouches) {
  EXPECT_EQ(rows_of(rx90(), session_of(3), decoding_of(two_planes())).rows.rows(), 0);
}

TEST(Joined, PutsTheNewTouchesAsJudgesBehindTheFitRows) {
  const Decoding decoding = decoding_of(two_planes());
  Session base = session_of(4), check = session_of(2);
  for (int i = 0; i < 4; ++i) base.touches.push_back(touch_of(i, TouchOutcome::taken, 0.1 * i));
  for (int i = 0; i < 2; ++i) check.touches.push_back(touch_of(i, TouchOutcome::taken, 0.7));
  const DataSet data =
      joined(rows_of(rx90(), base, decoding), rows_of(rx90(), check, decoding, Parts::all_check));
  ASSERT_EQ(data.rows.rows(), 5) << "three fit rows and two new ones";
  EXPECT_THAT(data.rows.check, ElementsAre(0, 0, 0, 1, 1));
  EXPECT_THAT(data.rows.set, ElementsAre(0, 0, 1, 0, 1));
  EXPECT_NEAR(data.rows.q(1, 0), 0.2, kStep / 2);
  EXPECT_NEAR(data.rows.q(4, 0), 0.7, kStep / 2);
  EXPECT_EQ(data.rows.normal.row(4).transpose(), Eigen::Vector3d::UnitZ());
}

TEST(Joined, KeepsAColumnThatOnlyOneOfThemHas) {
  const Decoding decoding = decoding_of(two_planes());
  Session session = session_of(2);
  for (StepRecord& step : session.plan) step.check = false;
  session.touches = {touch_of(0), touch_of(1)};
  DataSet base = rows_of(rx90(), session, decoding);
  base.rows.wrench = Eigen::MatrixXd::Constant(2, 6, 3.5);
  const DataSet data = joined(base, rows_of(rx90(), session, decoding, Parts::all_check));
  ASSERT_EQ(data.rows.wrench.rows(), 4);
  EXPECT_EQ(data.rows.wrench(1, 5), 3.5);
  EXPECT_TRUE(std::isnan(data.rows.wrench(2, 0)));
}

TEST(Joined, MeansTheSameSocketByTheSameName) {
  Decoding decoding = decoding_of(two_planes());
  Session base = session_of(2), check = session_of(2);
  base.plan[0].group = check.plan[1].group = "g1";
  base.plan[1].group = check.plan[0].group = "g0";
  for (Session* each : {&base, &check}) {
    for (StepRecord& step : each->plan) step.set = "near", step.check = false;
    each->touches = {touch_of(0), touch_of(1)};
  }
  const DataSet data =
      joined(rows_of(rx90(), base, decoding), rows_of(rx90(), check, decoding, Parts::all_check));
  std::vector<std::string> names;
  for (const int group : data.rows.group) names.push_back(data.sets[0].groups[group]);
  EXPECT_THAT(names, ElementsAre("g1", "g0", "g0", "g1"));
}

}  // namespace
}  // namespace selfcal
