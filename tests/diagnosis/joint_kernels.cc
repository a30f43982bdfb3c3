// Structure of no known cause at one joint.
#include "diagnosis/evidence/joint_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

namespace selfcal {
namespace {

TEST(JointKernels, AreSmoothInOneReadingAndInTwo) {
  Eigen::MatrixXd q(2, 3);
  q << 0.1, 0.2, -0.4, 1.1, 0.2, 1.6;
  const Eigen::MatrixXd F = smooth_in_two_readings(q);
  // Over 2 rad: the readings are a half, nothing and one whole length apart.
  const double a = (1 + std::exp(-1 / 8.0)) / 2, b = 1, c = (1 + std::exp(-1 / 2.0)) / 2;
  EXPECT_NEAR((F * F.transpose())(0, 1), (a * b + a * c + b * c) / 3, 1e-12);
  EXPECT_NEAR((F * F.transpose())(0, 0), 1, 1e-12);
}

TEST(JointKernels, StepAndBendOverARadian) {
  // 24 knots: 0.1 rad from one to the next.
  const Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(24, -1.15, 1.15);
  const Eigen::MatrixXd F = kinked_in_reading(q), K = F * F.transpose();
  for (Eigen::Index i = 0; i < K.rows(); ++i)
    for (Eigen::Index j = 0; j < K.cols(); ++j)
      EXPECT_NEAR(K(i, j), std::exp(-std::abs(q[i] - q[j])), 1e-12);
  const Eigen::MatrixXd stands = kinked_in_reading(Eigen::VectorXd::Constant(3, 0.7));
  EXPECT_NEAR((stands * stands.transpose())(0, 2), 1, 1e-12);
}

TEST(JointKernels, AreTheSameATurnLater) {
  Eigen::VectorXd q(4);
  q << 0.3, 0.3 + 2 * std::numbers::pi, 0.8, 3.3;
  const Eigen::MatrixXd F = periodic_in_reading(q), K = F * F.transpose();
  EXPECT_NEAR(K(0, 1), K(0, 0), 1e-12);
  for (Eigen::Index i = 0; i < 4; ++i)
    for (Eigen::Index j = 0; j < 4; ++j)
      EXPECT_NEAR(K(i, j), std::exp(4 * (std::cos(q[i] - q[j]) - 1)), 3e-3);
}

/// Three rows of two joints; the second equation is of no row.
struct Rows {
  Rows() {
    data.q.resize(3, 2);
    data.q << 0.1, 0.4, 0.5, 0.3, 0.9, -0.8;
    rows.row = {0, -1, 2};
    errors.readings.by_joint.resize(3, 2);
    errors.readings.by_joint << 3, 0, 7, 0, 4, 5;
    errors.alike = data.q;
  }
  std::set<std::pair<KernelDomain, int>> kinds() const {
    std::set<std::pair<KernelDomain, int>> all;
    for (const JointKernel& each : joint_kernels(data, rows, errors))
      all.insert({each.domain, each.joint});
    return all;
  }
  Observations data;
  DenseEquations rows;
  JointErrors errors;
};

TEST(JointKernels, AreThoseThatTheRowsCanShow) {
  Rows of;
  using enum KernelDomain;
  const std::set<std::pair<KernelDomain, int>> plain = {
      {turned, 0}, {turned, 1}, {kinked, 0}, {kinked, 1}};
  EXPECT_EQ(of.kinds(), plain);
  of.data.temperature = Eigen::VectorXd::Constant(3, 21);
  EXPECT_EQ(of.kinds(), plain) << "it stays as warm as it is";
  of.data.temperature << 20, std::numeric_limits<double>::quiet_NaN(), 26;
  of.errors.by_load = Eigen::MatrixXd::Zero(3, 2);
  of.errors.by_load.col(1).setOnes();
  std::set<std::pair<KernelDomain, int>> all = plain;
  all.insert({{load, 1}, {warmth, 0}, {warmth, 1}});
  EXPECT_EQ(of.kinds(), all);
  of.errors.readings.by_joint.col(0).setZero();
  std::erase_if(all, [](const auto& each) { return each.second == 0; });
  EXPECT_EQ(of.kinds(), all) << "a joint that moves nothing";
}

TEST(JointKernels, AreWhatTheJointMovesOfMeanSquareOne) {
  Rows of;
  of.data.temperature.resize(3);
  of.data.temperature << 20, 23, 26;
  of.errors.by_load = Eigen::MatrixXd::Zero(3, 2);
  of.errors.by_load.col(0) << 2, 5, 3;
  const auto list = joint_kernels(of.data, of.rows, of.errors);
  const auto kernel = [&](KernelDomain domain) -> Eigen::MatrixXd {
    const auto found = std::ranges::find_if(
        list, [&](const JointKernel& each) { return each.domain == domain && each.joint == 0; });
    return found->root * found->root.transpose();
  };
  // (3, 7, 4) over its root mean square; the equation of no row has no reading.
  const double square = (9 + 49 + 16) / 3.0;
  const Eigen::MatrixXd kinked = kernel(KernelDomain::kinked);
  EXPECT_NEAR(kinked(0, 2), 12 / square * std::exp(-0.8), 1e-12);
  EXPECT_EQ(kinked(1, 1), 0);
  // What the load does alike at each reading is a spring's: the kernel less its mean over a turn.
  const Eigen::MatrixXd load = kernel(KernelDomain::load);
  const double mean = std::cyl_bessel_i(0, 4.0) * std::exp(-4.0);
  EXPECT_NEAR(load(0, 2), 6 / ((4 + 25 + 9) / 3.0) * (std::exp(4 * (std::cos(0.8) - 1)) - mean),
              3e-3);
  // 20 and 26 degrees are one spread below and above their mean.
  const Eigen::MatrixXd warm = kernel(KernelDomain::warmth);
  EXPECT_NEAR(warm(0, 2), -12 / ((9 + 16) / 3.0) * (std::exp(4 * (std::cos(0.8) - 1)) - mean),
              5e-3);
}

TEST(JointKernels, HaveBothReadingsOfAnEquationOfTwoRows) {
  Rows of;
  of.errors.before = {-1, -1, 1};  // row 1, which has no equation of its own
  of.errors.by_before = Eigen::MatrixXd::Zero(3, 2);
  of.errors.by_before(2, 0) = -6;
  const auto list = joint_kernels(of.data, of.rows, of.errors);
  const auto found = std::ranges::find_if(list, [](const JointKernel& each) {
    return each.domain == KernelDomain::kinked && each.joint == 0;
  });
  ASSERT_NE(found, list.end());
  const Eigen::MatrixXd K = found->root * found->root.transpose();
  // 4 in all: 10 of the third row, at 0.9 rad, and -6 of the second, at 0.5; the first one's is 3,
  // at 0.1. Between knots, a 23rd of 0.8 rad apart, the kernel is straight.
  const double square = (9 + 49 + 100 + 36) / 3.0;
  EXPECT_NEAR(K(0, 2), 3 * (10 * std::exp(-0.8) - 6 * std::exp(-0.4)) / square, 1e-3);
  EXPECT_NEAR(K(2, 2), (100 + 36 - 120 * std::exp(-0.4)) / square, 1e-2);
  EXPECT_EQ(K(1, 1), 0);
}

}  // namespace
}  // namespace selfcal
