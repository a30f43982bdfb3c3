// The rows of a simulated robot against what its scenario asks for.
#include "sim/data_set_maker.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "constraints/estimation/identification.h"
#include "kinematics/make_robot.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

const std::string kErrors =
    "robot: r\nerrors: {length: 1.0e-3, angle: 1.0e-3, base_length: 5.0e-3, tool_angle: 5.0e-3}\n";
const std::string kTable =
    "sets:\n  table: {method: plane, rows: 200, noise_true: 2.0e-5,\n"
    "          surface: {point: [0.7, 0, 0.1], normal: [0, 0, 1]}}\n";

/// Root mean square of one scalar residual.
double rms(const std::vector<RowResidual>& residuals, bool angles = false) {
  double sum = 0, count = 0;
  for (const RowResidual& r : residuals) {
    sum += angles ? r.angle * r.angle : r.length * r.length;
    count += angles ? r.angles : r.lengths;
  }
  return std::sqrt(sum / count);
}

double nuisance_of(const Solution& solution, const std::string& name) {
  for (const SetResult& set : solution.sets)
    for (const NuisanceResult& nuisance : set.nuisance)
      if (nuisance.name == name) return nuisance.value;
  return std::nan("");
}

/// Three sigmas of the rms of `count` normal numbers of 1 sigma.
double tolerance(double count) { return 3 / std::sqrt(2 * count); }

TEST(DataSetMaker, MakesTheSameRowsFromTheSameSeed) {
  const std::string text =
      kErrors + "false_triggers: {share: 0.1}\nrepeats: {share: 0.1}\n" + kTable;
  const Simulated a = made("seed: 3\n" + text), b = made("seed: 3\n" + text),
                  c = made("seed: 4\n" + text);
  EXPECT_EQ(a.data.rows.q, b.data.rows.q);
  EXPECT_EQ(a.truth.xi, b.truth.xi);
  EXPECT_EQ(a.false_rows, b.false_rows);
  EXPECT_EQ(a.data.rows.check, b.data.rows.check);
  EXPECT_NE(a.truth.xi, c.truth.xi);
  EXPECT_NE(a.data.rows.q, c.data.rows.q);
}

TEST(DataSetMaker, LeavesTheConfigurationsWhereTheyWereWhenTheNoiseGrows) {
  const Simulated quiet = made(kErrors + "sets: {t: {method: plane, rows: 20, noise_true: 0}}\n");
  const Simulated loud =
      made(kErrors + "sets: {t: {method: plane, rows: 20, noise_true: 1.0e-5}}\n");
  EXPECT_EQ(quiet.truth.xi, loud.truth.xi);
  // 5 sigma of a touch; joints move the endpoint by 0.1 m a radian or more.
  EXPECT_LT((quiet.data.rows.q - loud.data.rows.q).cwiseAbs().maxCoeff(), 5e-5 / 0.1);
  EXPECT_NE(quiet.data.rows.q, loud.data.rows.q);
}

TEST(DataSetMaker, GivesTouchesTheNoiseAskedFor) {
  const Simulated simulated = made(kErrors + kTable);
  EXPECT_NEAR(rms(residuals_at_truth(simulated)) / 2e-5, 1, tolerance(200));
}

TEST(DataSetMaker, HoldsTheJointsThatASetLocksWhateverTheNoise) {
  const Simulated simulated =
      made(kErrors +
           "sets:\n"
           "  tip: {method: position-constraint, rows: 24, noise_true: 2.0e-5, locked: [j2]}\n"
           "  nest: {method: location-constraint, rows: 8, rows_per_group: 2}\n"
           "  table: {method: plane, rows: 100, noise_true: 2.0e-5, locked: [j1, j3],\n"
           "          surface: {point: [0.7, 0, 0.1], normal: [0, 0, 1]}}\n");
  ASSERT_EQ(simulated.unreached, "");
  const Observations& rows = simulated.data.rows;
  const std::vector<std::vector<int>> locked = {{1}, {}, {0, 2}};
  std::map<int, Eigen::RowVectorXd> first;
  std::map<int, Eigen::RowVectorXd> widest;
  for (int i = 0; i < rows.rows(); ++i) {
    const auto at = first.emplace(rows.set[i], rows.q.row(i)).first;
    auto& wide = widest.emplace(rows.set[i], Eigen::RowVectorXd::Zero(rows.q.cols())).first->second;
    wide = wide.cwiseMax((rows.q.row(i) - at->second).cwiseAbs());
  }
  for (const auto& [set, wide] : widest)
    for (int j = 0; j < wide.size(); ++j) {
      const bool held = std::ranges::count(locked[static_cast<size_t>(set)], j) > 0;
      EXPECT_EQ(wide[j] == 0, held) << "set " << set << " joint " << j + 1 << " " << wide[j];
    }
  std::vector<RowResidual> touches;
  for (const RowResidual& each : residuals_at_truth(simulated))
    if (simulated.data.sets[each.set].name == "table") touches.push_back(each);
  EXPECT_NEAR(rms(touches) / 2e-5, 1, tolerance(100));
}

