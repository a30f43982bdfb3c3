// What a result says of its own doubt: parts that add up, and tests that see what is no noise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "constraints/estimation/controller_sigma.h"
#include "constraints/identifiability/endpoint_sigma.h"
#include "constraints/sampling/workspace_poses.h"
#include "tests/recovery/rx90.h"
#include "tests/recovery/uncertainty_budget.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal::recovery {
namespace {

/// The session of `parts` with each row twice, and noise of its own: repeats.
Session repeated(const Robot& robot, const Eigen::VectorXd& truth, int rows, Random& random) {
  Session session = make_session(robot, truth, tracked(rows), 0, random);
  std::vector<int> twice;
  for (int row = 0; row < rows; ++row) twice.insert(twice.end(), 2, row);
  session.data.rows = taken(session.data.rows, twice);
  Observations& o = session.data.rows;
  std::normal_distribution<double> noise(0, 20e-6);
  o.repeat.clear();
  for (int row = 0; row < o.rows(); ++row) {
    o.repeat.push_back(row / 2);
    o.check[static_cast<size_t>(row)] = row / 2 % 3 == 0;
    for (int k = 0; k < 3; ++k) o.position(row, k) += noise(random);
  }
  return session;
}

TEST(Uncertainty, SaysThatAWorkspaceIsHardlyReached) {
  const auto robot = robot_of(kRx90);
  Random random(4);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  Session session = make_session(*robot, truth, tracked(90), 20e-6, random);
  EXPECT_EQ(identify(*robot, session.data).verdict.answer, Answer::improved);
  // A room in whose corner alone the robot works.
  session.data.workspace.box =
      Eigen::AlignedBox3d(Eigen::Vector3d(0.4, -9, 0.2), Eigen::Vector3d(30, 9, 30));
  const Solution solution = identify(*robot, session.data);
  EXPECT_GT(solution.workspace.poses, 0);
  EXPECT_LT(solution.workspace.poses, kFewestPoses);
  EXPECT_LT(solution.workspace.rms, session.data.target);
  EXPECT_EQ(solution.verdict.answer, Answer::not_determined);
  EXPECT_TRUE(std::ranges::any_of(solution.warnings, [&](const std::string& each) {
    return each.starts_with("workspace: only " + std::to_string(solution.workspace.poses));
  }));
}

TEST(Uncertainty, HasABudgetThatAddsUpAndResidualsThatAreNoise) {
  const auto robot = robot_of(kRx90);
  Random random(4);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  const Session session = repeated(*robot, truth, 150, random);
  const Solution solution = identify(*robot, session.data);
  const Uncertainty& u = solution.uncertainty;
  double squares = 0;
  for (const BudgetLine& line : u.budget) squares += line.sigma * line.sigma;
  EXPECT_NEAR(std::sqrt(squares), solution.workspace.rms, 1e-9);
  EXPECT_NEAR(u.expanded, u.k * solution.workspace.rms, 1e-12);
  EXPECT_NEAR(u.k, 1.96, 0.02);
  // 200 rows of three coordinates, of which 33 parameters are determined, some by their priors; of
  // the doubt, what is given has no end of freedoms, so that those of the sum are no fewer.
  EXPECT_NEAR(u.lack_of_fit.freedoms + u.lack_of_fit.repeat_freedoms, 600 - 33, 12);
  EXPECT_GE(u.freedoms, 600 - 33 - 12);
  EXPECT_EQ(u.lack_of_fit.repeat_freedoms, 300);
  EXPECT_GT(u.lack_of_fit.p_value, 0.001);
  EXPECT_GT(u.residuals.normality_p, 0.001);
  EXPECT_GT(u.residuals.autocorrelation_p, 0.001);
  EXPECT_EQ(u.repeats.poses, 150);
  // Two readings apart by sqrt(2) of their noise, each half of it from their mean.
  EXPECT_NEAR(u.repeats.repeatability, 60e-6, 40e-6);
  EXPECT_LT(u.repeats.accuracy, 100e-6);
  for (const GridCell& cell : u.grid) {
    if (cell.rows > 0) {
      EXPECT_LT(cell.bias, 60e-6);
    }
  }
}

TEST(Uncertainty, SeesAnEffectThatTheModelLacks) {
  const auto robot = robot_of(kRx90);
  Random random(4);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  Session session = repeated(*robot, truth, 150, random);
  const Solution without = identify(*robot, session.data);
  Observations& o = session.data.rows;  // a gear that is off by 0.5 mrad twice a turn
  for (int row = 0; row < o.rows(); ++row) o.q(row, 1) -= 5e-4 * std::sin(2 * o.q(row, 1));
  const Solution with = identify(*robot, session.data);
  EXPECT_LT(with.uncertainty.lack_of_fit.p_value, 1e-6);
  EXPECT_GT(with.uncertainty.lack_of_fit.F, 5);
  EXPECT_GT(with.workspace.rms, 2 * without.workspace.rms);
}

TEST(Uncertainty, FindsNoLackOfFitInLocationsWhosePositionsAreBetterThanSaid) {
  const Simulated simulated = made(
      "robot: rx90.robot.yaml\nseed: 3\nerrors: {length: 1.0e-3, angle: 1.0e-3}\n"
      "repeats: {share: 1, times: 3}\nsets: {nest: {method: location, rows: 60, noise: 1.0e-4,\n"
      "  noise_angle: 1.0e-4, noise_true: 1.0e-5, noise_angle_true: 1.0e-4}}\n");
  const LackOfFit fit = identify(rx90(), simulated.data).uncertainty.lack_of_fit;
  EXPECT_EQ(fit.repeat_freedoms, 156);  // 13 configurations identify: two each, times six scalars
  EXPECT_GT(fit.p_value, 0.01);
}

TEST(Uncertainty, GrowsWhereHalvesOfTheRowsDisagree) {
  const auto robot = robot_of(kRx90);
  Random random(8);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  Session session = make_session(*robot, truth, tracked(200), 20e-6, random);
  const Solution steady = identify(*robot, session.data);
  Observations& o = session.data.rows;
  // Half way a joint slips by 0.3 mrad: independent rows would not tell, for it looks like noise.
  for (int row = o.rows() / 2; row < o.rows(); ++row) o.q(row, 2) += 3e-4;
  const Solution slipped = identify(*robot, session.data);
  EXPECT_GT(budget(slipped, "rows that share errors"), 2 * budget(slipped, "noise of the rows"));
  EXPECT_LT(budget(steady, "rows that share errors"), 1.5 * budget(steady, "noise of the rows"));
}

TEST(Uncertainty, IsRepeatedByAReaderOfTheExportedCovariance) {
  const auto robot = robot_of(kRx90);
  Random random(6);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  const Session session = make_session(*robot, truth, tracked(150), 20e-6, random);
  const Solution solution = identify(*robot, session.data);
  const auto n = static_cast<Eigen::Index>(robot->parameters().size());
  std::vector<int> at;
  for (const std::string& name : solution.covariance_order)
    at.push_back(find_parameter(*robot, name));
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
  C(at, at) = solution.covariance;
  EndpointQuestion question;
  question.robot = robot.get();
  question.xi = solution.values;
  question.unseen = Eigen::MatrixXd(6, 0);
  question.poses = workspace_poses(*robot, solution.values, {}, session.data.rows.q, 500, 1);
  ASSERT_FALSE(solution.workspace.aligned);
  EXPECT_NEAR(endpoint_sigma(endpoint_deviations(question), C).rms / solution.workspace.rms, 1,
              1e-6);
  for (const Correlation& each : solution.uncertainty.correlations) {
    const int a = find_parameter(*robot, each.a), b = find_parameter(*robot, each.b);
    EXPECT_GT(std::abs(each.value), 0.9);
    EXPECT_NEAR(each.value, C(a, b) / std::sqrt(C(a, a) * C(b, b)), 1e-9) << each.a << each.b;
  }
}

TEST(Uncertainty, IsOfHowTheEndIsTurnedWhereTheRowsSeeIt) {
  const auto robot = robot_of(kRx90);
  for (const bool seen : {true, false}) {
    Random random(7);
    const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
    const Node node = entry({{"method", seen ? "location" : "position"}});
    const Session session = make_session(*robot, truth, {{"arm", node, 120}}, 20e-6, random);
    const Solution solution = identify(*robot, session.data);
    EXPECT_EQ(solution.orientation_seen, seen);
    EXPECT_EQ(solution.verdict.why.find(" mrad (over the whole") != std::string::npos, seen)
        << solution.verdict.why;
    if (!seen) continue;
    const Eigen::MatrixXd q =
        workspace_poses(*robot, solution.values, {}, session.data.rows.q, 300, 1);
    double squares = 0;
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const Eigen::Matrix3d turned = locate(*robot, truth, q.row(i).transpose()).R.transpose() *
                                     locate(*robot, solution.values, q.row(i).transpose()).R;
      squares += std::pow(Eigen::AngleAxisd(turned).angle(), 2);
    }
    const double error = std::sqrt(squares / static_cast<double>(q.rows()));
    // Of one draw of some thirty directions: within a factor of two either way.
    EXPECT_LT(error, 2 * solution.workspace.angle);
    EXPECT_GT(error, 0.5 * solution.workspace.angle);
  }
}

