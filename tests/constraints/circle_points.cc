// Axes from circle points: rotations of noisy markers with and without the polar step, an axis
// worked by hand, and what goes wrong by its name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "constraints/axes/turn_axis.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"
#include "tests/constraints/marker_noise.h"

namespace selfcal {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

Matrix3Xd about_the_centroid(const Matrix3Xd& markers) {
  return markers.colwise() - markers.rowwise().mean();
}

/// The nine numbers that bring `from` onto `to` by least squares, held to nothing.
Matrix3d linear_fit(const Matrix3Xd& from, const Matrix3Xd& to) {
  Matrix3d Q;
  for (int row = 0; row < 3; ++row)
    Q.row(row) = least_squares(from.transpose(), to.row(row).transpose()).transpose();
  return Q;
}

/// The orthogonal factor of Q by Newton's iteration (Higham 1986).
Matrix3d polar(Matrix3d Q) {
  for (int i = 0; i < 100; ++i) Q = (0.5 * (Q + Q.inverse().transpose())).eval();
  return Q;
}

struct MarkerErrors {
  double linear = 0, polar = 0, direct = 0;  ///< rms of the nine numbers over the trials
};

/// `flatness`: depth of the twelve markers over their breadth; `share`: noise over the extent.
MarkerErrors marker_errors(double flatness, double share) {
  constexpr int kTrials = 400, kMarkers = 12;
  Random random(7);
  MarkerErrors sum;
  for (int i = 0; i < kTrials; ++i) {
    Matrix3Xd from = marker_noise(kMarkers, 1, random);
    from.row(2) *= flatness;
    const Matrix3d Q = exp_rotation(marker_noise(1, 1, random).col(0));
    const Matrix3Xd to = Q * from + marker_noise(kMarkers, share, random);
    const Matrix3Xd a = about_the_centroid(from), b = about_the_centroid(to);
    const Matrix3d linear = linear_fit(a, b);
    sum.linear += (linear - Q).squaredNorm() / 9 / kTrials;
    sum.polar += (polar(linear) - Q).squaredNorm() / 9 / kTrials;
    sum.direct += (rotation_onto(a, b) - Q).squaredNorm() / 9 / kTrials;
  }
  return {std::sqrt(sum.linear), std::sqrt(sum.polar), std::sqrt(sum.direct)};
}

TEST(RotationOfMarkers, ThePolarStepFiltersNoiseOfTenPerCent) {
  for (const double share : {0.01, 0.1}) {
    const MarkerErrors e = marker_errors(1, share);
    // Of nine free numbers three are a rotation's: sqrt(3 / 9) of the noise is left, about.
    EXPECT_NEAR(e.polar / e.linear, std::sqrt(1.0 / 3), 0.12) << share;
    EXPECT_NEAR(e.linear, share / std::sqrt(12.0 - 1 - 3), 0.25 * share) << share;
    // Of markers as deep as broad, the direct fit is hardly better; it is never worse.
    EXPECT_LE(e.direct, e.polar) << share;
    EXPECT_GE(e.direct, 0.85 * e.polar) << share;
  }
}

TEST(RotationOfMarkers, OfFlatMarkersTheDirectFitAloneIsGood) {
  const MarkerErrors deep = marker_errors(1, 0.01), flat = marker_errors(0.02, 0.01);
  EXPECT_LT(flat.direct, 2 * deep.direct);
  EXPECT_GT(flat.linear, 10 * deep.linear);
  EXPECT_GT(flat.polar, 5 * flat.direct);
}

TEST(RotationOfMarkers, OfThreeMarkersTheDirectFitIsExact) {
  Matrix3Xd from(3, 3);
  from << 1, 0, -1, 0, 1, -1, 0, 0, 0;
  const Matrix3d Q = exp_rotation({0.3, -2, 0.5});
  EXPECT_LT((rotation_onto(from, Q * from) - Q).norm(), 1e-14);
}

/// Markers that turn about z through (1, 2): at 0, a right angle and, a turn on, two.
Turning by_hand() {
  Turning turning;
  turning.variable = Eigen::Vector3d(0, 0.5, 3) * std::numbers::pi;
  Matrix3Xd at(3, 3), quarter(3, 3), half(3, 3);
  at << 2, 1, 2, 2, 3, 3, 0, 0, 1;
  quarter << 1, 0, 0, 3, 2, 3, 0, 0, 1;
  half << 0, 1, 0, 2, 1, 1, 0, 0, 1;
  turning.markers = {at, quarter, half};
  return turning;
}

TEST(TurnAxisOfMarkers, IsTheOneWorkedByHand) {
  const TurnAxis axis = turn_axis(by_hand());
  EXPECT_EQ(axis.problem, "");
  EXPECT_LT((axis.e - Vector3d::UnitZ()).norm(), 1e-14);
  EXPECT_LT((axis.p - Vector3d(1, 2, 0)).norm(), 1e-14);
  EXPECT_LT(axis.off, 1e-14);
}

TEST(TurnAxisOfMarkers, TurnsRoundWithTheSignOfTheReading) {
  Turning turning = by_hand();
  turning.variable *= -1;
  EXPECT_LT((turn_axis(turning).e + Vector3d::UnitZ()).norm(), 1e-14);
}

/// Four markers about a metre from an axis through (1, 2, 0) along z, seen to `sigma` (m).
Turning seen(int rows, double sigma) {
  Random random(3);
  Matrix3Xd body(3, 4);
  body << 1, 0.6, 1.2, 0.8, 0, 0.4, -0.2, -0.5, 0, 0.1, 0.4, 0.2;
  Turning turning;
  turning.variable = Eigen::VectorXd::LinSpaced(rows, -2, 2);
  for (const double v : turning.variable)
    turning.markers.push_back(
        ((exp_rotation(v * Vector3d::UnitZ()) * body).colwise() + Vector3d(1, 2, 0)) +
        marker_noise(4, sigma, random));
  return turning;
}

/// As every two rows have it, one by one.
TurnAxis of_every_two(const Turning& turning) {
  const auto rows = static_cast<Eigen::Index>(turning.markers.size());
  TurnAxis axis;
  Vector3d sum = Vector3d::Zero();
  for (Eigen::Index k = 0; k < rows; ++k)
    for (Eigen::Index l = k + 1; l < rows; ++l) {
      const double sine = std::sin(turning.variable[l] - turning.variable[k]);
      const Matrix3d Q =
          rotation_onto(about_the_centroid(turning.markers[static_cast<std::size_t>(k)]),
                        about_the_centroid(turning.markers[static_cast<std::size_t>(l)]));
      sum += sine * Vector3d(Q(2, 1) - Q(1, 2), Q(0, 2) - Q(2, 0), Q(1, 0) - Q(0, 1));
      axis.weight += sine * sine;
    }
  axis.e = sum.normalized();
  Eigen::MatrixXd A(3 * rows * (rows - 1) / 2 + 1, 3);
  Eigen::VectorXd b(A.rows());
  Eigen::Index at = 0;
  for (Eigen::Index k = 0; k < rows; ++k)
    for (Eigen::Index l = k + 1; l < rows; ++l, at += 3) {
      const Matrix3d T = exp_rotation((turning.variable[l] - turning.variable[k]) * axis.e);
      A.middleRows<3>(at) = T - Matrix3d::Identity();
      b.segment<3>(at) = T * turning.markers[static_cast<std::size_t>(k)].rowwise().mean() -
                         turning.markers[static_cast<std::size_t>(l)].rowwise().mean();
    }
  A.bottomRows<1>() = axis.e.transpose();
  b[b.size() - 1] = 0;
  axis.p = least_squares(A, b);
  return axis;
}

TEST(TurnAxisOfMarkers, IsThatOfEveryTwoRows) {
  constexpr double kSigma = 1e-3;
  const Turning few = seen(40, kSigma), many = seen(400, kSigma);
  const TurnAxis pairs = of_every_two(few), axis = turn_axis(few);
  EXPECT_LT((axis.e - pairs.e).norm(), 1e-13) << "rounding";
  EXPECT_LT((axis.p - pairs.p).norm(), 1e-12);
  EXPECT_NEAR(axis.weight, pairs.weight, 1e-9);
  const TurnAxis all = of_every_two(many), fast = turn_axis(many);
  // The markers reach 0.5 m about their centroid.
  const double sigma = kSigma / 0.5 / std::sqrt(400);
  EXPECT_LT((all.e - Vector3d::UnitZ()).norm(), 3 * sigma);
  EXPECT_LT((fast.e - all.e).norm(), sigma / 20);
  EXPECT_LT((fast.p - all.p).norm(), sigma / 20);
  EXPECT_NEAR(fast.weight, all.weight, 1e-9 * all.weight);
}

TEST(TurnAxisOfMarkers, TakesAsManyRowsAsACameraGives) {
  constexpr int kRows = 30000;  // 450 million pairs
  Turning turning = seen(kRows, 1e-4);
  const TurnAxis axis = turn_axis(turning);
  EXPECT_EQ(axis.problem, "");
  EXPECT_LT((axis.e - Vector3d::UnitZ()).norm(), 5 * 1e-4 / 0.5 / std::sqrt(kRows));
  EXPECT_LT((axis.p - Vector3d(1, 2, 0)).cross(axis.e).norm(), 5 * 1e-4 / std::sqrt(kRows));
  turning.variable.tail(5).array() += 0.2;
  EXPECT_THAT(turn_axis(turning).problem, testing::HasSubstr("turned otherwise"));
}

TEST(TurnAxisOfMarkers, SaysWhatItLacks) {
  Turning one = by_hand(), few = by_hand(), line = by_hand(), still = by_hand(), half = by_hand(),
          otherwise = by_hand();
  one.variable.conservativeResize(1);
  for (Matrix3Xd& each : few.markers) each.conservativeResize(3, 2);
  for (Matrix3Xd& each : line.markers) each.col(2) = 0.5 * (each.col(0) + each.col(1));
  still.variable *= 0.001;
  half.variable = Eigen::Vector3d(0, 1, 2) * std::numbers::pi;
  otherwise.variable[1] += 0.3;
  EXPECT_THAT(turn_axis(one).problem, testing::HasSubstr("two rows"));
  EXPECT_THAT(turn_axis(few).problem, testing::HasSubstr("three markers"));
  EXPECT_THAT(turn_axis(line).problem, testing::HasSubstr("in a line"));
  EXPECT_THAT(turn_axis(still).problem, testing::HasSubstr("turns through 9.425 mrad only"));
  EXPECT_THAT(turn_axis(half).problem, testing::HasSubstr("whole or half turns"));
  EXPECT_THAT(turn_axis(otherwise).problem, testing::HasSubstr("turned otherwise"));
}

}  // namespace
}  // namespace selfcal