TEST(DataSetMaker, RefusesToLockAJointThatTheRobotHasNot) {
  EXPECT_THAT(problem_of("robot: r\nsets: {t: {method: plane, locked: [elbow]}}\n"),
              HasSubstr("set t locked: the robot has no joint elbow"));
}

TEST(DataSetMaker, MakesRowsThatSatisfyEveryMethodWhenThereIsNoNoise) {
  const Simulated simulated = made(
      kErrors +
      "sets:\n"
      "  known: {method: plane, plane: [0, 0, -2], rows: 9}\n"
      "  far: {method: plane, parallel_to: {set: near, distance: 0.1, noise: 1.0e-6}, rows: 9}\n"
      "  near: {method: plane, rows: 9, surface: {point: [0.5, 0, 0], normal: [-1, 0, 0]}}\n"
      "  ball: {method: sphere, rows: 9, truth: {cx: 0.6, cy: 0.1, cz: 0.5, radius: 0.1}}\n"
      "  shelf: {method: plane-normal, rows: 9}\n"
      "  tip: {method: position-constraint, rows: 9}\n"
      "  nest: {method: location-constraint, rows: 8}\n"
      "  arm: {method: location, frame: unknown, rows: 9}\n"
      "  leica: {method: position, frame: unknown, point: unknown, rows: 9}\n"
      "  bar: {method: distance, rows: 9}\n");
  for (const RowResidual& r : residuals_at_truth(simulated)) {
    const std::string& name = simulated.data.sets[r.set].name;
    EXPECT_LT(r.length, 1e-11) << name << " row " << r.row;  // touches end within 1e-12
    EXPECT_LT(r.angle, 1e-11) << name << " row " << r.row;
  }
}

TEST(DataSetMaker, GivesInstrumentsAndSharedPlacesTheNoiseAskedFor) {
  for (const std::string method : {"position", "distance", "position-constraint", "plane-normal"}) {
    const Simulated simulated =
        made(kErrors + "sets: {s: {method: " + method + ", rows: 200, noise_true: 3.0e-5}}\n");
    // Neighbours of a paired method share errors or rows: half as many count.
    EXPECT_NEAR(rms(residuals_at_truth(simulated)) / 3e-5, 1, tolerance(100)) << method;
  }
  for (const std::string method : {"location", "location-constraint"}) {
    const Simulated simulated =
        made(kErrors + "sets: {s: {method: " + method +
             ", rows: 200, noise_true: 3.0e-5, noise_angle_true: 1.0e-5}}\n");
    EXPECT_NEAR(rms(residuals_at_truth(simulated)) / 3e-5, 1, tolerance(600)) << method;
    EXPECT_NEAR(rms(residuals_at_truth(simulated), true) / 1e-5, 1, tolerance(600)) << method;
  }
}

TEST(DataSetMaker, MakesAsManyRowsFalseAsAskedAndAllOfThemEarly) {
  const Simulated simulated =
      made(kErrors + "false_triggers: {share: 0.05, size: [1.0e-3, 8.0e-3]}\n" + kTable);
  EXPECT_EQ(simulated.false_rows.size(), 10U);
  for (const RowResidual& r : residuals_at_truth(simulated)) {
    const bool is_false = std::ranges::binary_search(simulated.false_rows, r.row);
    // 6 sigma of the noise; the table is touched from above, so that early is high.
    if (is_false) {
      EXPECT_GT(r.scalars[0], 1e-3 - 1.2e-4);
      EXPECT_LT(r.scalars[0], 8e-3 + 1.2e-4);
    } else {
      EXPECT_LT(r.length, 1.2e-4);
    }
  }
}

