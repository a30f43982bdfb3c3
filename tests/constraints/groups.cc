// Shared points of unknown place, where the robot turns as a whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "constraints/fitting/fit_system.h"
#include "constraints/methods/lone_groups.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

// Sockets tell nothing of the base. Turned back by 20 mrad, every point goes round a bend of a
// tenth of a millimetre and more, ten times the noise, which no step of all values at once takes.
TEST(SharedPoints, GoAlongWhereTheBaseTurnsFar) {
  const Simulated simulated = made(
      "robot: rx90.robot.yaml\nseed: 3\ncheck: 0\nsets:\n  tip: {method: position-constraint, "
      "noise_true: 1.0e-5, rows: 60, rows_per_group: 4}\n");
  const Robot& robot = rx90();
  const Equations equations(robot, simulated.data, Use::fit);
  Prior prior{simulated.truth.xi, Eigen::VectorXd(robot.parameters().size()), {}, true};
  for (const Parameter& p : robot.parameters()) {
    prior.sigma[static_cast<Eigen::Index>(prior.free.size())] = p.tolerance;
    prior.free.push_back(p.part == Part::base);
  }
  const auto base =
      static_cast<Eigen::Index>(std::ranges::find(prior.free, char{1}) - prior.free.begin());
  ASSERT_EQ(robot.parameters()[static_cast<std::size_t>(base)].quantity, Quantity::angle);
  State turned = simulated.truth;
  turned.xi[base] += 20e-3;
  equations.start(turned);
  FitSystem system(equations, prior, turned,
                   {{{1e-5, 1}}, std::vector<char>(simulated.data.rows.rows(), 0)});
  Eigen::VectorXd back = Eigen::VectorXd::Zero(equations.columns());
  ASSERT_TRUE(system.go(back)) << "the points as the rows have them";
  const double before = system.cost();
  back[base] = -20e-3;
  EXPECT_TRUE(system.go(back)) << before << " to " << system.tried().cost;
  // What was believed of the base is met again, and the rows as before.
  EXPECT_NEAR(before - system.cost(), std::pow(20e-3 / prior.sigma[base], 2), 0.2);
  EXPECT_GT(system.tried().cost, before) << "the step alone would not do";
}

TEST(SharedPoints, OfOneTouchAreNamedForTheyTellNothing) {
  DataSet data = made(
                     "robot: rx90.robot.yaml\nseed: 3\ncheck: 0\nsets:\n  tip: {method: "
                     "position-constraint, noise_true: 1.0e-5, rows: 12, rows_per_group: 4}\n")
                     .data;
  EXPECT_EQ(lone_groups(data, 0), "");
  data.rows.group[5] = static_cast<int>(data.sets[0].groups.size());
  data.sets[0].groups.push_back("fornt_1");
  EXPECT_THAT(lone_groups(data, 0),
              testing::StartsWith("set tip: too few rows at fornt_1 to tell anything"));
  data.rows.group[6] = data.rows.group[5];
  EXPECT_EQ(lone_groups(data, 0), "") << "two touches of one point tell something";
}

}  // namespace
}  // namespace selfcal
