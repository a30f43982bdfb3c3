// Waves too fine to be asked for one by one, that what is left hints at.
#include "diagnosis/evidence/fine_waves.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace selfcal {
namespace {

using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

/// 120 readings of -1.5 to 1.5 rad, what an error of each moves its equation, and noise of one.
struct Left {
  Eigen::VectorXd q{120}, by{120}, left{120};

  explicit Left(unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> reading(-1.5, 1.5), lever(0.2, 1);
    std::normal_distribution<double> normal;
    for (double& each : q) each = reading(random);
    for (double& each : by) each = lever(random);
    for (double& each : left) each = normal(random);
  }

  void add(double waves, double size) {
    left.array() += size * by.array() * (waves * q.array() + 0.4).sin();
  }
};

TEST(FineWaves, AreThoseOfAGearAndOfTwiceItsTurn) {
  Left rows(3);
  rows.add(110, 4);
  rows.add(220, 3);
  rows.add(2, 3);  // few enough to be asked for by itself
  EXPECT_THAT(fine_waves(rows.q, rows.by, rows.left), UnorderedElementsAre(110, 220));
}

// One in a hundred data sets may show some: two of 200, with three sigma of that six.
TEST(FineWaves, AreNoneInNoise) {
  int some = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Left rows(seed);
    if (!fine_waves(rows.q, rows.by, rows.left).empty()) ++some;
  }
  EXPECT_LE(some, 6);
}

TEST(FineWaves, AreNoneWhereNothingIsLeftOrNothingMoves) {
  Left rows(1);
  rows.add(110, 4);
  EXPECT_THAT(fine_waves(rows.q, Eigen::VectorXd::Zero(120), rows.left), IsEmpty());
  EXPECT_THAT(fine_waves(rows.q, rows.by, Eigen::VectorXd::Zero(120)), IsEmpty());
  EXPECT_THAT(fine_waves({}, {}, {}), IsEmpty());
}

}  // namespace
}  // namespace selfcal
