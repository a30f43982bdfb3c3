// Rotation vectors: there and back, near zero and near half a turn, and the logarithm's
// derivatives.
#include "kinematics/rotation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace selfcal {
namespace {

constexpr double kRotationRounding = 1e-14;  // tens of epsilon

Eigen::Vector3d direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

TEST(RotationVector, ComesBackFromItsRotation) {
  std::mt19937_64 random(31);
  for (const double angle : {0.0, 1e-300, 1e-20, 1e-12, 1e-9, 1e-5, 0.01, 0.5, 2.0, 3.0, 3.14159}) {
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d phi = angle * direction(random);
      // Relative for small angles: none of their digits may be lost in 1 + angle^2.
      EXPECT_LT((log_rotation(exp_rotation(phi)) - phi).norm(), 1e-13 * std::max(angle, 1e-3))
          << angle;
    }
  }
}

TEST(RotationVector, ComesBackAtHalfATurnWithEitherSign) {
  std::mt19937_64 random(32);
  for (const double short_of : {0.0, 1e-15, 1e-12, 1e-8}) {
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d phi = (std::numbers::pi - short_of) * direction(random);
      const Eigen::Vector3d back = log_rotation(exp_rotation(phi));
      EXPECT_LE(back.norm(), std::numbers::pi + kRotationRounding);
      // pi about u and pi about -u are one rotation.
      EXPECT_LT(std::min((back - phi).norm(), (back + phi).norm()), 1e-13 + 2 * short_of);
      EXPECT_LT((exp_rotation(back) - exp_rotation(phi)).norm(), 1e-13);
    }
  }
}

TEST(RotationVector, BeyondHalfATurnComesBackAsTheShorterWay) {
  std::mt19937_64 random(33);
  const Eigen::Vector3d u = direction(random);
  const Eigen::Vector3d back = log_rotation(exp_rotation(4.0 * u));
  EXPECT_LT((back - (4.0 - 2 * std::numbers::pi) * u).norm(), kRotationRounding);
}

TEST(RotationVector, GivesARotationWhoseAxisItIs) {
  const Eigen::Matrix3d R = exp_rotation({0, 0, std::numbers::pi / 2});
  EXPECT_LT((R * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), kRotationRounding);
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), kRotationRounding);
}

TEST(SkewMatrix, MultipliesAsACrossProduct) {
  const Eigen::Vector3d a(1, -2, 3), b(0.5, 4, -1);
  EXPECT_EQ(skew(a) * b, a.cross(b));
}

TEST(LeftJacobianInverse, IsTheDerivativeOfTheLogarithm) {
  std::mt19937_64 random(34);
  // log(exp(d) R) = log R + Jl^-1 d. Central differences of step 1e-6: the second derivative of
  // Jl^-1 is below 1 / (pi - angle)^2, 1e4 at 3.13 rad, so that 2e-9 is cut off; rounding leaves
  // 1e-9.
  constexpr double h = 1e-6;
  for (const double angle : {0.0, 1e-9, 1e-4, 0.00999, 0.01001, 0.3, 1.5, 2.5, 3.13}) {
    const Eigen::Vector3d phi = angle * direction(random);
    const Eigen::Matrix3d R = exp_rotation(phi), J = left_jacobian_inverse(phi);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = h * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d left =
          (log_rotation(exp_rotation(d) * R) - log_rotation(exp_rotation(-d) * R)) / (2 * h);
      const Eigen::Vector3d right =
          (log_rotation(R * exp_rotation(d)) - log_rotation(R * exp_rotation(-d))) / (2 * h);
      EXPECT_LT((J.col(i) - left).norm(), 1e-8) << angle;
      EXPECT_LT((J.transpose().col(i) - right).norm(), 1e-8) << angle;
    }
  }
}

