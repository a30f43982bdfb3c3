#include "constraints/sampling/newton.h"

#include <cmath>

#include "kinematics/linear_algebra.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kNewtonSteps = 40;
constexpr double kLongestStep = 0.5;  // units of readings
constexpr double kExact = 1e-13;      // residual that counts as met (m, rad)

}  // namespace

NewtonStep::NewtonStep(const Robot& robot, const DataSet& data, const State& truth, int row,
                       const Locations& before, const std::vector<int>& held)
    : robot_(robot),
      data_(data),
      truth_(truth),
      before_(before),
      held_(held),
      set_(data.rows.set[row]),
      rows_(kLanes, row) {}

void NewtonStep::evaluate(const ConfigurationBlock& block) {
  const Method& method = *data_.sets[set_].method;
  const int reference = data_.sets[set_].reference;
  closure_ = robot_.locate(block, truth_.xi, method.body(), X_, &psi_);
  robot_.joint_jacobian(block, truth_.xi, method.body(), psi_, J_);
  out_.resize(static_cast<int>(method.equations().size()), method.tangent_dimension(),
              reference < 0 ? 0 : data_.sets[reference].method->tangent_dimension(),
              method.group_freedom());
  MethodInput in;
  in.count = block.count;
  in.data = &data_.rows;
  in.rows = rows_.data();
  in.now = &X_;
  in.before = &before_;
  in.nuisance = &truth_.nuisance[set_];
  in.reference = reference < 0 ? nullptr : &truth_.nuisance[reference];
  in.groups = &truth_.groups[set_];
  method.evaluate(in, out_);
  for (const int j : held_) J_.col(j).setZero();
  if (!method.constrains() || method.measures().empty()) return;
  const std::vector<Quantity> quantities = method.equations();
  for (size_t a = 0; a < quantities.size(); ++a) {
    if (quantities[a] == Quantity::length) continue;
    out_.r.col(static_cast<Eigen::Index>(a)).setZero();
    out_.G_now.middleCols(6 * static_cast<Eigen::Index>(a), 6).setZero();
  }
}

Eigen::VectorXd NewtonStep::miss(int lane, const Eigen::VectorXd& wanted) const {
  return wanted - out_.r.row(lane).matrix().transpose();
}

Eigen::VectorXd NewtonStep::step(int lane, const Eigen::VectorXd& miss) const {
  Eigen::MatrixXd GJ = Eigen::MatrixXd::Zero(miss.size(), J_.cols());
  for (Eigen::Index a = 0; a < miss.size(); ++a)
    for (Eigen::Index c = 0; c < 6; ++c)
      GJ.row(a) += out_.G_now(lane, 6 * a + c) * J_.row(c * J_.rows() / 6 + lane);
  if (miss.size() > 1) return least_squares(GJ, miss);
  const double squared = GJ.squaredNorm();
  if (squared == 0) return Eigen::VectorXd::Zero(J_.cols());
  return GJ.row(0).transpose() * (miss[0] / squared);
}

std::vector<int> NewtonStep::reach(const Eigen::VectorXd& wanted, int enough,
                                   ConfigurationBlock& block) {
  const Eigen::ArrayXd units = units_of_readings(robot_);
  Lanes left = Lanes::Constant(kLanes, HUGE_VAL);
  for (int at = 0; at < kNewtonSteps; ++at) {
    evaluate(block);
    for (int lane = 0; lane < kLanes; ++lane) {
      const Eigen::VectorXd off = miss(lane, wanted);
      left[lane] = closes(lane) ? off.norm() : HUGE_VAL;
      if (!closes(lane)) continue;  // lost
      if (left[lane] < kExact / 10) continue;
      Eigen::VectorXd dq = step(lane, off);
      const double length = (dq.array() / units).matrix().norm();
      if (length > kLongestStep) dq *= kLongestStep / length;
      block.q.row(lane) += dq.transpose().array();
    }
    if ((left < kExact / 10).count() >= enough) break;
  }
  std::vector<int> reached;
  for (int lane = 0; lane < kLanes; ++lane)
    if (left[lane] < kExact) reached.push_back(lane);
  // Once more: down to rounding, by which a structural rank is judged.
  evaluate(block);
  for (const int lane : reached)
    block.q.row(lane) += step(lane, miss(lane, wanted)).transpose().array();
  robot_.locate(block, truth_.xi, data_.sets[set_].method->body(), X_, nullptr);
  return reached;
}

}  // namespace selfcal
