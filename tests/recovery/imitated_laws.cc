// What a machine or an instrument does that no geometry has, geometry imitates in part: is the end
// position still as near the truth as is stated? It is honest within twice that.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <vector>

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
  double error = 0;    ///< over what is stated over the whole range
  double without = 0;  ///< over that less the laws' share of it in the workspace
  /// Parts of what is stated in the workspace (m).
  double of_laws = 0, of_time = 0, of_noise = 0;
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
  Told told;
  for (const BudgetLine& line : solution.uncertainty.budget) {
    if (line.source == kImitatedLaws) told.of_laws = line.sigma;
    if (line.source == kSharedErrors) told.of_time = line.sigma;
    if (line.source == kNoiseOfRows) told.of_noise = line.sigma;
  }
  told.error = std::sqrt(squares) / solution.endpoint.rms;
  told.without = told.error / std::sqrt(1 - std::pow(told.of_laws / solution.workspace.rms, 2));
  return told;
}

class ImitatedLaws : public testing::TestWithParam<Law> {};

TEST_P(ImitatedLaws, LeaveTheEndPositionAsNearAsStated) {
  int honest = 0, without = 0;
  std::vector<double> ratios;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Told each = told(GetParam(), seed);
    honest += each.error < GetParam().honest;
    without += each.without < GetParam().honest;
    ratios.push_back(each.error);
  }
  std::ranges::sort(ratios);
  std::printf("%s: %d of %d honest, %d without that line; %.2f in the middle, worst %.2f\n",
              GetParam().name, honest, kSeeds, without, ratios[kSeeds / 2], ratios.back());
  EXPECT_EQ(honest, kSeeds);
  EXPECT_GT(ratios[kSeeds / 2], 0.4) << "more doubt than there is";
}

TEST(ImitatedLaw, IsSeenWhereHalvesInTimeSeeLittle) {
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Told sector = told(kSector, seed);
    EXPECT_GT(sector.of_laws, sector.of_noise) << seed;
    EXPECT_GT(sector.of_laws, sector.of_time) << seed;
  }
}

TEST(ImitatedLaw, IsNotSeenInNoise) {
  int seen = 0;
  for (int seed = 1; seed <= 2 * kSeeds; ++seed) {
    const Told noise = told({"nothing", [](Observations&, int) {}}, seed);
    seen += noise.of_laws > 0.5 * noise.of_noise;
    EXPECT_LT(noise.of_laws, 1.5 * noise.of_noise) << seed;
  }
  EXPECT_LE(seen, 2 * kSeeds / 4);
}

/// Each pose three times, by an error of its own besides: no law of the configuration.
TEST(ImitatedLaw, IsHardlySeenInWhatRepeatsShare) {
  double share = 0;  // of the squares that are stated
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Simulated simulated =
        made("robot: rx90.robot.yaml\nseed: " + std::to_string(seed) +
             "\nerrors: {length: 0.5e-3, angle: 0.5e-3}\n"
             "sets: {tracker: {method: position, noise_true: 2.0e-4, rows: 100}}\n");
    std::vector<int> thrice;
    for (int row = 0; row < 100; ++row) thrice.insert(thrice.end(), 3, row);
    Observations& rows = simulated.data.rows;
    rows = taken(rows, thrice);
    rows.repeat = thrice;
    Random random(static_cast<unsigned long long>(seed));
    std::normal_distribution<double> noise(0, 2e-5);
    for (double& each : rows.position.reshaped()) each += noise(random);
    const Solution solution = identify(rx90(), simulated.data);
    double of_laws = 0;
    for (const BudgetLine& line : solution.uncertainty.budget)
      if (line.source == kImitatedLaws) of_laws = line.sigma;
    share += std::pow(of_laws / solution.workspace.rms, 2) / kSeeds;
  }
  EXPECT_LT(share, 0.25);
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
