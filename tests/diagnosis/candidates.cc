#include "diagnosis/evidence/candidates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/constants.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

/// An arm of one joint, without masses; rows of one surface, a second apart.
struct Session {
  explicit Session(int rows) {
    data.rows.q = Eigen::MatrixXd::Zero(rows, 1);
    data.rows.set.assign(static_cast<size_t>(rows), 0);
    data.rows.time = Eigen::VectorXd::LinSpaced(rows, 0, rows - 1);
    context.begin = 0;
    context.end = rows - 1;
  }
  Candidates candidates() const { return selfcal::candidates(*robot, data, context); }
  std::shared_ptr<const Robot> robot{
      robot_of("robot: arm\nkind: serial\nframes:\n"
               "  - {name: j1, joint: revolute}\n  - {name: tool, joint: fixed, d: 1}\n")};
  DataSet data;
  MeasurementContext context;
};

TEST(Candidates, HaveAMomentBetweenAnyTwoOfFewRowsAndSpreadOverMany) {
  const auto moments = [](int rows) {
    std::vector<double> list;
    for (const Candidate& each : Session(rows).candidates().list)
      if (each.effect == "zero_shift") list.push_back(each.shape.moment.value());
    return list;
  };
  EXPECT_EQ(moments(9), (std::vector<double>{0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5}));
  EXPECT_TRUE(moments(7).empty());
  const std::vector<double> many = moments(400);
  ASSERT_EQ(many.size(), 24);
  EXPECT_NEAR(many.front(), 16, 1);
  EXPECT_NEAR(many.back(), 384, 1);
}

// 400 rows a second apart, and pauses of a minute or more behind five of them: the four longest.
TEST(Candidates, HaveAMomentInTheLongestPauses) {
  Session session(400);
  double pause = 60, later = 0;
  for (int row = 0; row < 400; ++row) {
    if (row == 58 || row == 101 || row == 207 || row == 290 || row == 333) later += pause += 20;
    session.data.rows.time[row] += later;
  }
  const Eigen::VectorXd& t = session.data.rows.time;
  std::vector<double> moments;
  for (const Candidate& each : session.candidates().list)
    if (each.effect == "zero_shift") moments.push_back(each.shape.moment.value());
  for (const int row : {101, 207, 290, 333})
    EXPECT_EQ(std::ranges::count(moments, (t[row - 1] + t[row]) / 2), 1) << row;
  EXPECT_EQ(std::ranges::count(moments, (t[57] + t[58]) / 2), 0) << "the shortest";
}

TEST(Candidates, HaveTheFineWavesThatRowsHintAtEachAsOneOfMany) {
  const Session session(50);
  const Candidates all =
      candidates(*session.robot, session.data, session.context, {.fine_waves = {{109, 160}}});
  const auto of = [&](double waves) {
    return std::ranges::find_if(all.list, [&](const Candidate& each) {
      return each.effect == "transmission_error" && each.shape.waves == std::vector{waves};
    });
  };
  ASSERT_NE(of(109), all.list.end());
  EXPECT_NEAR(of(109)->log_prior - of(1)->log_prior, std::log(kDiagnosis.shapes.fine_share), 1e-12);
  EXPECT_EQ(of(160)->log_prior, of(1)->log_prior) << "a generator's, that is tried anyway";
  EXPECT_EQ(std::ranges::count(session.candidates().list, std::vector{109.0},
                               [](const Candidate& each) { return each.shape.waves; }),
            0);
}

