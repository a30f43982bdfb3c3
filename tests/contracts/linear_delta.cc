// What touches tell of a linear delta, and rows that no position of its effector has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "constraints/estimation/identification.h"
#include "constraints/identifiability/excitation.h"
#include "constraints/sampling/configurations.h"
#include "kinematics/make_robot.h"
#include "tests/contracts/method_case.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

constexpr const char* kPrinter = R"(robot: printer
kind: linear-delta
towers:
  - {radius: 0.105, angle: 3.66, rod: 0.2153, endstop: 0.5821, tilt: [0.01, -0.02], limits: [-0.35, 0]}
  - {radius: 0.104, angle: 5.76, rod: 0.2161, endstop: 0.5813, tilt: [-0.01, 0.01], limits: [-0.35, 0]}
  - {radius: 0.106, angle: 1.57, rod: 0.2149, endstop: 0.5826, tilt: [0.02, 0.01], limits: [-0.35, 0]}
effector: {rx: 0.01, ry: -0.015}
tool: [0.004, -0.003, -0.02]
)";

std::unique_ptr<Robot> printer() {
  Problems problems;
  auto robot = make_robot(*parse_yaml(kPrinter, "printer.yaml"), problems);
  for (const std::string& problem : problems.list) ADD_FAILURE() << problem;
  return robot;
}

/// How many parameters touches of one plane tell, with the scales free or held.
int told(const std::string& sets, bool scales) {
  const auto robot = printer();
  std::vector<char> candidate(robot->parameters().size(), 1);
  for (size_t i = 0; i < candidate.size(); ++i)
    if (robot->parameters()[i].part == Part::gear) candidate[i] = scales;
  const StructuralRank rank = structural(*robot, make_sets(sets), candidate, 150, 1);
  EXPECT_EQ(rank.unreached, "");
  return static_cast<int>(std::ranges::count(rank.rank.status, Status::identified));
}

// kinematics/robots/README.md says why: 21 parameters of the towers, of which three motions along
// and about a known plane are not seen, three more of an unknown one, and the size where the scales
// are free; nothing of tool and effector, which never turns.
TEST(LinearDeltaTouches, OfAKnownBedTellAllButThreeMotionsOfTheTowers) {
  EXPECT_EQ(told("bed: {method: plane, plane: [0, 0, -10]}\n", false), 18 - 3);
  EXPECT_EQ(told("bed: {method: plane, plane: [0, 0, -10]}\n", true), 21 - 3 - 1);
}

TEST(LinearDeltaTouches, OfAnUnknownBedTellThreeFewer) {
  EXPECT_EQ(told("bed: {method: plane}\n", false), 18 - 6);
  EXPECT_EQ(told("bed: {method: plane}\n", true), 21 - 6 - 1);
}

TEST(LinearDeltaTouches, OfAKnownStepTellTheScales) {
  EXPECT_EQ(told("bed: {method: plane}\n"
                 "block: {method: plane, parallel_to: {set: bed, distance: 0.05, noise: 1.0e-6}}\n",
                 true),
            21 - 6);
}

// Lengths between printed points that were measured: the effector's place relative to another, so
// the scales are told and all six motions of the towers together are not.
TEST(LinearDeltaTouches, WithPrintedDistancesTellTheScales) {
  EXPECT_EQ(told("print: {method: distance}\n", true), 21 - 6);
  EXPECT_EQ(told("bed: {method: plane}\nprint: {method: distance}\n", false), 18 - 6);
  EXPECT_EQ(told("bed: {method: plane}\nprint: {method: distance}\n", true), 21 - 6);
  EXPECT_EQ(told("bed: {method: plane, plane: [0, 0, -10]}\nprint: {method: distance}\n", true),
            21 - 3);
}

/// Touches of the bed by a printer that is off by its tolerances.
struct Session {
  std::unique_ptr<Robot> robot = printer();
  DataSet data;
  State truth;

  explicit Session(unsigned seed, double noise) {
    Random random(seed);
    std::normal_distribution<double> normal;
    Eigen::VectorXd xi = values(*robot);
    for (Eigen::Index i = 0; i < xi.size(); ++i)
      if (robot->parameters()[i].free)
        xi[i] += 0.5 * robot->parameters()[i].tolerance * normal(random);
    data.sets = make_sets("bed: {method: plane, plane: [0, 0, -10], noise: 2.0e-5}\n");
    SampleRequest request;
    request.rows = 90;
    request.residual = [&](int) { return Eigen::VectorXd::Constant(1, noise * normal(random)); };
    const Sampled sampled = sample_rows(*robot, xi, {request}, random, data);
    EXPECT_EQ(sampled.unreached, "");
    truth = sampled.truth;
    for (int row = 0; row < data.rows.rows(); row += 3) data.rows.check[row] = 1;
  }
};

TEST(LinearDeltaTouches, BringThePrinterBackToItsNoise) {
  constexpr double kNoise = 2e-5;
  Session session(3, kNoise);
  const Solution solution = identify(*session.robot, session.data);
  EXPECT_TRUE(solution.converged) << solution.stop_reason;
  EXPECT_GT(solution.residual.check.rms_before, 10 * kNoise);
  // 30 check rows: their root mean square is within 4 sigma / sqrt(60) of the noise, and what 15
  // parameters of 60 rows leave unknown adds a quarter of the variance.
  EXPECT_LT(solution.residual.check.rms_after, kNoise * (1.12 + 0.52));
  EXPECT_TRUE(solution.outliers.empty());
}

TEST(LinearDeltaTouches, LeaveOutTheRowsThatNoPositionHasAndSayWhy) {
  Session session(4, 2e-5);
  session.data.rows.q.row(4) << 0, -0.35, 0.35;  // carriages 0.7 m apart in height
  session.data.rows.q.row(3) << 0.35, -0.35, 0;
  const Solution solution = identify(*session.robot, session.data);
  EXPECT_TRUE(solution.converged) << solution.stop_reason;
  EXPECT_TRUE(solution.values.allFinite());
  ASSERT_EQ(solution.outliers.size(), 2);
  EXPECT_EQ(solution.outliers[0].row, 4);
  EXPECT_TRUE(solution.outliers[0].check);
  EXPECT_THAT(solution.outliers[0].why, HasSubstr("rods 1 and 2 cannot meet"));
  EXPECT_EQ(solution.outliers[1].row, 5);
  EXPECT_FALSE(solution.outliers[1].check);
  EXPECT_THAT(solution.outliers[1].why, HasSubstr("no position of the effector"));
  EXPECT_LT(solution.residual.check.rms_after, 2e-5 * (1.12 + 0.52));
}

TEST(LinearDeltaTouches, AreNoTouchesWhereNoneHasAPosition) {
  Session session(5, 2e-5);
  for (int row = 0; row < session.data.rows.rows(); ++row)
    session.data.rows.q.row(row) << 0.35, -0.35, 0;
  const Solution solution = identify(*session.robot, session.data);
  EXPECT_FALSE(solution.converged);
  EXPECT_EQ(solution.verdict.answer, Answer::not_determined);
  EXPECT_THAT(solution.verdict.why, HasSubstr("rods 1 and 2 cannot meet"));
  EXPECT_EQ(solution.outliers.size(), 60);
}

}  // namespace
}  // namespace selfcal
