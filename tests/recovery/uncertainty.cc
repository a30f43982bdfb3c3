// What a result says of its own doubt: parts that add up, tests that see what is no noise, and the
// doubt of what was given.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "constraints/estimation/half_samples.h"
#include "tests/recovery/rx90.h"

namespace selfcal::recovery {
namespace {

std::vector<SetPart> tracked(int rows) {
  return {{"tracker", entry({{"method", "position"}}), rows}};
}

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

double budget(const Solution& solution, const std::string& source) {
  for (const BudgetLine& line : solution.uncertainty.budget)
    if (line.source == source) return line.sigma;
  return -1;
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
  // 200 rows of three coordinates, of which 33 parameters are determined, some by their priors.
  EXPECT_NEAR(u.freedoms, 600 - 33, 12);
  EXPECT_EQ(u.lack_of_fit.repeat_freedoms, 300);
  EXPECT_GT(u.lack_of_fit.p_value, 0.001);
  EXPECT_GT(u.residuals.normality_p, 0.001);
  EXPECT_GT(u.residuals.autocorrelation_p, 0.001);
  EXPECT_EQ(u.repeats.poses, 150);
  // Two readings apart by sqrt(2) of their noise, each half of it from their mean.
  EXPECT_NEAR(u.repeats.repeatability, 60e-6, 40e-6);
  EXPECT_LT(u.repeats.accuracy, 100e-6);
  for (const GridCell& cell : u.grid) EXPECT_LT(cell.bias, 60e-6);
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

TEST(Uncertainty, HasTheDoubtOfAGivenPlaneInItUnlessItIsExact) {
  const auto robot = robot_of(kRx90);
  const auto sigma = [&](const char* tolerance) {
    Random random(5);
    const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
    std::vector<SetPart> parts;
    for (const Eigen::Vector3d& abc :
         {Eigen::Vector3d(0, 0, -5), Eigen::Vector3d(-2, 0, 0), Eigen::Vector3d(0, -2, 0)}) {
      Node node = entry({{"method", "plane"}});
      node.set("plane", Node::of(Eigen::VectorXd(abc)));
      Node tolerances = Node::map();
      if (*tolerance) {
        tolerances.set("place", Node::of(std::string(tolerance)));
        tolerances.set("turn", Node::of(std::string(tolerance)));
        node.set("tolerance", tolerances);
      }
      parts.push_back({"p" + std::to_string(parts.size()), node, 120});
    }
    const Session session = make_session(*robot, truth, parts, 20e-6, random);
    EXPECT_EQ(session.unreached, "");
    return identify(*robot, session.data);
  };
  const Solution exact = sigma("0"), silent = sigma(""), rough = sigma("1e-3");
  EXPECT_LT(budget(exact, "what was given"), 0.02e-3);
  EXPECT_GT(budget(silent, "what was given"), 2 * budget(exact, "what was given"));
  // A world that is given by planes is in doubt as they are: a millimetre each.
  EXPECT_GT(budget(rough, "what was given"), 0.5e-3);
  EXPECT_GT(rough.workspace.rms, budget(rough, "what was given"));
  EXPECT_TRUE(rough.values.isApprox(exact.values, 1e-9)) << "given is kept";
}

}  // namespace
}  // namespace selfcal::recovery
