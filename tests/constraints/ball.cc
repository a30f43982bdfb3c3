// Where a touched ball of known radius is looked for.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <string>

#include "constraints/methods/data_set.h"

namespace selfcal {
namespace {

/// Of fifty caps of 9 degrees about a ball's top, 0.6 mm high, those behind which it is not found:
/// of points that are off by a quarter of a millimetre, as a robot's are before calibration, a ball
/// of any radius is far off in half.
int not_found(bool with_normals) {
  Problems problems;
  Node entry = Node::map();
  entry.set("method", Node::of(std::string("sphere"))).set("radius", Node::of(0.05));
  const Set ball = make_set("ball", entry, problems);
  EXPECT_FALSE(problems.any());
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
    Observations data;
    if (with_normals) data.normal.resize(static_cast<Eigen::Index>(X.size()), 3);
    for (const int row : rows)
      if (with_normals) data.normal.row(row) = (X[row].p - centre).normalized().transpose();
    const Eigen::VectorXd own = ball.method->start(X, rows, data, nullptr, {});
    far += (own.head<3>() - centre).norm() > 0.02;
    EXPECT_EQ(own[3], 0.05);
  }
  return far;
}

TEST(BallOfKnownRadius, IsFoundBehindASmallPartOfItThatWasTouched) {
  const int by_points = not_found(false);
  EXPECT_GT(by_points, 0) << "the points alone cannot tell in all";
  EXPECT_LE(by_points, 5);
}

TEST(BallOfKnownRadius, IsFoundByTheNormalsOfItsTouches) { EXPECT_EQ(not_found(true), 0); }

}  // namespace
}  // namespace selfcal
