// What a machine or an instrument does that no geometry has, geometry imitates in part: is the end
// position still as near the truth as is stated? It is honest within twice that.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "constraints/estimation/identification.h"
#include "tests/sim/simulated_robot.h"
#include "tests/support/end_position.h"

namespace selfcal::recovery {
namespace {

constexpr int kSeeds = 10;
/// A law that the model lacks.
struct Law {
  const char* name;
  std::function<void(Observations&, int row)> errs;
  double honest = 2;  ///< times what is stated that the true error is within
};

/// A sector of a gear that sits off the rest.
const Law kSector{"sector", [](Observations& rows, int row) {
                    if (rows.q(row, 1) > 0.3) rows.q(row, 1) += 3e-4;
                  }};

struct Told {
  double stated = 0, with_laws = 0;  ///< over the true error: without that line of the budget, with
};

Told told(const Law& law, int seed) {
  Simulated simulated = made("robot: rx90.robot.yaml\nseed: " + std::to_string(seed) +
                             "\nerrors: {length: 0.5e-3, angle: 0.5e-3}\n"
                             "sets: {tracker: {method: position, noise: 2.0e-5, rows: 150}}\n");
  Observations& rows = simulated.data.rows;
  for (int row = 0; row < rows.rows(); ++row) law.errs(rows, row);
  const Solution solution = identify(rx90(), simulated.data);
  double squares = 0;
  const std::vector<double> errors = aligned_errors(rx90(), solution.values, simulated.truth.xi);
  for (const double each : errors) squares += each * each / static_cast<double>(errors.size());
  double of_laws = 0;
  for (const BudgetLine& line : solution.uncertainty.budget)
    if (line.source == kImitatedLaws) of_laws = std::pow(line.sigma / solution.workspace.rms, 2);
  const double stated = solution.endpoint.rms / std::sqrt(squares);
  return {stated * std::sqrt(1 - of_laws), stated};
}

class ImitatedLaws : public testing::TestWithParam<Law> {};

TEST_P(ImitatedLaws, LeaveTheEndPositionAsNearAsStated) {
  int honest = 0, without = 0;
  double worst = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Told each = told(GetParam(), seed);
    honest += GetParam().honest * each.with_laws > 1;
    without += GetParam().honest * each.stated > 1;
    worst = std::max(worst, 1 / each.with_laws);
  }
  std::printf("%s: %d of %d honest, %d without that line; worst %.2f\n", GetParam().name, honest,
              kSeeds, without, worst);
  EXPECT_EQ(honest, kSeeds);
  EXPECT_GE(honest, without);
}

TEST(ImitatedLaw, IsSeenWhereHalvesInTimeSeeNothing) {
  int without = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) without += 2 * told(kSector, seed).stated > 1;
  EXPECT_LT(without, kSeeds);
}

INSTANTIATE_TEST_SUITE_P(
    Of, ImitatedLaws,
    testing::Values(Law{"nothing", [](Observations&, int) {}},
                    Law{"gear",
                        [](Observations& rows, int row) {
                          rows.q(row, 1) += 4e-4 * std::sin(3 * rows.q(row, 1) + 0.3);
                        }},
                    kSector,
                    Law{"beam",
                        [](Observations& rows, int row) {
                          const Eigen::Vector3d p = rows.position.row(row);
                          rows.position(row, 2) -= 6e-4 * p.head<2>().squaredNorm();
                        }},
                    // Most of these two is a zero and a scale, which nothing in the rows tells.
                    Law{"coupling",
                        [](Observations& rows, int row) {
                          rows.q(row, 2) += 3e-4 * rows.q(row, 1) * rows.q(row, 1);
                        },
                        3},
                    Law{"lens",
                        [](Observations& rows, int row) {
                          const Eigen::Vector3d p = rows.position.row(row);
                          rows.position.row(row) += 6e-4 * p.squaredNorm() * p.transpose();
                        },
                        3}),
    [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace selfcal::recovery
