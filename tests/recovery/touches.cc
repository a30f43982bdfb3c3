// Touches of unknown planes: the scale, the false rows, the end position.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "constraints/estimation/identification.h"
#include "constraints/methods/shared/unit_normal.h"
#include "io/files/robot_file.h"
#include "tests/recovery/random_robot.h"
#include "tests/recovery/rx90.h"
#include "tests/support/end_position.h"

namespace selfcal::recovery {
namespace {

double root_mean_square(const std::vector<double>& errors) {
  double square = 0;
  for (const double e : errors) square += e * e / static_cast<double>(errors.size());
  return std::sqrt(square);
}

TEST(Touches, BringTheEndPositionFromMillimetresToHundredthsOnceTheScaleIsGiven) {
  const auto robot = robot_of(kRx90);
  std::vector<double> medians;
  int dishonest = 0;
  for (int seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
    std::vector<SetPart> parts = four_planes(75);
    parts.push_back(step_of_a(60));
    const Session session = make_session(*robot, truth, parts, 20e-6, random);
    ASSERT_EQ(session.unreached, "");
    const Solution solution = identify(*robot, session.data);
    const auto before = aligned_errors(*robot, nominal_values(*robot), truth);
    const auto after = aligned_errors(*robot, solution.values, truth);
    std::printf("median end-position error %.3f to %.4f mm; rms %.4f, stated %.4f\n",
                1e3 * before[250], 1e3 * after[250], 1e3 * root_mean_square(after),
                1e3 * solution.endpoint.rms);
    EXPECT_GT(before[250], 1e-3);
    EXPECT_LT(after[250], 0.1e-3);
    EXPECT_TRUE(solution.gauge.empty());
    EXPECT_EQ(solution.verdict.answer, Answer::improved) << solution.verdict.why;
    medians.push_back(after[250]);
    dishonest += root_mean_square(after) > 2 * solution.endpoint.rms;
  }
  // 0.010 to 0.026 mm are known to be reached on planes chosen well; these are random ones.
  std::sort(medians.begin(), medians.end());
  EXPECT_LT(medians[5], 0.03e-3);
  // The errors of a robot are one draw of a few badly known directions: 2 sigma hold in 95 %.
  EXPECT_LE(dishonest, 2);
}

TEST(Touches, OfExactPlanesAndAStepGiveEveryParameterToOneNanometreOrNanoradianWithoutPriors) {
  const auto robot = robot_of(kRx90);
  for (int seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    std::vector<SetPart> parts = four_planes(75);
    parts.push_back(step_of_a(60));
    const Exact exact = without_priors(*robot, rx90_truth(*robot, random, false), parts, random);
    ASSERT_EQ(exact.unreached, "");
    EXPECT_TRUE(exact.solution.converged) << seed << " " << exact.solution.stop_reason;
    EXPECT_LT(exact.solution.residual.check.max_after, 1e-9) << "seed " << seed;
    EXPECT_LT(exact.largest_error, 1e-9) << "seed " << seed;
  }
}

TEST(Touches, HoldOneLengthAndSaySoWhenNothingGivesTheScale) {
  const auto robot = robot_of(kRx90);
  Random random(3);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  const Session session = make_session(*robot, truth, four_planes(90), 20e-6, random);
  const Solution solution = identify(*robot, session.data);
  ASSERT_EQ(solution.gauge.size(), 1u);
  EXPECT_EQ(solution.gauge[0].parameter, "r4");
  const int r4 = find_parameter(*robot, "r4");
  EXPECT_EQ(solution.parameters[r4].status, Status::held);
  // Where all the maker's lengths together have the scale: better than this one alone.
  const auto at = std::ranges::find(solution.covariance_order, "r4");
  ASSERT_NE(at, solution.covariance_order.end());
  const auto k = at - solution.covariance_order.begin();
  const double sigma = std::sqrt(solution.covariance(k, k));
  EXPECT_LT(sigma, 0.75 * robot->parameters()[r4].tolerance);
  EXPECT_LT(std::abs(solution.values[r4] - truth[r4]), 3 * sigma);
  const auto after = aligned_errors(*robot, solution.values, truth);
  EXPECT_LT(root_mean_square(after), 2 * solution.endpoint.rms);
}

TEST(Touches, NeverShrinkTheRobotOverTenCalibrationsEachOnTheLast) {
  Random random(5);
  auto robot = robot_of(kRx90);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  const Session session = make_session(*robot, truth, four_planes(90), 20e-6, random);
  const Solution first = identify(*robot, session.data);
  for (int round = 1; round < 10; ++round) {
    robot = robot_of(
        robot_text(*robot, round == 1 ? first.values : identify(*robot, session.data).values));
  }
  const Solution last = identify(*robot, session.data);
  for (size_t i = 0; i < first.parameters.size(); ++i) {
    if (first.parameters[i].sigma <= 0) continue;
    EXPECT_LT(std::abs(last.parameters[i].value - first.parameters[i].value),
              first.parameters[i].sigma)
        << first.parameters[i].parameter.name;
  }
}

TEST(Touches, PutFalseRowsAsideByNameAndOnlyThem) {
  const auto robot = robot_of(kRx90);
  Random random(8);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  std::vector<SetPart> parts = four_planes(90);
  parts.push_back(step_of_a(60));
  Session session = make_session(*robot, truth, parts, 20e-6, random);
  std::set<int> wrong;  // 3 % of the rows: a joint reading off by 1 to 4 mrad
  std::uniform_real_distribution<double> size(1e-3, 4e-3);
  for (int i = 5; i < session.data.rows.rows(); i += 33) {
    session.data.rows.q(i, 1) += size(random);
    wrong.insert(i + 1);
  }
  const Solution solution = identify(*robot, session.data);
  std::set<int> named;
  for (const Outlier& r : solution.outliers) named.insert(r.row);
  int missed = 0, innocent = 0;
  for (const int row : wrong) missed += named.count(row) == 0;
  for (const int row : named) innocent += wrong.count(row) == 0;
  // Some false readings move the endpoint along the plane and change nothing: those may stay.
  EXPECT_LE(missed, 2);
  EXPECT_LE(innocent, 1);
  EXPECT_LT(aligned_errors(*robot, solution.values, truth)[250], 0.05e-3);
}

// Balls of 20 mm touched with the tool towards them, whose file has it 30 mm longer than it is and
// the base elsewhere: as the robot is thought to be, it went through the balls.
TEST(Touches, OfKnownBallsAreFoundByAToolThatIsShorterThanThought) {
  const auto robot = robot_of(kRx90);
  const std::vector<Eigen::Vector3d> centres{
      {0.6, 0.1, 0.6}, {0.5, -0.3, 0.7}, {0.3, 0.5, 0.9}, {-0.2, 0.6, 0.6}};
  for (int seed = 1; seed <= 6; ++seed) {
    Random random(seed);
    Eigen::VectorXd truth = rx90_truth(*robot, random, false);
    truth[find_parameter(*robot, "r7")] -= 0.03;
    const Eigen::Vector3d aside = 0.02 * random_direction(random);
    const auto balls = [&](const Eigen::Vector3d& by) {
      std::vector<SetPart> parts;
      for (const Eigen::Vector3d& centre : centres) {
        Node ball = entry({{"method", "sphere"}, {"radius", "0.02"}});
        ball.set("center", Node::of(Eigen::VectorXd(centre + by)));
        parts.push_back({"ball" + std::to_string(parts.size()), ball, 150});
      }
      return parts;
    };
    Session session = make_session(*robot, truth, balls(aside), 20e-6, random);
    ASSERT_EQ(session.unreached, "");
    std::vector<int> towards;
    for (int row = 0; row < session.data.rows.rows(); ++row) {
      const Location end = locate(*robot, truth, session.data.rows.q.row(row).transpose());
      const auto set = static_cast<std::size_t>(session.data.rows.set[row]);
      const Eigen::Vector3d normal = (end.p - centres[set] - aside).normalized();
      if (end.R.col(2).dot(normal) < -0.3) towards.push_back(row);
    }
    session.data.rows = taken(session.data.rows, towards);
    Node all = Node::map();
    for (const SetPart& part : balls(Eigen::Vector3d::Zero())) all.set(part.name, part.node);
    Problems problems;
    session.data.sets = read_sets(all, problems);
    ASSERT_FALSE(problems.any());
    const Solution solution = identify(*robot, session.data);
    EXPECT_TRUE(solution.converged) << solution.stop_reason;
    EXPECT_LT(solution.residual.check.rms_after, 60e-6) << "seed " << seed;
  }
}

// As the robot is thought to be, its tool 60 mm aside, six touches of a ball lie on no ball at all,
// and its middle is sought on either side of them; the other balls tell where the tool is.
TEST(Touches, OfABallThatIsTouchedAFewTimesAreFoundOnceTheToolIs) {
  const auto robot = robot_of(kRx90);
  int wrong = 0;
  for (int seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    Eigen::VectorXd truth = rx90_truth(*robot, random, false);
    truth[find_parameter(*robot, "d7")] += 0.06;
    std::vector<SetPart> parts;
    for (const char* name : {"few", "b", "c", "d"})
      parts.push_back({name, entry({{"method", "sphere"}, {"radius", "0.06"}}), 60});
    Session session = make_session(*robot, truth, parts, 20e-6, random);
    if (!session.unreached.empty()) continue;
    for (int row = 0, few = 0; row < session.data.rows.rows(); ++row)
      if (session.data.rows.set[row] == 0) session.data.rows.check[row] = ++few > 6;
    const Solution solution = identify(*robot, session.data);
    wrong += !(solution.residual.check.rms_after < 0.2e-3);
  }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace selfcal::recovery
