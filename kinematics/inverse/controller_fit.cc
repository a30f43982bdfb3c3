#include "kinematics/inverse/controller_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr double kQuarter = 1e-6;  // rad from a multiple of a quarter turn that count as one
constexpr double kTurnArm = 0.1;   // of the robot's size: what a turn weighs beside a shift
constexpr double kNear = 1e-6;     // of the same, that a move by its tolerance is worth
constexpr double kAllOfIt = 1e-9;  // of the same: robots that are one
constexpr double kFitStep = 1e-6;  // of kNear, by which the last step moves the poses
constexpr int kMostFits = 20;

bool multiple_of_a_quarter(double angle) {
  return std::abs(std::remainder(angle, std::numbers::pi / 2)) < kQuarter;
}

/// Poses that a robot with some parameters can take, block by block, beside where the real one is
/// there.
class Beside {
 public:
  Beside(const Robot& robot, const Robot& real, const Eigen::MatrixXd& q, const OperatingPoint& at)
      : robot_(robot), q_(q) {
    const Eigen::VectorXd xi = values(real);
    Locations X;
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const Eigen::VectorXd each = q.row(i).transpose();
      if (real.locate(block_of(each), xi, Body::endpoint, X, nullptr).closes(0))
        is_.emplace_back(locate_at(at, real, xi, each));
      else
        is_.emplace_back();
    }
  }

  /// `take(pose, lane, off)` of each, `off` the way and the turn from the robot with `xi`, whose
  /// Jacobian is `psi`, to the real one.
  template <class Take>
  void each(const Eigen::VectorXd& xi, PsiBlock* psi, Take take) const {
    Locations X;
    for (Eigen::Index first = 0; first < q_.rows(); first += kLanes) {
      const auto count = static_cast<int>(std::min<Eigen::Index>(kLanes, q_.rows() - first));
      ConfigurationBlock block{Eigen::ArrayXXd(kLanes, q_.cols()), count};
      for (int lane = 0; lane < kLanes; ++lane)
        block.q.row(lane) = q_.row(first + std::min(lane, count - 1)).array();
      const Closure closure = robot_.locate(block, xi, Body::endpoint, X, psi);
      for (int lane = 0; lane < count; ++lane) {
        const std::optional<Location>& is = is_[static_cast<std::size_t>(first + lane)];
        if (!is || !closure.closes(lane)) continue;
        Eigen::Matrix<double, 6, 1> off;
        off << is->p - X.p(lane), log_rotation(is->R * X.R(lane).transpose());
        take(first + lane, lane, off);
      }
    }
  }

 private:
  const Robot& robot_;
  const Eigen::MatrixXd& q_;
  std::vector<std::optional<Location>> is_;
};

EndsApart apart(const Beside& beside, const Eigen::VectorXd& xi) {
  EndsApart ends;
  double squares = 0, squares_angle = 0;
  beside.each(xi, nullptr, [&](Eigen::Index, int, const Eigen::Matrix<double, 6, 1>& off) {
    squares += off.head<3>().squaredNorm();
    squares_angle += off.tail<3>().squaredNorm();
    ends.most = std::max(ends.most, off.head<3>().norm());
    ++ends.poses;
  });
  if (ends.poses == 0) return ends;
  ends.rms = std::sqrt(squares / ends.poses);
  ends.rms_angle = std::sqrt(squares_angle / ends.poses);
  return ends;
}

/// What one step of the fit is solved from.
struct Linearised {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
};

