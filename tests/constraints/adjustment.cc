// Wherever the fits set out from, they end in one place.
#include "constraints/estimation/adjustment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

constexpr double kSame = 1e-3;  // sigma

struct Adjustments : testing::Test {
  const Simulated simulated = made(
      "robot: rx90.robot.yaml\nseed: 3\nerrors: {length: 1.0e-3, angle: 1.0e-3}\n"
      "sets: {tracker: {method: position, rows: 90, noise: 2.0e-5}}\n");
  const Equations equations{rx90(), simulated.data, Use::fit};
  const Adjusted makers = adjust(equations, {}, {});

  /// From where the maker's figures lead to; the largest in their sigmas.
  double off(const Fit& fitted) const {
    const Eigen::VectorXd sigma = makers.fitted.covariance.diagonal().cwiseSqrt();
    double most = 0;
    for (Eigen::Index i = 0; i < fitted.state.xi.size(); ++i)
      if (sigma[i] > 0)
        most = std::max(most, std::abs(fitted.state.xi[i] - makers.fitted.state.xi[i]) / sigma[i]);
    return most;
  }
};

TEST_F(Adjustments, EndWhereTheyDoFromTheMakersFigures) {
  ASSERT_TRUE(makers.fitted.converged);
  State near = makers.fitted.state;
  const Adjusted again = adjust(equations, {}, {}, &near);
  EXPECT_EQ(again.before.iterations, 0);
  EXPECT_LT(again.fitted.iterations, makers.fitted.iterations);
  EXPECT_LT(off(again.fitted), kSame);
  const Eigen::VectorXd sigma = makers.fitted.covariance.diagonal().cwiseSqrt();
  near.xi += 3 * sigma.head(near.xi.size());
  EXPECT_LT(off(adjust(equations, {}, {}, &near).fitted), kSame);
}

TEST_F(Adjustments, SetOutFromTheMakersFiguresWhereTheOtherLeadsNowhere) {
  State nowhere = makers.fitted.state;
  nowhere.xi.setConstant(std::numeric_limits<double>::quiet_NaN());
  const Adjusted again = adjust(equations, {}, {}, &nowhere);
  EXPECT_TRUE(again.fitted.converged);
  EXPECT_GT(again.before.iterations, 0);
  EXPECT_LT(off(again.fitted), kSame);
}

}  // namespace
}  // namespace selfcal
