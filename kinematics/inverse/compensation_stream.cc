#include "kinematics/inverse/compensation_stream.h"

#include <algorithm>
#include <cmath>

#include "kinematics/corrected_robot.h"
#include "kinematics/robots/linear_delta.h"
#include "kinematics/rotation.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kStreamedSteps = 4;
constexpr double kStreamedThere = 1e-7;   // of the robot's size; rad
constexpr double kTurnWeight = 0.2;       // of the robot's size: what a turn weighs beside a shift
constexpr double kTurnBeside = 1e-5;      // the same, of fewer than six joints
constexpr double kLongestStreamed = 0.1;  // units of the readings, of a step
constexpr double kLeastStreamed = 1e-14;  // of damping

constexpr int kMost = ScrewChain::kMostJoints;
using Lever = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMost>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMost, kMost>;
using Readings = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMost, 1>;

/// The endpoint at `q` and how it moves with the readings.
Location at_readings(const ScrewChain& chain, const Readings& q, Lever& J) {
  Location X;
  J.resize(6, chain.joints);
  for (int j = 0; j < chain.joints; ++j) {
    const Screw& screw = chain.screw[j];
    const Eigen::Vector3d axis = X.R * screw.axis, point = X * screw.point;
    // About the world's origin, until the endpoint is known.
    if (screw.turns)
      J.col(j) << point.cross(axis), axis;
    else
      J.col(j) << axis, Eigen::Vector3d::Zero();
    J.col(j) *= screw.gear;
    X = X * moved_by(screw, screw.gear * q[j]);
  }
  X = X * chain.zero;
  for (int j = 0; j < chain.joints; ++j)
    J.col(j).head<3>() += Eigen::Vector3d(J.col(j).tail<3>()).cross(X.p);
  return X;
}

Eigen::Matrix<double, 6, 1> between(const Location& X, const Location& wanted) {
  Eigen::Matrix<double, 6, 1> e;
  e << wanted.p - X.p, log_rotation(wanted.R * X.R.transpose());
  return e;
}

}  // namespace

CompensationStream::CompensationStream(std::shared_ptr<const Robot> calibrated, Machine machine,
                                       const Eigen::VectorXd& q, const OperatingPoint& at)
    : calibrated_(std::move(calibrated)),
      geometry_(geometry_of(calibrated_)),
      machine_(std::move(machine)),
      at_(at),
      xi_(values(*calibrated_)),
      xi_geometry_(xi_.head(static_cast<Eigen::Index>(geometry_->parameters().size()))),
      size_(size_of(*geometry_)),
      units_(units_of_readings(*geometry_)),
      q_(q) {
  refresh();
}

std::optional<CompensationStream> CompensationStream::of(std::shared_ptr<const Robot> calibrated,
                                                         const Eigen::VectorXd& q,
                                                         const OperatingPoint& at) {
  const std::shared_ptr<const Robot> geometry = geometry_of(calibrated);
  const Eigen::VectorXd xi =
      values(*calibrated).head(static_cast<Eigen::Index>(geometry->parameters().size()));
  std::optional<Machine> machine;
  if (const auto* platform = dynamic_cast<const platform::Platform*>(geometry.get()))
    machine = platform;
  else if (geometry->kind() == "linear-delta") {
    const Eigen::Matrix3d R = exp_rotation(linear_delta::tilt_of(xi, linear_delta::kEffector));
    machine = DeltaTool{R, R * xi.segment<3>(linear_delta::kTool)};
  } else if (const auto chain = screw_chain(*geometry, xi))
    machine = *chain;
  if (!machine) return std::nullopt;
  return CompensationStream(std::move(calibrated), *machine, q, at);
}

void CompensationStream::refresh() {
  deviation_ = {};
  if (geometry_ == calibrated_) return;
  const Location geometry = locate(*geometry_, xi_geometry_, q_);
  const Location whole = locate_at(at_, *calibrated_, xi_, q_);
  deviation_.p = whole.p - geometry.p;
  deviation_.R = whole.R * geometry.R.transpose();
}

StreamedCommand CompensationStream::command(const Location& wanted) {
  const Location of_geometry{deviation_.R.transpose() * wanted.R, wanted.p - deviation_.p};
  return std::visit([&](const auto& machine) { return step(machine, of_geometry); }, machine_);
}

StreamedCommand CompensationStream::step(const ScrewChain& chain, const Location& wanted) {
  const bool whole = chain.joints >= 6;
  const double weight = whole ? kTurnWeight : kTurnBeside;
  Readings q = q_;
  Lever J;
  Eigen::Matrix<double, 6, 1> e = between(at_readings(chain, q, J), wanted);
  for (int i = 0; i < kStreamedSteps; ++i) {
    e.head<3>() /= size_;
    e.tail<3>() *= weight;
    J.topRows<3>() /= size_;
    J.bottomRows<3>() *= weight;
    for (int j = 0; j < chain.joints; ++j) J.col(j) *= units_[j];
    Square A = J.transpose().lazyProduct(J);
    // Damped by the square of what is left: short near singular places, whole near the goal.
    A.diagonal().array() += std::max(e.squaredNorm(), kLeastStreamed);
    Readings dq = J.transpose().lazyProduct(e);
    A.ldlt().solveInPlace(dq);
    if (dq.norm() > kLongestStreamed) dq *= kLongestStreamed / dq.norm();
    for (int j = 0; j < chain.joints; ++j) q[j] += units_[j] * dq[j];
    e = between(at_readings(chain, q, J), wanted);
  }
  return take(q.data(), e.head<3>().norm(), whole ? e.tail<3>().norm() : 0);
}

StreamedCommand CompensationStream::step(const platform::Platform* platform,
                                         const Location& wanted) {
  const std::optional<platform::Six> q = platform->readings_at(xi_geometry_, wanted);
  if (!q || !q->allFinite()) return {};
  const platform::Stand stand = platform->stand_at(xi_geometry_, *q, wanted);
  if (stand == platform::Stand::other_mode) return {};
  StreamedCommand answer = take(q->data(), 0, 0);
  if (stand == platform::Stand::beyond_swing) answer.status = Streamed::limit;
  return answer;
}

StreamedCommand CompensationStream::step(const DeltaTool& delta, const Location& wanted) {
  const auto q = linear_delta::readings_at(xi_geometry_, wanted.p - delta.tool);
  return q && q->allFinite() ? take(q->data(), 0, 0) : StreamedCommand{};
}

StreamedCommand CompensationStream::take(const double* q, double error, double error_angle) {
  StreamedCommand answer{Streamed::behind, error, error_angle};
  if (!(error < kStreamedThere * size_ && error_angle < kStreamedThere)) return answer;
  answer.status = Streamed::reached;
  for (Eigen::Index j = 0; j < q_.size(); ++j) {
    q_[j] = q[j];
    if (!geometry_->joints()[static_cast<std::size_t>(j)].allows(q[j]))
      answer.status = Streamed::limit;
  }
  return answer;
}

}  // namespace selfcal
