// Where a touched ball of known radius is looked for.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <string>

#include "constraints/methods/data_set.h"

namespace selfcal {
namespace {

// A cap of 9 degrees about its top, 0.6 mm high: of points that are off by a quarter of a
// millimetre, as a robot's are before calibration, a ball of any radius is far off in half.
TEST(BallOfKnownRadius, IsFoundBehindASmallPartOfItThatWasTouched) {
  Problems problems;
  Node entry = Node::map();
  entry.set("method", Node::of(std::string("sphere"))).set("radius", Node::of(0.05));
  const Set ball = make_set("ball", entry, problems);
  ASSERT_FALSE(problems.any()) << problems.list.front();
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  int far = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector3d centre(0.6, -0.2, 0.3);
    const Eigen::Vector3d top =
        Eigen::Vector3d::NullaryExpr([&] { return normal(random); }).normalized();
    std::vector<Location> X;
    for (int i = 0; i < 6; ++i) {
      Location at;
      const Eigen::Vector3d aside = Eigen::Vector3d::NullaryExpr([&] { return normal(random); });
      at.p = centre + 0.05 * (top + 0.15 * aside.cross(top).normalized()).normalized();
      at.p += 0.25e-3 * Eigen::Vector3d::NullaryExpr([&] { return normal(random); });
      X.push_back(at);
    }
    X.front().p = centre + 0.05 * top;
    std::vector<int> rows(X.size());
    std::iota(rows.begin(), rows.end(), 0);
    const Eigen::VectorXd own = ball.method->start(X, rows, {}, nullptr, {});
    far += (own.head<3>() - centre).norm() > 0.02;
    EXPECT_EQ(own[3], 0.05);
  }
  EXPECT_LE(far, 5);
}

}  // namespace
}  // namespace selfcal