TEST(DataSetMaker, MarksTheShareOfRowsThatJudges) {
  const Simulated simulated = made("check: 0.25\n" + kErrors + kTable);
  EXPECT_EQ(std::ranges::count(simulated.data.rows.check, 1), 50);
}

TEST(DataSetMaker, RepeatsConfigurationsInOnePartWithNoiseOfTheirOwn) {
  const Simulated simulated = made(kErrors + "repeats: {share: 0.1, times: 3}\n" + kTable);
  const Observations& rows = simulated.data.rows;
  EXPECT_EQ(rows.rows(), 200);
  std::map<int, std::vector<int>> by_repeat;
  for (int row = 0; row < rows.rows(); ++row)
    if (rows.repeat[row] >= 0) by_repeat[rows.repeat[row]].push_back(row);
  EXPECT_GE(by_repeat.size(), 16U);  // a tenth of 200 / 1.2
  for (const auto& [id, members] : by_repeat) {
    ASSERT_GE(members.size(), 2U);
    for (std::size_t i = 1; i < members.size(); ++i) {
      EXPECT_EQ(members[i], members[i - 1] + 1);
      EXPECT_EQ(rows.check[members[i]], rows.check[members[0]]);
      EXPECT_NE(rows.q.row(members[i]), rows.q.row(members[0]));
      EXPECT_LT((rows.q.row(members[i]) - rows.q.row(members[0])).norm(), 5e-3);
    }
  }
}

TEST(DataSetMaker, RoundsReadingsToTheEncodersStep) {
  const Simulated simulated = made("encoder_step: 1.0e-4\n" + kErrors + kTable);
  const Eigen::ArrayXXd steps = simulated.data.rows.q.array() / 1e-4;
  EXPECT_LT((steps - steps.round()).abs().maxCoeff(), 1e-6);  // counts up to 1e5, 1e-16 of each
}

TEST(DataSetMaker, PutsGivenErrorsInPlaceOfDrawnOnes) {
  const Simulated simulated = made("robot: r\nerrors: {parameters: {j3.d: 0.0012}}\n" + kTable);
  const Eigen::VectorXd errors = simulated.truth.xi - values(rx90());
  EXPECT_NEAR(errors[find_parameter(rx90(), "d3")], 0.0012, 1e-15);
  EXPECT_NEAR(errors.norm(), 0.0012, 1e-15);
}

TEST(DataSetMaker, TurnsTheProbesNormalTowardsTheRobotAndTouchesWithItsRim) {
  const Simulated simulated =
      made(kErrors +
           "sets:\n"
           "  table: {method: plane, probe_radius: 0.003, rows: 20, noise_true: 1.0e-5,\n"
           "          surface: {point: [0.7, 0, 0.1], normal: [0, 0, 1]}}\n"
           "  wall: {method: plane, probe_radius: 0.003, rows: 20, plane: [-1, 0, 0]}\n"
           "  below: {method: plane, probe_radius: 0.003, rows: 20, outward: [0, 0, -1],\n"
           "          parallel_to: {set: table, distance: 0.2, noise: 1.0e-6}}\n");
  const Observations& rows = simulated.data.rows;
  const Eigen::RowVector3d expected[] = {{0, 0, 1}, {-1, 0, 0}, {0, 0, -1}};
  for (int row = 0; row < rows.rows(); ++row)
    EXPECT_EQ(rows.normal.row(row), expected[rows.set[row]]) << row;
  for (const RowResidual& r : residuals_at_truth(simulated))
    EXPECT_LT(r.length, 6e-5) << r.row;  // 6 sigma
}

