// What the rows of each set leave, over what was fitted to them: the noise of the simulated
// machine.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "constraints/estimation/identification.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

/// Sets of `robots` simulated ones, every row of which identifies; root mean square of the noise
/// that is found of the first set (of one of its quantities), over the one that it has.
double noise_found(const std::string& sets, double noise, int robots,
                   double SetResult::*found = &SetResult::noise_sigma) {
  double squares = 0;
  for (int seed = 1; seed <= robots; ++seed) {
    const Simulated simulated =
        made("robot: rx90.robot.yaml\nseed: " + std::to_string(seed) +
             "\nerrors: {length: 1.0e-3, angle: 1.0e-3}\ncheck: 0\nsets:\n" + sets);
    const Solution solution = identify(rx90(), simulated.data);
    EXPECT_TRUE(solution.converged) << seed;
    squares += std::pow(solution.sets.front().*found / noise, 2) / robots;
  }
  return std::sqrt(squares);
}

TEST(NoiseOfSets, ThatAreMetExactlySaysNothingOfTheOthers) {
  // Three touches of an unknown plane leave nothing. The others have nine freedoms each, of which
  // the robot takes a few: some ten a robot, 3 sigma of a root mean square of 20 robots.
  const std::string few = ": {method: plane, noise_true: 1.0e-4, rows: 3}\n",
                    many = ": {method: plane, noise_true: 1.0e-4, rows: 12}\n";
  const double found =
      noise_found("  a" + many + "  b" + many + "  c" + few + "  d" + few + "  e" + few + "  f" +
                      few + "  tracker: {method: position, noise: 1.0e-4, rows: 15}\n",
                  1e-4, 20);
  EXPECT_NEAR(found, 1, 3 / std::sqrt(2 * 10 * 20.0));
}

TEST(NoiseOfSets, WithoutADataSheetAndFreedomsIsThatOfTheOthers) {
  const std::string few = ": {method: plane, noise_true: 1.0e-4, rows: 4}\n",
                    many = ": {method: plane, noise: 1.0e-4, rows: 30}\n",
                    tracker = "  tracker: {method: position, noise: 1.0e-4, rows: 30}\n";
  EXPECT_NEAR(noise_found("  few" + few + "  many" + many + tracker, 1e-4, 10), 1, 0.3);
  EXPECT_NEAR(noise_found("  few" + few + tracker, 1e-4, 10), 1, 0.3) << "of another method";
}

TEST(NoiseOfSets, WithSharedPointsIsEachOnesOwn) {
  // Of one kind, one of them twenty times as noisy. Half of the equations go into the points.
  const double found = noise_found(
      "  quiet: {method: position-constraint, noise_true: 2.0e-5, rows: 60, rows_per_group: 2}\n"
      "  loud: {method: position-constraint, noise_true: 4.0e-4, rows: 60, rows_per_group: 2}\n"
      "  tracker: {method: position, noise: 1.0e-3, rows: 10}\n",
      2e-5, 5);
  EXPECT_LT(found, 2);  // twenty, were it one noise for both
}

// Twenty locations of a robot with 40 unknowns: the lengths carry other ones than the angles do.
TEST(NoiseOfSets, OfLocationsIsThatOfLengthsAndThatOfAngles) {
  const std::string set =
      "  arm: {method: location, noise_true: 2.0e-5, noise_angle_true: 1.0e-4, rows: 20}\n";
  // Some 40 of the 60 scalars of each are left: 3 sigma of a root mean square of 30 robots.
  const double sigmas = 3 / std::sqrt(2 * 40 * 30.0);
  EXPECT_NEAR(noise_found(set, 2e-5, 30), 1, sigmas);
  EXPECT_NEAR(noise_found(set, 1e-4, 30, &SetResult::noise_angle_sigma), 1, sigmas);
}

}  // namespace
}  // namespace selfcal