TEST(Uncertainty, HasTheResolutionOfTheEncodersAndWhatRepeatsShowInItsBudget) {
  const auto robot = robot_of(kRx90);
  Random random(4);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  Session session = repeated(*robot, truth, 150, random);
  const Solution fine = identify(*robot, session.data);
  EXPECT_EQ(budget(fine, "resolution of the encoders"), 0);
  // Rows scatter by their repeats alone: all of the noise is theirs.
  EXPECT_GT(budget(fine, "repeatability, from repeats"), 2 * budget(fine, "noise of the rows"));
  constexpr double kStep = 2e-4;
  session.data.rows.q = (session.data.rows.q / kStep).array().round().matrix() * kStep;
  const Solution coarse = identify(*robot, session.data);
  // Half a metre from the joints 0.2 mrad / sqrt(12) is 0.03 mm and more, over noise of 0.02 mm.
  EXPECT_GT(budget(coarse, "resolution of the encoders"),
            budget(coarse, "repeatability, from repeats"));
  EXPECT_GT(budget(coarse, "resolution of the encoders"), budget(coarse, "noise of the rows"));
}

TEST(Uncertainty, IsGreaterWhereAControllerTakesItsUsualParametersAlone) {
  const auto robot = robot_of(kRx90);
  Random random(9);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  const Session session = make_session(*robot, truth, tracked(150), 20e-6, random);
  const Solution solution = identify(*robot, session.data);
  const ControllerSigma takes = controller_sigma(*robot, session.data, solution);
  EXPECT_LT(takes.parameters.size(), robot->parameters().size() - 6);
  EXPECT_NEAR(takes.sigma, std::hypot(takes.left, solution.workspace.rms), 1e-12);
  // Axes askew by a milliradian, a metre from the tool, are what it cannot follow.
  EXPECT_GT(takes.left, 0.1e-3);
  EXPECT_LT(takes.left, 5e-3);
  // A robot that is off in what it takes alone is followed to the end.
  Solution simple = solution;
  simple.values = nominal_values(*robot);
  for (const std::string& name : takes.parameters)
    simple.values[find_parameter(*robot, name)] += 1e-3;
  EXPECT_LT(controller_sigma(*robot, session.data, simple).left, 1e-7);
}

}  // namespace
}  // namespace selfcal::recovery
