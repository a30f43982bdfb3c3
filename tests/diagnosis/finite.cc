// Evidence that is no number.
#include <gtest/gtest.h>

#include <random>

#include "diagnosis/evidence/evidence_evaluator.h"

namespace selfcal {
namespace {

/// Rows in which two causes do the same.
struct LookAlikes {
  LookAlikes() {
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal;
    rows.A.resize(40, 2);
    rows.C.resize(40, 2);
    rows.y.resize(40);
    for (double& each : rows.A.reshaped()) each = normal(random);
    for (double& each : rows.C.col(0)) each = normal(random);
    rows.C.col(1) = rows.C.col(0);
    for (double& each : rows.y) each = normal(random);
    rows.y += 2 * rows.C.col(0);
    rows.weight = rows.pull = Eigen::VectorXd::Zero(2);
    all.list = {{.effect = "usual", .at = "j1", .main = {0}},
                {.effect = "huge", .at = "j1", .main = {1}}};
    std::vector<std::vector<int>> alone;
    for (int i = 0; i < 40; ++i) alone.push_back({i});
    noise.blocks = std::make_shared<const NoiseBlocks>(alone, [](int, int) { return 1.0; });
  }
  EvidenceEvaluator evaluator() const {
    return {rows, {noise}, all, parameters, SearchRule{.noise_is_known = true}};
  }
  Whitened rows;
  Candidates all;
  std::vector<EffectParameter> parameters = {{"c", "rad", 1, 4}, {"c", "rad", 1e-3, 4e-3}};
  DiscrepancyCovariance noise;
};

TEST(EvidenceDeathTest, OfRowsThatOverflowIsToldAsABug) {
  LookAlikes both;
  both.rows.y *= 1e200;
  EXPECT_DEATH(both.evaluator().search(), "the evidence of finite rows is finite");
}

}  // namespace
}  // namespace selfcal
