// Of every two rows k < l, with Delta the change of the joint variable and Q the rotation of the
// markers about their centroids c:
//   vect(Q) = e sin(Delta)      →  e along the sum of sin(Delta) vect(Q)
//   (T - 1) p = T c_k - c_l,  e . p = 0,   T = exp(Delta e)
// The error of vect(Q) does not depend on the turn, so that the sine is the weight of least
// squares; it also gives each its sign. T follows the joint's reading v, which is finer than any
// camera. Sums over pairs are sums over rows: with each row's own fit R,
//   sum over k, l of sin(v_l - v_k) R_l R_k^T = S C^T - C S^T,   S = sum sin(v) R, C = sum cos(v) R
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

constexpr std::size_t kRowsInPairs = 300;  // of more, each is fitted once

Matrix3Xd centred(const Matrix3Xd& markers) { return markers.colwise() - markers.rowwise().mean(); }

std::string in_words(double angle) { return with_figures("%.4g mrad", 1e3 * angle); }

/// Of the joint variable, and of the markers, from row k to row l.
double change(const Turning& turning, std::size_t k, std::size_t l) {
  return turning.variable[static_cast<Eigen::Index>(l)] -
         turning.variable[static_cast<Eigen::Index>(k)];
}
Matrix3d turned(const Turning& turning, std::size_t k, std::size_t l) {
  return rotation_onto(centred(turning.markers[k]), centred(turning.markers[l]));
}

Vector3d invariant(const Matrix3d& Q) {
  return 0.5 * Vector3d(Q(2, 1) - Q(1, 2), Q(0, 2) - Q(2, 0), Q(1, 0) - Q(0, 1));
}

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

/// What of the direction every two rows say, and how much.
struct Direction {
  Vector3d sum = Vector3d::Zero();
  double weight = 0;
};

/// From every two rows' own fit.
Direction direction_of_pairs(const Turning& turning) {
  const std::size_t rows = turning.markers.size();
  Direction direction;
  for (std::size_t k = 0; k < rows; ++k)
    for (std::size_t l = k + 1; l < rows; ++l) {
      const double sine = std::sin(change(turning, k, l));
      direction.sum += sine * invariant(turned(turning, k, l));
      direction.weight += sine * sine;
    }
  return direction;
}

/// With Q of rows k and l the product of each one's fit to the markers' mean shape, which is the
/// same to first order of the noise, in one pass over the rows.
Direction direction_of_rows(const Turning& turning) {
  Matrix3Xd shape = centred(turning.markers[0]);
  for (int again = 0; again < 2; ++again) {
    Matrix3Xd sum = Matrix3Xd::Zero(3, shape.cols());
    for (const Matrix3Xd& markers : turning.markers)
      sum += rotation_onto(shape, centred(markers)).transpose() * centred(markers);
    shape = sum / static_cast<double>(turning.markers.size());
  }
  Matrix3d S = Matrix3d::Zero(), C = S;
  double ss = 0, cc = 0, sc = 0;
  for (std::size_t k = 0; k < turning.markers.size(); ++k) {
    const Matrix3d R = rotation_onto(shape, centred(turning.markers[k]));
    const double v = turning.variable[static_cast<Eigen::Index>(k)], s = std::sin(v),
                 c = std::cos(v);
    S += s * R;
    C += c * R;
    ss += s * s;
    cc += c * c;
    sc += s * c;
  }
  return {invariant(S * C.transpose() - C * S.transpose()) / 2, ss * cc - sc * sc};
}

/// Where the markers turned otherwise than the variable between rows k and l, in words.
std::string turned_otherwise(const Turning& turning, const Vector3d& e, std::size_t k,
                             std::size_t l) {
  const double by = change(turning, k, l);
  const double off = log_rotation(exp_rotation(by * e).transpose() * turned(turning, k, l)).norm();
  if (off <= kOtherwise) return {};
  return "where the joint's readings turn by " + in_words(by) +
         " the markers turned otherwise, by " + in_words(off) +
         ": another joint moved, or the robot's file couples or gears this one otherwise";
}

/// The direction; where the markers turn otherwise than the variable, the problem.
void find_direction(const Turning& turning, TurnAxis& axis) {
  const std::size_t rows = turning.markers.size();
  const bool few = rows <= kRowsInPairs;
  const Direction direction = few ? direction_of_pairs(turning) : direction_of_rows(turning);
  axis.weight = direction.weight;
  if (axis.weight < std::pow(std::sin(kLeastTurn), 2) || !(direction.sum.norm() > 0)) {
    axis.problem = "the rows are whole or half turns apart, which say nothing of the direction";
    return;
  }
  axis.e = direction.sum.normalized();
  for (std::size_t k = 0; k < (few ? rows : 1); ++k)
    for (std::size_t l = k + 1; l < rows && axis.problem.empty(); ++l)
      axis.problem = turned_otherwise(turning, axis.e, k, l);
}

/// The sum over pairs is `rows` times that over rows of how far each, turned back to where the
/// variable is zero, lies from their mean.
void find_point(const Turning& turning, TurnAxis& axis) {
  const auto rows = static_cast<Eigen::Index>(turning.markers.size());
  Eigen::MatrixXd A(3 * rows + 1, 3);
  Eigen::VectorXd b(A.rows());
  Matrix3d mean_turn = Matrix3d::Zero();
  Vector3d mean = Vector3d::Zero();
  for (Eigen::Index k = 0; k < rows; ++k) {
    const Matrix3d back = exp_rotation(-turning.variable[k] * axis.e);
    A.middleRows<3>(3 * k) = back;
    b.segment<3>(3 * k) = back * turning.markers[static_cast<std::size_t>(k)].rowwise().mean();
    mean_turn += back / static_cast<double>(rows);
    mean += b.segment<3>(3 * k) / static_cast<double>(rows);
  }
  for (Eigen::Index k = 0; k < rows; ++k) {
    A.middleRows<3>(3 * k) -= mean_turn;
    b.segment<3>(3 * k) -= mean;
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
  return nearest_rotation(to * from.transpose());
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
