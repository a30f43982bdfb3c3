#include "constraints/equations/shared_touches.h"

#include <gtest/gtest.h>

#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

TEST(SharedTouches, AreMadeIndependentAsTheCholeskyFactorOfTheirCorrelationDoes) {
  constexpr int kSuccessive = 5;
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(kSuccessive, kSuccessive);
  for (int i = 1; i < kSuccessive; ++i) correlation(i, i - 1) = correlation(i - 1, i) = -0.5;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Identity(kSuccessive, kSuccessive);
  SharedTouches shared;
  for (int i = 0; i < kSuccessive; ++i) shared.whiten(i + 1, i, rows.row(i));
  const Eigen::MatrixXd wanted =
      solve_lower(cholesky_root(correlation), Eigen::MatrixXd::Identity(kSuccessive, kSuccessive));
  EXPECT_TRUE(rows.isApprox(wanted, 1e-14)) << rows << "\n\n" << wanted;
}

TEST(SharedTouches, BeginAnewBehindARowThatWasPutAside) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Identity(3, 3);
  rows.row(1).setZero();
  SharedTouches shared;
  for (int i = 0; i < 3; ++i) shared.whiten(i + 1, i, rows.row(i));
  EXPECT_EQ(rows(2, 2), 1);
  EXPECT_TRUE(rows.row(1).isZero(0));
}

TEST(SharedTouches, OfOtherChainsStayApart) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Identity(2, 2);
  SharedTouches shared;
  shared.whiten(1, 0, rows.row(0));
  shared.whiten(11, 10, rows.row(1));
  EXPECT_TRUE(rows.isIdentity(0));
}

}  // namespace
}  // namespace selfcal
