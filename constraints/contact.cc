// Newton steps of least length, dq = (G J)^+ (wanted - r), J the joint Jacobian of the body.
#include "constraints/contact.h"

#include <vector>

#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr int kSteps = 30;
constexpr double kMet = 1e-12;     // what is left of the wanted residual (m, rad)
constexpr double kFarthest = 0.3;  // rad or m: farther away it is another place, not a little off

/// G J of lane 0, equations x joints.
Eigen::MatrixXd by_joint(const MethodOutput& out, const Eigen::MatrixXd& J,
                         Eigen::Index equations) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(equations, J.cols());
  for (Eigen::Index a = 0; a < equations; ++a)
    for (Eigen::Index c = 0; c < 6; ++c) A.row(a) += out.G_now(0, 6 * a + c) * J.row(c * kLanes);
  return A;
}

}  // namespace

bool move_to_residual(const Robot& robot, const DataSet& data, const State& truth, int row,
                      const Eigen::VectorXd& wanted, Eigen::VectorXd& q) {
  const int s = data.rows.set[row];
  const Set& set = data.sets[s];
  const Method& method = *set.method;
  const Body body = method.body();
  ConfigurationBlock block = block_of(q);
  Locations X, before;
  robot.locate(block, truth.xi, body, before, nullptr);
  const std::vector<int> rows(kLanes, row);
  const Eigen::VectorXd* reference = set.reference < 0 ? nullptr : &truth.own[set.reference];
  const MethodInput in{1,       &data.rows,    rows.data(), &X,
                       &before, &truth.own[s], reference,   &truth.groups[s]};
  MethodOutput out;
  PsiBlock psi;
  Eigen::MatrixXd J;
  for (int step = 0; step < kSteps; ++step) {
    robot.locate(block, truth.xi, body, X, &psi);
    robot.joint_jacobian(truth.xi, psi, J);
    out.resize(static_cast<int>(wanted.size()), method.own_freedom(),
               reference ? data.sets[set.reference].method->own_freedom() : 0,
               method.group_freedom());
    method.evaluate(in, out);
    const Eigen::VectorXd miss = wanted - out.r.row(0).matrix().transpose();
    const Eigen::VectorXd there = block.q.row(0).matrix().transpose();
    if (!((there - q).norm() < kFarthest)) return false;
    if (miss.norm() < kMet) {
      q = there;
      return true;
    }
    const Eigen::VectorXd dq = least_squares(by_joint(out, J, wanted.size()), miss);
    block.q.rowwise() += dq.transpose().array();
  }
  return false;
}

}  // namespace selfcal
