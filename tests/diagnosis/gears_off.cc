// Gear ratios that the robot's file has wrongly.
#include "diagnosis/search/gears_off.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

namespace selfcal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Key;

constexpr int kRows = 120;
constexpr double kMoves = 1e4;  // sigmas, that a ratio off by one moves a row whose reading is one

/// A mean and the ratios of two gears, held within 1e-5 of theirs, of which the first has one of a
/// hundred; beside two causes: one that looks much like that ratio, and another. One column more
/// says nothing.
struct Session {
  Whitened rows;
  Eigen::VectorXd gear{kRows}, second{kRows}, alike{kRows}, other{kRows};
  Candidates all;
  std::vector<EffectParameter> parameters;

  Session() {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    for (int i = 0; i < kRows; ++i) {
      const double reading = 3.0 * i / kRows - 1.5;
      gear[i] = reading;
      alike[i] = std::sin(reading);
      second[i] = 0.3 * reading + normal(random);
      other[i] = normal(random);
    }
    rows.A.resize(kRows, 4);
    rows.A << Eigen::VectorXd::Ones(kRows), kMoves / 100 * gear, kMoves * second,
        Eigen::VectorXd::Zero(kRows);
    rows.weight = Eigen::Vector4d(0, 1e3, 1e5, 1);
    rows.pull = Eigen::Vector4d(0, 0.5, -0.5, 0);
    rows.C.resize(kRows, 2);
    rows.C << alike, other;
    rows.y.resize(kRows);
    for (double& each : rows.y) each = normal(random);
    for (int c = 0; c < 2; ++c) {
      all.list.push_back({.effect = "cause" + std::to_string(c), .at = "j1", .main = {c}});
      parameters.push_back({"c", "rad", 1, 4});
    }
  }

  /// Where the causes `found` were named.
  std::map<std::string, double> off(const std::vector<int>& found) const {
    std::vector<std::vector<int>> alone;
    for (int i = 0; i < kRows; ++i) alone.push_back({i});
    DiscrepancyCovariance noise;
    noise.blocks = std::make_shared<const NoiseBlocks>(alone, [](int, int) { return 1.0; });
    const EvidenceEvaluator evaluator(rows, {noise}, all, parameters, {});
    Posterior posterior;
    posterior.hypotheses = {{found, 0, 0, std::vector<double>(found.size(), 4)}};
    return gears_off({{1, "K1", 100}, {2, "K2", 1}}, evaluator, posterior);
  }
};

TEST(GearsOff, AreNoneInNoise) {
  const Session session;
  EXPECT_THAT(session.off({}), IsEmpty());
  EXPECT_THAT(session.off({1}), IsEmpty());
}

TEST(GearsOff, AreThoseBesideNoCauseAndBesideAnother) {
  Session session;
  session.rows.y += 5e-4 * kMoves * session.gear;
  EXPECT_THAT(session.off({}), ElementsAre(Key("K1")));
  session.rows.y += 4 * session.other;
  EXPECT_THAT(session.off({1}), ElementsAre(Key("K1")));
}

TEST(GearsOff, TakeThePlaceOfTheCauseThatLooksLikeThem) {
  Session session;
  session.rows.y += 5e-4 * kMoves * session.gear;
  EXPECT_THAT(session.off({0}), ElementsAre(Key("K1")));
}

TEST(GearsOff, AreNoneWhereTheCauseIsThereThatLooksLikeThem) {
  Session session;
  session.rows.y += 5 * session.alike;
  EXPECT_THAT(session.off({0}), IsEmpty());
}

}  // namespace
}  // namespace selfcal
