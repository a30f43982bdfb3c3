// Which sets of causes a search visits.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <string>

#include "diagnosis/evidence/evidence_evaluator.h"

namespace selfcal {
namespace {

constexpr int kRows = 90;

/// Noise alone, and structure that neighbours share.
std::vector<DiscrepancyCovariance> noise_and_structure() {
  std::vector<std::vector<int>> alone;
  for (int i = 0; i < kRows; ++i) alone.push_back({i});
  DiscrepancyCovariance noise;
  noise.blocks = std::make_shared<const NoiseBlocks>(alone, [](int, int) { return 1.0; });
  std::vector<int> all(kRows);
  std::iota(all.begin(), all.end(), 0);
  std::vector<DiscrepancyCovariance> list = {noise};
  for (const double kappa : {1.0, 2.0, 4.0}) {
    DiscrepancyCovariance shared = {.kind = 1, .kappa = kappa, .probability = 1.0 / 3};
    shared.blocks =
        std::make_shared<const NoiseBlocks>(std::vector<std::vector<int>>{all}, [&](int i, int j) {
          const double apart = (i - j) / 4.0;
          return kappa * kappa * std::exp(-apart * apart / 2) + (i == j ? 1 : 0);
        });
    list.push_back(shared);
  }
  return list;
}

// As long as one of two causes is missing, its share is structure: every single cause is more
// probable beside structure than without. The two together need none.
TEST(Search, VisitsSetsWithoutTheStructureThatTheirPartsNeeded) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  Whitened rows;
  constexpr int kCauses = 20;
  rows.A = Eigen::MatrixXd::Ones(kRows, 1);
  rows.weight = rows.pull = Eigen::VectorXd::Zero(1);
  rows.C.resize(kRows, kCauses);
  for (double& each : rows.C.reshaped()) each = normal(random);
  for (int i = 0; i < kRows; ++i) {
    rows.C(i, 0) = i < kRows / 2 ? -1 : 1;
    rows.C(i, 1) = std::sin(2 * std::numbers::pi * i / 25);
  }
  rows.y = 3 * rows.C.col(0) + 3 * rows.C.col(1);
  for (double& each : rows.y) each += normal(random);
  Candidates all;
  std::vector<EffectParameter> parameters;
  for (int c = 0; c < kCauses; ++c) {
    all.list.push_back({.effect = "cause" + std::to_string(c), .at = "j1", .main = {c}});
    parameters.push_back({"c", "rad", 1, 4});
  }
  const EvidenceEvaluator evaluator(rows, noise_and_structure(), all, parameters,
                                    SearchRule{.noise_is_known = true});
  const Posterior posterior = evaluator.search();
  EXPECT_GT(posterior.family.at("cause0"), 0.99);
  EXPECT_GT(posterior.family.at("cause1"), 0.99);
  EXPECT_LT(posterior.unknown, 0.1);
  const Hypothesis& best = posterior.hypotheses.front();
  EXPECT_EQ(best.candidates, (std::vector{0, 1}));
  EXPECT_EQ(best.structure, 0);
  EXPECT_NEAR(best.sizes[0], 2.83, 1.5) << "about three times the noise";
}

/// Random columns, smooth over the rows in `smooth` of them, and what so many of the first add up
/// to beside noise; those of one joint each, all of one family or each of its own.
struct Many {
  Many(int smooth, bool one_family) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    rows.A = Eigen::MatrixXd::Ones(kRows, 1);
    rows.weight = rows.pull = Eigen::VectorXd::Zero(1);
    rows.C.resize(kRows, 20);
    for (double& each : rows.C.reshaped()) each = normal(random);
    for (int c = 0; c < smooth; ++c)
      for (int i = 0; i < kRows; ++i)
        rows.C(i, c) = std::sin(2 * std::numbers::pi * i * (c + 2) / kRows + c);
    rows.y = 3 * rows.C.leftCols(smooth).rowwise().sum();
    for (double& each : rows.y) each += normal(random);
    for (int c = 0; c < rows.C.cols(); ++c) {
      all.list.push_back({.effect = one_family ? "gears" : "cause" + std::to_string(c),
                          .at = "j" + std::to_string(c),
                          .main = {c}});
      parameters.push_back({"c", "rad", 1, 4});
    }
  }

  Posterior search() const {
    return EvidenceEvaluator(rows, noise_and_structure(), all, parameters,
                             SearchRule{.noise_is_known = true})
        .search();
  }

  Whitened rows;
  Candidates all;
  std::vector<EffectParameter> parameters;
};

TEST(Search, GoesOnToAllJointsThatHaveWhatThreeHave) {
  const Posterior posterior = Many(6, true).search();
  EXPECT_EQ(posterior.hypotheses.front().candidates, (std::vector{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(posterior.hypotheses.front().structure, 0);
  EXPECT_LT(posterior.unknown, 0.05);
  for (int c = 0; c < 6; ++c)
    EXPECT_GT(posterior.cause.at({"gears", "j" + std::to_string(c)}), 0.9) << c;
}

TEST(Search, PutsNoMoreThanThreeFamiliesTogether) {
  const Posterior posterior = Many(6, false).search();
  EXPECT_LE(posterior.hypotheses.front().candidates.size(), 3U);
  EXPECT_GT(posterior.unknown, 0.95);
}

TEST(Search, GoesOnToNoSpringThatWouldPush) {
  Many springs(6, true);
  for (EffectParameter& each : springs.parameters) each.positive = true;
  EXPECT_EQ(springs.search().hypotheses.front().candidates.size(), 6U);
  springs.rows.y -= 6 * springs.rows.C.col(4);
  const Posterior posterior = springs.search();
  EXPECT_GT(posterior.unknown, 0.95);
  EXPECT_LE(posterior.hypotheses.front().candidates.size(), 3U);
}

TEST(Search, PrefersWhatAMachineCanHave) {
  // Two columns nearly alike, one of which would need forty times the usual largest.
  Many two(1, false);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  two.rows.C.col(1) = 0.02 * two.rows.C.col(0);
  for (double& each : two.rows.C.col(1)) each += 2e-4 * normal(random);
  two.rows.y = 160 * two.rows.C.col(1);
  for (double& each : two.rows.y) each += 0.1 * normal(random);
  EXPECT_EQ(two.search().hypotheses.front().candidates, (std::vector{0}));
  // What may be moved as far as one likes may be that large.
  two.all.list[1].effect = "tool_shift";
  EXPECT_EQ(two.search().hypotheses.front().candidates, (std::vector{1}));
}

}  // namespace
}  // namespace selfcal
