#include "kinematics/inverse/controller_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

constexpr double kQuarter = 1e-6;     // rad from a multiple of a quarter turn that count as one
constexpr double kFitted = 1e-5;      // m, to which the priors give way
constexpr double kFittedTurn = 3e-5;  // rad, the same
constexpr int kFitSteps = 6;
constexpr double kFitSettled = 1e-9;  // of a step, over the tolerances

bool multiple_of_a_quarter(double angle) {
  return std::abs(std::remainder(angle, std::numbers::pi / 2)) < kQuarter;
}

/// Configurations that the nominal robot with some values can take, block by block, beside where
/// the calibrated one is there.
class Beside {
 public:
  Beside(const Robot& nominal, const Robot& calibrated, const Eigen::MatrixXd& q,
         const OperatingPoint& at)
      : nominal_(nominal), q_(q) {
    const Eigen::VectorXd xi = values(calibrated);
    Locations X;
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const Eigen::VectorXd each = q.row(i).transpose();
      closes_.push_back(
          calibrated.locate(block_of(each), xi, Body::endpoint, X, nullptr).closes(0) ? 1 : 0);
      is_.push_back(closes_.back() ? locate_at(at, calibrated, xi, each) : Location{});
    }
  }

  /// `take(lane, psi, off)` of each, `off` the way and the turn from the model to the calibrated.
  template <class Take>
  void each(const Eigen::VectorXd& xi, PsiBlock* psi, Take take) const {
    Locations X;
    for (Eigen::Index first = 0; first < q_.rows(); first += kLanes) {
      const auto count = static_cast<int>(std::min<Eigen::Index>(kLanes, q_.rows() - first));
      ConfigurationBlock block{Eigen::ArrayXXd(kLanes, q_.cols()), count};
      for (int lane = 0; lane < kLanes; ++lane)
        block.q.row(lane) = q_.row(first + std::min(lane, count - 1)).array();
      const Closure closure = nominal_.locate(block, xi, Body::endpoint, X, psi);
      for (int lane = 0; lane < count; ++lane) {
        const auto i = static_cast<std::size_t>(first + lane);
        if (!closes_[i] || !closure.closes(lane)) continue;
        Eigen::Matrix<double, 6, 1> off;
        off << is_[i].p - X.p(lane), log_rotation(is_[i].R * X.R(lane).transpose());
        take(lane, off);
      }
    }
  }

 private:
  const Robot& nominal_;
  const Eigen::MatrixXd& q_;
  std::vector<char> closes_;
  std::vector<Location> is_;
};

}  // namespace

std::vector<int> controller_parameters(const Robot& nominal) {
  std::vector<int> list;
  const Eigen::VectorXd xi = nominal_values(nominal);
  const std::vector<Parameter>& parameters = nominal.parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& p = parameters[i];
    const auto index = static_cast<int>(i);
    if (p.part == Part::effect) continue;
    bool taken = nominal.has_loops() || p.part == Part::base || p.part == Part::tool;
    for (std::size_t j = 0; j < nominal.joints().size(); ++j)
      taken = taken || nominal.variable_parameter(static_cast<int>(j)) == index;
    if (p.part == Part::link && p.quantity == Quantity::length) taken = taken || xi[index] != 0;
    if (p.part == Part::link && p.quantity == Quantity::angle)
      taken = taken || !multiple_of_a_quarter(xi[index]);
    if (taken) list.push_back(index);
  }
  return list;
}

ControllerModel controller_model(const Robot& nominal, const Robot& calibrated,
                                 const Eigen::MatrixXd& q, const OperatingPoint& at) {
  expects(q.rows() > 0, "configurations to fit over");
  ControllerModel model;
  const Eigen::VectorXd whole = values(calibrated);
  model.as_found = nominal_values(nominal);
  Eigen::VectorXd tolerance(0);
  for (const int i : controller_parameters(nominal)) {
    const Parameter& each = nominal.parameters()[static_cast<std::size_t>(i)];
    const int there = find_parameter(calibrated, each.name);
    if (there < 0) continue;
    model.as_found[i] = whole[there];
    if (!each.free || !(each.tolerance > 0)) continue;
    model.taken.push_back(i);
    tolerance.conservativeResize(tolerance.size() + 1);
    tolerance[tolerance.size() - 1] = each.tolerance;
  }
  model.xi = model.as_found;
  const auto count = static_cast<Eigen::Index>(model.taken.size());
  if (count == 0) return model;
  const Beside beside(nominal, calibrated, q, at);
  PsiBlock psi;
  for (int step = 0; step < kFitSteps; ++step) {
    // In tolerances, so that the priors are ones.
    Eigen::MatrixXd H = Eigen::MatrixXd::Identity(count, count);
    Eigen::VectorXd g =
        (model.as_found(model.taken) - model.xi(model.taken)).cwiseQuotient(tolerance);
    Eigen::MatrixXd W(6, count);
    beside.each(model.xi, &psi, [&](int lane, Eigen::Matrix<double, 6, 1> off) {
      for (int c = 0; c < 6; ++c) {
        const double sigma = c < 3 ? kFitted : kFittedTurn;
        W.row(c) =
            psi.row(c * kLanes + lane)(model.taken).cwiseProduct(tolerance.transpose()) / sigma;
        off[c] /= sigma;
      }
      H.noalias() += W.transpose() * W;
      g.noalias() += W.transpose() * off;
    });
    const Eigen::VectorXd by = inverse_of_positive(H) * g;
    model.xi(model.taken) += by.cwiseProduct(tolerance);
    if (by.norm() < kFitSettled) break;
  }
  return model;
}

ControllerError controller_error(const Robot& nominal, const Eigen::VectorXd& xi,
                                 const Robot& calibrated, const Eigen::MatrixXd& q,
                                 const OperatingPoint& at) {
  ControllerError error;
  double ways = 0, turns = 0;
  Beside(nominal, calibrated, q, at)
      .each(xi, nullptr, [&](int, const Eigen::Matrix<double, 6, 1>& off) {
        const double way = off.head<3>().norm(), turn = off.tail<3>().norm();
        ways += way * way;
        turns += turn * turn;
        error.most = std::max(error.most, way);
        error.most_angle = std::max(error.most_angle, turn);
        ++error.configurations;
      });
  if (error.configurations == 0) return error;
  error.rms = std::sqrt(ways / error.configurations);
  error.rms_angle = std::sqrt(turns / error.configurations);
  return error;
}

}  // namespace selfcal
