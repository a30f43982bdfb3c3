#include "constraints/sampling/newton.h"

#include "kinematics/linear_algebra.h"

namespace selfcal {

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
      GJ.row(a) += out_.G_now(lane, 6 * a + c) * J_.row(c * kLanes + lane);
  return least_squares(GJ, miss);
}

}  // namespace selfcal