Linearised linearised(const Robot& geometry, const ControllerNumbers& numbers, const Beside& beside,
                      Eigen::Index poses, const Eigen::VectorXd& s) {
  const Eigen::Index priors = numbers.start.size();
  const double size = size_of(geometry);
  Linearised at{Eigen::MatrixXd::Zero(6 * poses + priors, s.size()),
                Eigen::VectorXd::Zero(6 * poses + priors)};
  const Eigen::VectorXd moved = numbers.basis * s;
  PsiBlock psi;
  beside.each(numbers.start + moved, &psi,
              [&](Eigen::Index pose, int lane, const Eigen::Matrix<double, 6, 1>& off) {
                for (int c = 0; c < 6; ++c) {
                  const double weight = (c < 3 ? 1 / size : kTurnArm) / kNear;
                  at.A.row(6 * pose + c).noalias() =
                      weight * psi.row(c * kLanes + lane) * numbers.basis;
                  at.b[6 * pose + c] = weight * off[c];
                }
              });
  for (Eigen::Index i = 0; i < priors; ++i) {
    const double tolerance = geometry.parameters()[static_cast<std::size_t>(i)].tolerance;
    if (!(tolerance > 0)) continue;
    at.A.row(6 * poses + i) = numbers.basis.row(i) / tolerance;
    at.b[6 * poses + i] = -moved[i] / tolerance;
  }
  return at;
}

}  // namespace

std::vector<int> controller_parameters(const Robot& robot) {
  std::vector<int> list;
  const Eigen::VectorXd xi = nominal_values(robot);
  const std::vector<Parameter>& parameters = robot.parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& p = parameters[i];
    const auto index = static_cast<int>(i);
    if (p.part == Part::effect || !p.free || !(p.tolerance > 0)) continue;
    bool taken = robot.has_loops() || p.part == Part::base || p.part == Part::tool;
    for (std::size_t j = 0; j < robot.joints().size(); ++j)
      taken = taken || robot.variable_parameter(static_cast<int>(j)) == index;
    if (p.part == Part::link && p.quantity == Quantity::length) taken = taken || xi[index] != 0;
    if (p.part == Part::link && p.quantity == Quantity::angle)
      taken = taken || !multiple_of_a_quarter(xi[index]);
    if (taken) list.push_back(index);
  }
  return list;
}

ControllerNumbers numbers_of_parameters(const Robot& robot, const std::vector<int>& taken) {
  ControllerNumbers numbers{nominal_values(robot), {}};
  numbers.basis =
      Eigen::MatrixXd::Zero(numbers.start.size(), static_cast<Eigen::Index>(taken.size()));
  for (std::size_t i = 0; i < taken.size(); ++i)
    numbers.basis(taken[i], static_cast<Eigen::Index>(i)) = 1;
  return numbers;
}

EndsApart ends_apart(const Robot& robot, const Eigen::VectorXd& xi, const Robot& real,
                     const Eigen::MatrixXd& q, const OperatingPoint& at) {
  return apart(Beside(robot, real, q, at), xi);
}

Eigen::VectorXd as_found(const Robot& geometry, const ControllerNumbers& numbers,
                         const Robot& real) {
  Eigen::VectorXd found = numbers.start;
  const Eigen::VectorXd whole = values(real);
  for (std::size_t i = 0; i < geometry.parameters().size(); ++i)
    if (const int there = find_parameter(real, geometry.parameters()[i].name); there >= 0)
      found[static_cast<Eigen::Index>(i)] = whole[there];
  return numbers.start + numbers.basis * least_squares(numbers.basis, found - numbers.start);
}

Eigen::VectorXd fit_controller(const Robot& geometry, const ControllerNumbers& numbers,
                               const Robot& real, const Eigen::MatrixXd& q,
                               const OperatingPoint& at) {
  const Beside beside(geometry, real, q, at);
  const Eigen::VectorXd found = as_found(geometry, numbers, real);
  if (apart(beside, found).most < kAllOfIt * size_of(geometry)) return found;
  Eigen::VectorXd s = least_squares(numbers.basis, found - numbers.start);
  for (int i = 0; i < kMostFits && s.size() > 0; ++i) {
    const Linearised at_s = linearised(geometry, numbers, beside, q.rows(), s);
    const Eigen::VectorXd step = least_squares(at_s.A, at_s.b);
    s += step;
    if ((at_s.A * step).cwiseAbs().maxCoeff() < kFitStep) break;
  }
  return numbers.start + numbers.basis * s;
}

}  // namespace selfcal
