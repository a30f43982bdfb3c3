// With p the end position, xi the calibrated values and J_c the columns of what the controller
// takes,
//   min_s sum |p(xi) - p(xi with the maker's others and s)|^2
// by Gauss-Newton steps, a rigid motion taken out where the rows cannot place the base; what is
// left adds to sigma by squares.
#include "constraints/estimation/controller_sigma.h"

#include <algorithm>
#include <cmath>

#include "constraints/sampling/workspace_poses.h"
#include "kinematics/inverse/controller_fit.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kComparedPoses = 200, kSteps = 4;
// In the robot's size, or rad.
constexpr double kEpsilon = 1e-6;  ///< what an end position may be off at the end of the steps
constexpr double kMotion = 50e-3;  ///< of the motion that is taken out

/// End positions (3 a pose) with `xi`, and their derivative to `columns`.
struct EndPositions {
  Eigen::VectorXd p;
  Eigen::MatrixXd J;
};
EndPositions end_positions(const Robot& robot, const Eigen::VectorXd& xi, const Eigen::MatrixXd& q,
                           const std::vector<int>& columns) {
  EndPositions ends{Eigen::VectorXd(3 * q.rows()),
                    Eigen::MatrixXd(3 * q.rows(), static_cast<Eigen::Index>(columns.size()))};
  ConfigurationBlock block{Eigen::ArrayXXd(kLanes, q.cols()), kLanes};
  Locations X;
  PsiBlock psi;
  for (Eigen::Index first = 0; first < q.rows(); first += kLanes) {
    for (int lane = 0; lane < kLanes; ++lane)
      block.q.row(lane) = q.row(std::min<Eigen::Index>(first + lane, q.rows() - 1)).array();
    robot.locate(block, xi, Body::endpoint, X, &psi);
    for (int lane = 0; lane < kLanes && first + lane < q.rows(); ++lane) {
      ends.p.segment<3>(3 * (first + lane)) = X.p(lane);
      for (int c = 0; c < 3; ++c)
        ends.J.row(3 * (first + lane) + c) = psi.row(c * kLanes + lane)(columns);
    }
  }
  return ends;
}

}  // namespace

ControllerSigma controller_sigma(const Robot& robot, const DataSet& data,
                                 const Solution& solution) {
  ControllerSigma result;
  const std::vector<int> taken = controller_parameters(robot);
  for (const int i : taken)
    result.parameters.push_back(robot.parameters()[static_cast<size_t>(i)].name);
  const Eigen::MatrixXd q =
      workspace_poses(robot, solution.values, data.workspace, data.rows.q, kComparedPoses, 1);
  if (q.rows() == 0 || solution.workspace.poses == 0) {
    result.sigma = -1;
    return result;
  }
  const Eigen::VectorXd wanted = end_positions(robot, solution.values, q, taken).p;
  Eigen::MatrixXd motion(wanted.size(), solution.workspace.aligned ? 6 : 0);
  for (Eigen::Index i = 0; i < q.rows() && motion.cols() > 0; ++i)
    motion.middleRows<3>(3 * i) << Eigen::Matrix3d::Identity(),
        -skew(Eigen::Vector3d(wanted.segment<3>(3 * i)));
  const double size = size_of(robot), epsilon = kEpsilon * size;
  Eigen::VectorXd xi = nominal_values(robot), left;
  for (const int i : taken) xi[i] = solution.values[i];
  for (int step = 0; step <= kSteps; ++step) {
    const EndPositions ends = end_positions(robot, xi, q, taken);
    const Eigen::Index n = ends.J.cols() + motion.cols();
    Eigen::VectorXd unit = Eigen::VectorXd::Constant(n, kMotion);
    if (motion.cols() > 0) unit.segment<3>(ends.J.cols()) *= size;
    for (size_t i = 0; i < taken.size(); ++i) {
      const Parameter& p = robot.parameters()[static_cast<size_t>(taken[i])];
      unit[static_cast<Eigen::Index>(i)] =
          std::max(p.tolerance, kEpsilon * (p.quantity == Quantity::length ? size : 1));
    }
    Eigen::MatrixXd both(wanted.size(), n);
    both << ends.J, motion;
    left = wanted - ends.p;
    Eigen::MatrixXd A(wanted.size() + n, n);
    A.topRows(wanted.size()) = both * unit.asDiagonal() / epsilon;
    A.bottomRows(n).setIdentity();
    Eigen::VectorXd y = Eigen::VectorXd::Zero(A.rows());
    y.head(wanted.size()) = left / epsilon;
    const Eigen::VectorXd s = unit.cwiseProduct(least_squares(A, y));
    if (step == kSteps)
      left -= both * s;
    else
      xi(taken) += s.head(ends.J.cols());
  }
  result.left = left.norm() / std::sqrt(static_cast<double>(q.rows()));
  result.sigma = std::hypot(result.left, solution.workspace.rms);
  return result;
}

}  // namespace selfcal
