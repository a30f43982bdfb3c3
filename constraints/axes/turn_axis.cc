// Of every two rows k < l, with Delta the change of the joint variable and Q the rotation of the
// markers about their centroids c:
//   vect(Q) = e sin(Delta)      →  e along the sum of sin(Delta) vect(Q)
//   (T - 1) p = T c_k - c_l,  e . p = 0,   T = exp(Delta e)
// The error of vect(Q) does not depend on the turn, so that the sine is the weight of least
// squares; it also gives each its sign. T follows the joint's reading, which is finer than any
// camera.
#include "constraints/axes/turn_axis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/linear_algebra.h"
#include "kinematics/readable.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

Matrix3Xd centred(const Matrix3Xd& markers) { return markers.colwise() - markers.rowwise().mean(); }

std::string in_words(double angle) { return with_figures("%.4g mrad", 1e3 * angle); }

/// The two rows whose turns differ most.
double farthest_turn(const Eigen::VectorXd& variable) {
  return variable.maxCoeff() - variable.minCoeff();
}

std::string unsuited(const Turning& turning) {
  if (turning.variable.size() < 2) return "it takes two rows or more";
  if (const double turn = farthest_turn(turning.variable); turn < kLeastTurn)
    return "the joint turns through " + in_words(turn) + " only; it takes " + in_words(kLeastTurn) +
           " or more";
  if (turning.markers[0].cols() < 3) return "it takes three markers or more";
  const Eigen::VectorXd extent = singular_values(centred(turning.markers[0]).transpose()).values;
  if (!(extent[1] > kLeastSpread * extent[0])) return "the markers are in a line";
  return {};
}

/// The direction; where the markers turn otherwise than the variable, the problem.
void find_direction(const Turning& turning, TurnAxis& axis) {
  const auto rows = static_cast<int>(turning.markers.size());
  std::vector<Matrix3d> turns;
  std::vector<double> changes;
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < rows; ++k)
    for (int l = k + 1; l < rows; ++l) {
      const Matrix3d Q = rotation_onto(centred(turning.markers[k]), centred(turning.markers[l]));
      const double sine = std::sin(turning.variable[l] - turning.variable[k]);
      sum += sine * 0.5 * Vector3d(Q(2, 1) - Q(1, 2), Q(0, 2) - Q(2, 0), Q(1, 0) - Q(0, 1));
      axis.weight += sine * sine;
      turns.push_back(Q);
      changes.push_back(turning.variable[l] - turning.variable[k]);
    }
  if (axis.weight < std::pow(std::sin(kLeastTurn), 2) || !(sum.norm() > 0)) {
    axis.problem = "the rows are whole or half turns apart, which say nothing of the direction";
    return;
  }
  axis.e = sum.normalized();
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const double off =
        log_rotation(exp_rotation(changes[i] * axis.e).transpose() * turns[i]).norm();
    if (off <= kOtherwise || !axis.problem.empty()) continue;
    axis.problem = "where the joint's readings turn by " + in_words(changes[i]) +
                   " the markers turned otherwise, by " + in_words(off) +
                   ": another joint moved, or the robot's file couples or gears this one "
                   "otherwise";
  }
}

void find_point(const Turning& turning, TurnAxis& axis) {
  const auto rows = static_cast<int>(turning.markers.size());
  Eigen::MatrixXd A(3 * rows * (rows - 1) / 2 + 1, 3);
  Eigen::VectorXd b(A.rows());
  int at = 0;
  for (int k = 0; k < rows; ++k)
    for (int l = k + 1; l < rows; ++l, at += 3) {
      const Matrix3d T = exp_rotation((turning.variable[l] - turning.variable[k]) * axis.e);
      A.middleRows<3>(at) = T - Matrix3d::Identity();
      b.segment<3>(at) =
          T * turning.markers[k].rowwise().mean() - turning.markers[l].rowwise().mean();
    }
  A.bottomRows<1>() = axis.e.transpose();
  b[b.size() - 1] = 0;
  axis.p = least_squares(A, b);
}

/// What is left of the markers, turned back to where the variable is zero.
double off_circles(const Turning& turning, const TurnAxis& axis) {
  const auto rows = static_cast<Eigen::Index>(turning.markers.size());
  const Eigen::Index markers = turning.markers[0].cols();
  Eigen::MatrixXd back(3 * markers, rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const Matrix3d T = exp_rotation(-turning.variable[k] * axis.e);
    back.col(k) =
        (T * (turning.markers[static_cast<std::size_t>(k)].colwise() - axis.p)).reshaped();
  }
  back.colwise() -= back.rowwise().mean().eval();
  constexpr double kOfTheAxis = 4;  // freedoms of a line
  const double freedoms = static_cast<double>(3 * markers * (rows - 1)) - kOfTheAxis;
  return std::sqrt(back.squaredNorm() / freedoms);
}

}  // namespace

Matrix3d rotation_onto(const Matrix3Xd& from, const Matrix3Xd& to) {
  const Eigen::JacobiSVD<Matrix3d> svd(to * from.transpose(),
                                       Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant());
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

TurnAxis turn_axis(const Turning& turning) {
  TurnAxis axis;
  axis.problem = unsuited(turning);
  if (axis.problem.empty()) find_direction(turning, axis);
  if (!axis.problem.empty()) return axis;
  find_point(turning, axis);
  axis.off = off_circles(turning, axis);
  return axis;
}

}  // namespace selfcal
