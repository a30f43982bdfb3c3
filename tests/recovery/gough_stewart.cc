// A Gough-Stewart platform that calibrates itself: by locked joints, by touches of its own probe,
// by two inclinometers, and by an instrument's positions and locations.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "constraints/sampling/random_poses.h"
#include "kinematics/linear_algebra.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/recovery/rx90.h"

namespace selfcal::recovery {
namespace {

SetPart lock(const char* name, const char* leg, const char* joint, int rows) {
  Node node = entry({{"method", "locked-joint"}});
  node.set("lock", entry({{"leg", leg}, {"joint", joint}}));
  return {name, node, rows};
}

std::vector<SetPart> three_locks(int rows) {
  return {lock("u1", "1", "universal", rows), lock("u3", "3", "universal", rows),
          lock("s5", "5", "spherical", rows)};
}

struct Way {
  const char* title;
  std::vector<SetPart> parts;
  bool point;  ///< rows tell where the platform's point is
};

std::vector<Way> ways() {
  return {{"locks", three_locks(60), false},
          {"planes", four_planes(60), true},
          {"inclinometers", {{"tilt", entry({{"method", "inclinometers"}}), 150}}, false},
          {"positions", {{"tracker", entry({{"method", "position"}}), 100}}, true},
          {"locations", {{"arm", entry({{"method", "location"}}), 60}}, true}};
}

/// Every joint's centre and every offset is off as its maker says.
Eigen::VectorXd platform_truth(const Robot& robot, Random& random) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd xi = nominal_values(robot);
  for (size_t i = 0; i < robot.parameters().size(); ++i)
    xi[static_cast<Eigen::Index>(i)] += robot.parameters()[i].tolerance * normal(random);
  return xi;
}

/// Root mean square of the end position's error over 500 poses, less a motion of the base and,
/// where rows do not tell of it, a shift of the platform's point: of errors so small, linear.
double end_position_error(const Robot& robot, const Eigen::VectorXd& xi,
                          const Eigen::VectorXd& truth, bool point) {
  constexpr int kPoses = 500;
  const Eigen::MatrixXd q = random_poses(robot, nullptr, kPoses, 7);
  Eigen::MatrixXd B(3 * kPoses, point ? 6 : 9);
  Eigen::VectorXd e(3 * kPoses);
  for (int i = 0; i < kPoses; ++i) {
    const Location is = locate(robot, truth, q.row(i).transpose());
    e.segment<3>(3 * i) = locate(robot, xi, q.row(i).transpose()).p - is.p;
    B.block<3, 3>(3 * i, 0).setIdentity();
    B.block<3, 3>(3 * i, 3) = -skew(is.p);
    if (!point) B.block<3, 3>(3 * i, 6) = is.R;
  }
  return beyond(B, e).norm() / std::sqrt(kPoses);
}

TEST(GoughStewart, IsFoundFromExactRowsToRoundingByEveryWay) {
  const auto robot = robot_of(kind_examples().at("gough-stewart"));
  for (const Way& way : ways()) {
    Random random(5);
    const Exact exact = without_priors(*robot, platform_truth(*robot, random), way.parts, random);
    ASSERT_EQ(exact.unreached, "") << way.title;
    EXPECT_TRUE(exact.solution.converged) << way.title << ": " << exact.solution.stop_reason;
    std::printf("%s: %.1e\n", way.title, exact.largest_error);
    EXPECT_LT(exact.largest_error, 1e-9) << way.title;
  }
}

TEST(GoughStewart, IsFoundWithinItsSigmaFromRowsUnderNoiseByEveryWay) {
  const auto robot = robot_of(kind_examples().at("gough-stewart"));
  for (const Way& way : ways()) {
    double squares = 0, of_stated = 0;
    int errors = 0;
    constexpr int kRobots = 10;
    for (int seed = 1; seed <= kRobots; ++seed) {
      Random random(seed);
      const Eigen::VectorXd truth = platform_truth(*robot, random);
      const Session session = make_session(*robot, truth, way.parts, 10e-6, random);
      ASSERT_EQ(session.unreached, "") << way.title;
      const Solution solution = identify(*robot, session.data);
      EXPECT_TRUE(solution.converged) << way.title << seed << " " << solution.stop_reason;
      EXPECT_EQ(solution.verdict.answer, Answer::improved)
          << way.title << seed << " " << solution.verdict.why;
      // The offsets are no matter of the frames chosen.
      for (size_t i = 0; i < solution.parameters.size(); ++i) {
        const ParameterResult& p = solution.parameters[i];
        if (p.parameter.field != "offset" || p.status != Status::identified) continue;
        ++errors;
        squares += std::pow((p.value - truth[static_cast<Eigen::Index>(i)]) / p.sigma, 2);
      }
      const double error = end_position_error(*robot, solution.values, truth, way.point);
      of_stated += std::pow(error / solution.endpoint.rms, 2) / kRobots;
      EXPECT_LT(error, 3 * solution.endpoint.rms) << way.title << seed;  // 3 sigma of one robot
      if (seed == 1)
        std::printf("%s: end position %.3g mm off, %.3g stated\n", way.title, 1e3 * error,
                    1e3 * solution.endpoint.rms);
    }
    std::printf("%s: %d offsets off by rms %.3f sigma, end positions by %.3f\n", way.title, errors,
                std::sqrt(squares / errors), std::sqrt(of_stated));
    // Offsets of one robot hang together: ten robots of about three independent ones, 3 sigma.
    EXPECT_NEAR(std::sqrt(squares / errors), 1, 0.4) << way.title;
    EXPECT_LT(std::sqrt(of_stated), 1.5) << way.title;
  }
}

TEST(GoughStewart, NamesALockThatSlippedMidwayAsNoNoise) {
  const auto robot = robot_of(kind_examples().at("gough-stewart"));
  Random random(11);
  const Eigen::VectorXd truth = platform_truth(*robot, random);
  // The same joint locked twice, at two directions 5 mrad and more apart, given as one lock.
  Session session =
      make_session(*robot, truth,
                   {lock("u1", "1", "universal", 60), lock("u3", "3", "universal", 60),
                    lock("slipped", "1", "universal", 20)},
                   10e-6, random);
  ASSERT_EQ(session.unreached, "");
  for (int& set : session.data.rows.set)
    if (set == 2) set = 0;
  const Solution solution = identify(*robot, session.data);
  EXPECT_NE(solution.verdict.answer, Answer::improved) << solution.verdict.why;
}

}  // namespace
}  // namespace selfcal::recovery