TEST(LeftJacobianInverse, IsExactAtHalfATurnAndBeyond) {
  // At pi about x: I - pi / 2 [x] + (1/pi^2 - 0) pi^2 [x]^2 = x x^T - pi / 2 [x].
  const double pi = std::numbers::pi;
  Eigen::Matrix3d expected;
  expected << 1, 0, 0, 0, 0, pi / 2, 0, -pi / 2, 0;
  // The closed form's (1 + cos t) / sin t loses digits within 1e-8 of pi: 1e-8 is left.
  for (const double short_of : {0.0, 1e-12, 1e-9, -1e-9})
    EXPECT_LT((left_jacobian_inverse({pi - short_of, 0, 0}) - expected).norm(), 3e-8) << short_of;
  // Jl(phi) phi = phi at any angle.
  const Eigen::Vector3d phi(2, -3, 1.5);
  EXPECT_LT((left_jacobian_inverse(phi) * phi - phi).norm(), 1e-13);
}

TEST(TurnOnto, IsTheLeastTurnFromOneDirectionToAnother) {
  std::mt19937_64 random(36);
  for (const double angle : {0.0, 1e-12, 1e-5, 0.5, 2.0, 3.1, std::numbers::pi - 1e-5,
                             std::numbers::pi - 1e-10, std::numbers::pi})
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d a = direction(random);
      const Eigen::Vector3d n = a.cross(direction(random)).normalized();
      const Eigen::Vector3d b = exp_rotation(angle * n) * a;
      const Eigen::Matrix3d R = turn_onto(a, b);
      EXPECT_LT((R * a - b).norm(), 10 * kRotationRounding) << angle;
      EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 10 * kRotationRounding);
      EXPECT_GT(R.determinant(), 0);
      EXPECT_NEAR(log_rotation(R).norm(), angle, 1e-7) << "rounding of a cosine near -1";
    }
}

TEST(TurnOnto, TurnsAboutXFromZToItsOpposite) {
  const Eigen::Matrix3d R = turn_onto(Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitZ());
  const Eigen::Matrix3d half = Eigen::Vector3d(1, -1, -1).asDiagonal();
  EXPECT_LT((R - half).norm(), kRotationRounding);
}

TEST(NearestRotation, BringsVectorsOntoTheirTurnedOnes) {
  std::mt19937_64 random(37);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Matrix3d R = exp_rotation(2.5 * direction(random));
    Eigen::Matrix3Xd from(3, 5);
    for (Eigen::Index k = 0; k < 5; ++k) from.col(k) = direction(random);
    EXPECT_LT((nearest_rotation(R * from * from.transpose()) - R).norm(), 1e-13);
    // Of vectors in a plane a mirror would do as well.
    from.row(2).setZero();
    EXPECT_LT((nearest_rotation(R * from * from.transpose()) - R).norm(), 1e-13);
  }
}

TEST(RollPitchYaw, ComeBackFromTheirRotationAtEveryPitch) {
  std::mt19937_64 random(35);
  std::uniform_real_distribution<double> turn(-3.1, 3.1);
  const double quarter = std::numbers::pi / 2;
  for (const double pitch : {0.0, 0.4, -1.5, quarter, -quarter, quarter - 1e-8, 1e-9 - quarter}) {
    const Eigen::Vector3d rpy(turn(random), pitch, turn(random));
    const Eigen::Matrix3d R = rpy_rotation(rpy);
    // A few epsilon, at a quarter turn too, where the angles themselves are not determined.
    EXPECT_LT((rpy_rotation(rpy_of(R)) - R).norm(), 2e-15) << pitch;
    if (std::abs(pitch) < 1) {
      EXPECT_LT((rpy_of(R) - rpy).norm(), 1e-15) << pitch;
    }
  }
}

TEST(RollPitchYaw, TurnAboutTheAxesInTheirOrder) {
  const double quarter = std::numbers::pi / 2;
  Eigen::Matrix3d expected;  // the pitch takes x to -z and z to x; the yaw then x to y, y to -x
  expected << 0, -1, 0, 0, 0, 1, -1, 0, 0;
  EXPECT_LT((rpy_rotation({0, quarter, quarter}) - expected).norm(), 1e-15);
}

}  // namespace
}  // namespace selfcal