/// Moments of the zero shifts, and between which rows they lie; all candidates sum to one.
void expect_likely_moments(int rows, double likely, const std::vector<double>& near) {
  const Session session(rows);
  const Candidates all =
      candidates(*session.robot, session.data, session.context,
                 {.steps = {{.effect = "zero_shift", .at = "j1", .shape = {.moment = likely}}}});
  std::vector<double> more;
  double sum = 0;
  const std::vector<Candidate> before = session.candidates().list;
  for (const Candidate& each : all.list) {
    if (each.effect != "zero_shift") continue;
    sum += std::exp(each.log_prior);
    const double moment = each.shape.moment.value();
    ASSERT_TRUE(each.between.has_value());
    EXPECT_EQ(each.between->first, moment - 0.5);
    EXPECT_EQ(each.between->second, moment + 0.5);
    if (std::ranges::none_of(before, [&](const Candidate& one) {
          return one.effect == each.effect && one.shape == each.shape;
        }))
      more.push_back(moment);
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_EQ(more, near);
}

TEST(Candidates, HaveEveryMomentBetweenThoseNextToALikelyOne) {
  // Of 100 rows: 3.5, 7.5, 11.5, 15.5 ...
  expect_likely_moments(100, 7.5, {4.5, 5.5, 6.5, 8.5, 9.5, 10.5});
  expect_likely_moments(100, 3.5, {0.5, 1.5, 2.5, 4.5, 5.5, 6.5});
  expect_likely_moments(100, 95.5, {92.5, 93.5, 94.5, 96.5, 97.5, 98.5});
  expect_likely_moments(100, 8.5, {});  // was not tried
  expect_likely_moments(20, 7.5, {});   // each is tried already
}

TEST(Candidates, ShareTheProbabilityOfTheirFamilyAmongPlacesThenShapes) {
  const Candidates all = Session(50).candidates();
  std::map<std::string, double> sum;
  for (const Candidate& each : all.list) sum[each.effect] += std::exp(each.log_prior);
  EXPECT_GE(sum.size(), 4);
  for (const auto& [effect, probability] : sum) EXPECT_NEAR(probability, 1, 1e-12) << effect;
}

TEST(Candidates, HaveFiguresToTellOfARobotWhoseLastJointSlides) {
  Session session(50);
  session.robot = robot_of(
      "robot: gantry\nkind: serial\nmass: 80\nframes:\n"
      "  - {name: x, joint: prismatic, alpha: 1.5707963267948966, limits: [0, 2]}\n"
      "  - {name: y, joint: prismatic, alpha: 1.5707963267948966, theta: 1.5707963267948966,"
      " limits: [0, 1]}\n"
      "  - {name: z, joint: prismatic, alpha: 1.5707963267948966, limits: [0, 0.5]}\n"
      "  - {name: tool, joint: fixed, r: 0.1}\n");
  session.data.rows.q = Eigen::MatrixXd::Zero(50, 3);
  const Candidates all = session.candidates();
  EXPECT_GT(all.list.size(), 10U);
  for (const Candidate& each : all.list) EXPECT_FALSE(each.main.empty()) << each.effect << each.at;
}

TEST(Candidates, LookForThePitchOfTheScrewsOfSlides) {
  Session session(50);
  session.robot = robot_of(
      "robot: slide\nkind: serial\nframes:\n"
      "  - {name: x, joint: prismatic, limits: [0, 2]}\n"
      "  - {name: turn, joint: revolute}\n  - {name: tool, joint: fixed, d: 1}\n");
  session.data.rows.q = Eigen::MatrixXd::Zero(50, 2);
  const auto finest = [&](const char* joint) {
    double waves = 0;
    for (const Candidate& each : session.candidates().list)
      if (each.effect == "transmission_error" && each.at == joint)
        for (const double k : each.shape.waves) waves = std::max(waves, k);
    return waves;
  };
  EXPECT_EQ(finest("x"), 500);     // of 2 mm
  EXPECT_EQ(finest("turn"), 322);  // twice a turn of the generator of a gear of 161 to 1
}

TEST(Candidates, LetGrowWhatCarriesTheRobotWhereThatIsSomething) {
  const auto of = [](const std::string& base, const std::string& first) {
    Session session(50);
    session.robot =
        robot_of("robot: grows\nkind: serial\nframes:\n" + base + "  - {name: x, joint: " + first +
                 ", limits: [0, 2]}\n  - {name: turn, joint: revolute}\n" +
                 "  - {name: tool, joint: fixed, d: 1}\n");
    session.data.rows.q = Eigen::MatrixXd::Zero(50, 2);
    session.data.rows.temperature = Eigen::VectorXd::LinSpaced(50, 20, 30);
    double carried = 0, alone = 0;
    for (const Candidate& each : session.candidates().list)
      if (each.effect == "thermal_expansion")
        (each.shape.base ? carried : alone) += std::exp(each.log_prior);
    return carried / alone;
  };
  const std::string column = "  - {name: base, joint: fixed, r: 1.5}\n";
  EXPECT_NEAR(of(column, "prismatic"), 1, 1e-9) << "a gantry's columns are of its machine";
  EXPECT_NEAR(of(column, "revolute"), 0.1, 1e-9) << "an arm's floor hardly";
  EXPECT_EQ(of("  - {name: base, joint: fixed}\n", "prismatic"), 0);
  EXPECT_EQ(of("", "prismatic"), 0);
}

TEST(Candidates, LetTheBaseDriftSettleWanderAndBeMovedAtOnce) {
  int straight = 0, settling = 0, wandering = 0, moved = 0;
  double drifting = 0, at_once = 0;
  for (const Candidate& each : Session(50).candidates().list) {
    if (each.effect != "base_drift") continue;
    const std::size_t waves = each.shape.half_waves.size();
    (waves > 0           ? wandering
     : each.shape.settle ? settling
     : each.shape.moment ? moved
                         : straight) += 1;
    (each.shape.moment ? at_once : drifting) += std::exp(each.log_prior);
    EXPECT_EQ(each.main.size(), waves > 0 ? 6 * waves : 6);
  }
  EXPECT_EQ(straight, 1);
  EXPECT_EQ(settling, 2);
  EXPECT_EQ(wandering, 2);
  EXPECT_GT(moved, 10);
  EXPECT_NEAR(at_once, drifting, 1e-12);
}

TEST(Candidates, LetTheToolMoveAndGiveWayAndTheDeviceBeOff) {
  Session session(50);
  session.context.sets = {{.name = "table", .touch = TouchedSurface::plane},
                          {.name = "leica", .lengths = true}};
  for (int row = 20; row < 50; ++row) session.data.rows.set[row] = 1;
  const auto count = [&](const char* effect, const char* at) {
    const Candidates all = session.candidates();
    return std::ranges::count_if(
        all.list, [&](const Candidate& each) { return each.effect == effect && each.at == at; });
  };
  EXPECT_EQ(count("tool_shift", "probe"), 24);
  EXPECT_EQ(count("tool_compliance", "probe"), 2);
  EXPECT_EQ(count("scale_error", "leica"), 1);
  EXPECT_EQ(count("scale_error", "table"), 0);
  session.data.rows.temperature = Eigen::VectorXd::LinSpaced(50, 20, 21);
  EXPECT_EQ(count("scale_error", "leica"), 6) << "following at once, and with four lags";
  session.data.rows.time.resize(0);
  EXPECT_EQ(count("tool_shift", "probe"), 0);
}

TEST(Candidates, LetWhatFollowsTheTemperatureBeLessLikelyThanWhatDoesNot) {
  Session session(50);
  session.context.sets = {{.name = "leica", .lengths = true}};
  session.data.rows.temperature = Eigen::VectorXd::LinSpaced(50, 20, 21);
  const auto following = [](const std::vector<Candidate>& all, const std::string& effect) {
    double probability = 0;
    for (const Candidate& each : all)
      if (each.effect == effect && each.shape.by == "temperature")
        probability += std::exp(each.log_prior);
    return probability;
  };
  const std::vector<Candidate> all = session.candidates().list;
  EXPECT_NEAR(following(all, "zero_shift"), 0.3 / 1.3, 1e-12);
  EXPECT_NEAR(following(all, "scale_error"), 0.1 / 1.1, 1e-12);
  // Without times nothing steps.
  session.data.rows.time.resize(0);
  EXPECT_NEAR(following(session.candidates().list, "zero_shift"), 1, 1e-12);
}

TEST(Candidates, SayWhatTheRowsCannotTest) {
  const auto list = Session(50).candidates().untestable;
  EXPECT_TRUE(std::ranges::any_of(
      list, [](const Untestable& each) { return each.effect == "thermal_expansion"; }));
}

}  // namespace
}  // namespace selfcal
