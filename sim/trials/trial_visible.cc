// Ridge regression on the geometry's columns: r = |(I - A (A'A + P)^-1 A') e| / sqrt(n), with P the
// priors' weights, e the shifts over the noise and n the equations of the rows that identify.
#include "sim/trials/trial_visible.h"

#include <algorithm>
#include <cmath>

#include "kinematics/linear_algebra.h"
#include "sim/true_sets.h"

namespace selfcal {
namespace {

/// The same rows, all of which identify.
DataSet undivided(const DataSet& data) {
  DataSet all = data;
  all.rows.check.assign(all.rows.check.size(), 0);
  return all;
}

}  // namespace

TrialCalibration::TrialCalibration(const TrialSession& session, double noise) {
  const DataSet data = undivided(session.data);
  const Equations equations(*session.robot, data, Use::fit);
  const auto rows = static_cast<size_t>(data.rows.rows());
  const DenseEquations dense =
      equations.dense(session.truth, std::vector<Scale>(data.sets.size(), Scale{noise, 1}),
                      std::vector<char>(rows, 0));
  A_ = dense.W;
  row_ = dense.row;
  weight_.setZero(A_.cols());
  for (int c = 0; c < equations.robot_columns(); ++c)
    weight_[c] = 1 / session.robot->parameters()[static_cast<size_t>(c)].tolerance;
  along_.setZero(A_.rows(), 3);
  std::vector<int> seen(rows, 0);
  for (size_t i = 0; i < row_.size(); ++i) {
    const auto row = static_cast<size_t>(row_[i]);
    const auto e = static_cast<Eigen::Index>(i);
    if (session.world.touches())
      along_.row(e) =
          true_plane(data.sets, data.rows.set[row], session.truth.nuisance)->n.transpose() / noise;
    else
      along_(e, seen[row]++) = 1 / noise;
    (session.data.rows.check[row] ? check_ : fit_).push_back(static_cast<int>(i));
  }
}

Eigen::VectorXd TrialCalibration::seen(const Eigen::MatrixXd& shifts) const {
  return along_.cwiseProduct(shifts(row_, Eigen::all)).rowwise().sum();
}

TrialCalibration::Size TrialCalibration::size(const Eigen::VectorXd& seen) const {
  const Eigen::VectorXd rest = left(seen, Eigen::MatrixXd(seen.size(), 0));
  const double n = std::sqrt(static_cast<double>(fit_.size()));
  return {seen(fit_).norm() / n, rest(fit_).norm() / n};
}

/// What the fit to the rows that identify leaves of every row.
Eigen::VectorXd TrialCalibration::left(const Eigen::VectorXd& y,
                                       const Eigen::MatrixXd& causes) const {
  const auto n = static_cast<Eigen::Index>(fit_.size()), k = A_.cols(), c = causes.cols();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n + k, k + c);
  M.topLeftCorner(n, k) = A_(fit_, Eigen::all);
  M.topRightCorner(n, c) = causes(fit_, Eigen::all);
  M.block(n, 0, k, k).diagonal() = weight_;
  Eigen::VectorXd z = Eigen::VectorXd::Zero(n + k);
  z.head(n) = y(fit_);
  const Eigen::VectorXd x = least_squares(M, z);
  return y - A_ * x.head(k) - causes * x.tail(c);
}

std::optional<double> TrialCalibration::told_closed(const Eigen::VectorXd& y,
                                                    const Eigen::MatrixXd& causes) const {
  if (check_.empty() || causes.cols() == 0) return std::nullopt;
  const auto square = [&](const Eigen::VectorXd& rest) {
    return rest(check_).squaredNorm() / static_cast<double>(check_.size());
  };
  const double before = square(left(y, Eigen::MatrixXd(y.size(), 0)));
  const double after = square(left(y, causes));
  if (std::sqrt(before) < 1.05) return std::nullopt;
  return std::clamp(1 - (after - 1) / (before - 1), 0.0, 1.0);
}

}  // namespace selfcal
