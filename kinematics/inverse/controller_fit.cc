#include "kinematics/inverse/controller_fit.h"

#include <algorithm>
#include <cmath>

#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

constexpr double kTurnArm = 0.1;    // m: what a turn weighs beside a shift
constexpr double kNear = 1e-6;      // m, that a move by its tolerance is worth
constexpr double kAllOfIt = 1e-9;   // m: robots that are one
constexpr double kFitStep = 1e-12;  // rad, m: the last step's
constexpr int kMostFits = 20;

/// Up to kLanes rows of `q` from `first` on.
ConfigurationBlock poses_from(const Eigen::MatrixXd& q, Eigen::Index first) {
  ConfigurationBlock block;
  block.count = static_cast<int>(std::min<Eigen::Index>(kLanes, q.rows() - first));
  block.q.resize(kLanes, q.cols());
  for (int lane = 0; lane < kLanes; ++lane)
    block.q.row(lane) = q.row(first + std::min(lane, block.count - 1));
  return block;
}

/// Shift and turn from where `X` has the end to where `wanted` has it, in the world.
Eigen::Matrix<double, 6, 1> way_between(const Location& X, const Location& wanted) {
  Eigen::Matrix<double, 6, 1> e;
  e << wanted.p - X.p, log_rotation(wanted.R * X.R.transpose());
  return e;
}

/// What one step of the fit is solved from.
struct Linearised {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
};

class Fit {
 public:
  Fit(const Robot& geometry, const ControllerNumbers& numbers, const Robot& real,
      const Eigen::MatrixXd& q)
      : geometry_(geometry), numbers_(numbers), q_(q) {
    const Eigen::VectorXd xi = values(real);
    for (Eigen::Index i = 0; i < q.rows(); ++i)
      wanted_.push_back(locate(real, xi, q.row(i).transpose()));
  }

  Eigen::VectorXd run() const {
    Eigen::VectorXd s = least_squares(numbers_.basis, values(geometry_) - numbers_.start);
    for (int i = 0; i < kMostFits; ++i) {
      const Linearised at = linearised(s);
      const Eigen::VectorXd step = least_squares(at.A, at.b);
      s += step;
      if (step.size() == 0 || step.cwiseAbs().maxCoeff() < kFitStep) break;
    }
    return numbers_.start + numbers_.basis * s;
  }

 private:
  Linearised linearised(const Eigen::VectorXd& s) const {
    const Eigen::Index numbers = s.size(), priors = numbers_.start.size();
    Linearised at{Eigen::MatrixXd::Zero(6 * q_.rows() + priors, numbers),
                  Eigen::VectorXd::Zero(6 * q_.rows() + priors)};
    const Eigen::VectorXd moved = numbers_.basis * s, xi = numbers_.start + moved;
    Locations X;
    PsiBlock psi;
    for (Eigen::Index first = 0; first < q_.rows(); first += kLanes) {
      const ConfigurationBlock block = poses_from(q_, first);
      const Closure closure = geometry_.locate(block, xi, Body::endpoint, X, &psi);
      const Eigen::MatrixXd J = psi * numbers_.basis;
      for (int lane = 0; lane < block.count; ++lane) {
        if (!closure.closes(lane)) continue;
        const Eigen::Matrix<double, 6, 1> e =
            way_between(X.at(lane), wanted_[static_cast<std::size_t>(first + lane)]);
        for (int c = 0; c < 6; ++c) {
          const double weight = (c < 3 ? 1 : kTurnArm) / kNear;
          at.A.row(6 * (first + lane) + c) = weight * J.row(c * kLanes + lane);
          at.b[6 * (first + lane) + c] = weight * e[c];
        }
      }
    }
    for (Eigen::Index i = 0; i < priors; ++i) {
      const double tolerance = geometry_.parameters()[static_cast<std::size_t>(i)].tolerance;
      if (!(tolerance > 0)) continue;
      at.A.row(6 * q_.rows() + i) = numbers_.basis.row(i) / tolerance;
      at.b[6 * q_.rows() + i] = -moved[i] / tolerance;
    }
    return at;
  }

  const Robot& geometry_;
  const ControllerNumbers& numbers_;
  const Eigen::MatrixXd& q_;
  std::vector<Location> wanted_;
};

/// The rows of `q` from `first` on, every other one.
Eigen::MatrixXd every_other(const Eigen::MatrixXd& q, Eigen::Index first) {
  return q(Eigen::seq(first, q.rows() - 1, Eigen::fix<2>), Eigen::all);
}

}  // namespace

ControllerNumbers numbers_of_parameters(const Robot& robot, const std::vector<int>& taken) {
  ControllerNumbers numbers{nominal_values(robot), {}};
  numbers.basis =
      Eigen::MatrixXd::Zero(numbers.start.size(), static_cast<Eigen::Index>(taken.size()));
  for (std::size_t i = 0; i < taken.size(); ++i)
    numbers.basis(taken[i], static_cast<Eigen::Index>(i)) = 1;
  return numbers;
}

EndsApart ends_apart(const Robot& one, const Eigen::VectorXd& xi_one, const Robot& other,
                     const Eigen::VectorXd& xi_other, const Eigen::MatrixXd& q) {
  EndsApart apart;
  double squares = 0, squares_angle = 0;
  Locations X, Y;
  for (Eigen::Index first = 0; first < q.rows(); first += kLanes) {
    const ConfigurationBlock block = poses_from(q, first);
    Closure closure = one.locate(block, xi_one, Body::endpoint, X, nullptr);
    closure.add(other.locate(block, xi_other, Body::endpoint, Y, nullptr));
    for (int lane = 0; lane < block.count; ++lane) {
      if (!closure.closes(lane)) continue;
      const Eigen::Matrix<double, 6, 1> e = way_between(X.at(lane), Y.at(lane));
      squares += e.head<3>().squaredNorm();
      squares_angle += e.tail<3>().squaredNorm();
      apart.most = std::max(apart.most, e.head<3>().norm());
      ++apart.poses;
    }
  }
  if (apart.poses == 0) return apart;
  apart.rms = std::sqrt(squares / apart.poses);
  apart.rms_angle = std::sqrt(squares_angle / apart.poses);
  return apart;
}

ControllerFit fit_controller(const Robot& geometry, const ControllerNumbers& numbers,
                             const Robot& real, const Eigen::MatrixXd& q) {
  expects(q.rows() >= 2, "poses to fit and poses to judge by");
  const Eigen::MatrixXd fitted = every_other(q, 0), judged = every_other(q, 1);
  const Eigen::VectorXd xi_real = values(real);
  ControllerFit fit;
  fit.before = ends_apart(geometry, numbers.start, real, xi_real, judged);
  fit.xi = numbers.start +
           numbers.basis * least_squares(numbers.basis, values(geometry) - numbers.start);
  fit.after = ends_apart(geometry, fit.xi, real, xi_real, judged);
  if (fit.after.most < kAllOfIt) return fit;
  fit.xi = Fit(geometry, numbers, real, fitted).run();
  fit.after = ends_apart(geometry, fit.xi, real, xi_real, judged);
  return fit;
}

}  // namespace selfcal