TEST(DataSetMaker, ReadsWhatComplianceHidesFromTheEncoders) {
  const std::string text =
      "robot: arm\nkind: serial\nframes:\n"
      "  - {name: j1, joint: revolute, alpha: 1.5707963267948966, limits: [-1, 1]}\n"
      "  - {name: tip, joint: fixed, d: 2, mass: 3, com: [0, 0, 0]}\n";
  Problems problems;
  const auto arm = make_robot(*parse_yaml(text, "arm"), problems);
  const std::string sets = "sets: {eye: {method: position, rows: 30}}\n";
  const Simulated stiff = made("robot: arm\n" + sets, *arm);
  const Simulated soft = made("robot: arm\ncompliance: {j1: 1.0e-5}\n" + sets, *arm);
  EXPECT_EQ(stiff.data.rows.position, soft.data.rows.position);
  for (int row = 0; row < 30; ++row) {
    // The axis is -y of the world: a mass at distance 2 pulls the joint down by -m g 2 cos q.
    const double q = stiff.data.rows.q(row, 0), torque = -3 * 9.81 * 2 * std::cos(q);
    EXPECT_NEAR(soft.data.rows.q(row, 0), q - 1e-5 * torque, 1e-15);
  }
}

TEST(DataSetMaker, TakesComplianceBesideTheEffectsOfTheRobotsFile) {
  Problems problems;
  const auto arm = make_robot(
      *parse_yaml("robot: arm\nkind: serial\nframes:\n"
                  "  - {name: j1, joint: revolute, alpha: 1.5707963267948966, limits: [-1, 1]}\n"
                  "  - {name: tip, joint: fixed, d: 2, mass: 3, com: [0, 0, 0]}\n"
                  "effects:\n  - {effect: transmission_error, at: j1, waves: [1], sin1: 1.0e-3}\n",
                  "arm"),
      problems);
  ASSERT_FALSE(problems.any()) << problems.list.front();
  const std::string sets = "sets: {eye: {method: position, rows: 3}}\n";
  EXPECT_NE(made("robot: arm\n" + sets, *arm).data.rows.q,
            made("robot: arm\ncompliance: {j1: 1.0e-5}\n" + sets, *arm).data.rows.q);
}

TEST(DataSetMaker, PutsAParallelPlaneBeyondTheOtherOneUnlessItsTruthSaysNearer) {
  const std::string sets =
      "sets:\n  table: {method: plane, noise_true: 0, rows: 12,\n"
      "          surface: {point: [0.7, 0, 0.4], normal: [0, 0, -1]}}\n"
      "  step: {method: plane, noise_true: 0, rows: 12,\n"
      "         parallel_to: {set: table, distance: 0.2, noise: 2.0e-6}";
  const std::vector<std::pair<std::string, double>> cases = {{"}\n", 0.6},
                                                             {", truth: {d: 0.2}}\n", 0.2}};
  for (const auto& [truth, d] : cases) {
    const Simulated simulated = made(kErrors + sets + truth);
    EXPECT_NEAR(simulated.truth.nuisance[1][0], d, 1e-9);
    EXPECT_LT(rms(residuals_at_truth(simulated)), 1e-9);
    // What identifies starts from the rows: they say on which side they lie.
    EXPECT_NEAR(nuisance_of(identify(rx90(), simulated.data), "step.d"), d, 0.02) << truth;
  }
}

TEST(DataSetMaker, RefusesALockOnARobotThatLacksTheJoint) {
  Problems problems;
  make_data_set(scenario_of("robot: r\nsets: {lock: {method: locked-joint, lock: {leg: 1, joint: "
                            "universal}, rows: 20}}\n"),
                rx90(), problems);
  ASSERT_TRUE(problems.any());
  EXPECT_THAT(problems.list[0], HasSubstr("set lock: this serial robot has no such joint to lock"));
}

TEST(DataSetMaker, SaysWhichSetIsOutOfReach) {
  Problems problems;
  const Simulated simulated = make_data_set(
      scenario_of("robot: r\nsets: {sky: {method: plane, plane: [0, 0, -0.1], rows: 5}}\n"), rx90(),
      problems);
  EXPECT_FALSE(problems.any());
  EXPECT_THAT(simulated.unreached, HasSubstr("set sky: only 0 of 5"));
}

}  // namespace
}  // namespace selfcal
