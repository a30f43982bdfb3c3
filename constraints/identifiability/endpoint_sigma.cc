// D = J L with covariance L L^T gives the deviation of every pose at once; D - B (B^T B)^-1 B^T D
// is what remains after a rigid motion of the world and a shift of the target are taken out.
#include "constraints/identifiability/endpoint_sigma.h"

#include <algorithm>
#include <random>

#include "constraints/sampling/random_poses.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

/// L with L L^T = C for a symmetric C that may be singular.
Eigen::MatrixXd root(const Eigen::MatrixXd& C) {
  const Symmetric eigen = symmetric_eigen(C);
  return eigen.vectors * eigen.values.cwiseMax(0).cwiseSqrt().asDiagonal();
}

}  // namespace

EndpointSigma endpoint_sigma(const EndpointQuestion& question) {
  const Robot& robot = *question.robot;
  const Eigen::MatrixXd q = random_poses(robot, question.data, question.poses, question.seed);
  const Eigen::MatrixXd L = root(question.covariance);
  const Eigen::Index motions = question.unseen.cols(), points = question.point_unknown ? 3 : 0;
  Eigen::MatrixXd D(3 * question.poses, L.cols()), B(3 * question.poses, motions + points);
  ConfigurationBlock block;
  Locations X, link;
  PsiBlock psi;
  for (int first = 0; first < question.poses; first += kLanes) {
    block.count = std::min(kLanes, question.poses - first);
    block.q.resize(kLanes, q.cols());
    for (int lane = 0; lane < kLanes; ++lane)
      block.q.row(lane) = q.row(std::min(first + lane, question.poses - 1)).array();
    // A lane that does not close with the values found has no derivative, and adds nothing.
    robot.locate(block, question.xi, Body::endpoint, X, &psi);
    robot.locate(block, question.xi, Body::last_link, link, nullptr);
    for (int lane = 0; lane < block.count; ++lane) {
      Eigen::MatrixXd J(3, psi.cols());
      for (int i = 0; i < 3; ++i) J.row(i) = psi.row(i * kLanes + lane);
      Eigen::Matrix<double, 3, 6> motion;
      motion << Eigen::Matrix3d::Identity(), -skew(X.p(lane));
      D.middleRows<3>(3 * (first + lane)) = J * L;
      B.block(3 * (first + lane), 0, 3, motions) = motion * question.unseen;
      if (points > 0) B.block(3 * (first + lane), motions, 3, 3) = link.R(lane);
    }
  }
  D = beyond(B, D);
  std::vector<double> variance(question.poses);
  for (int i = 0; i < question.poses; ++i) variance[i] = D.middleRows<3>(3 * i).squaredNorm();
  std::sort(variance.begin(), variance.end());
  EndpointSigma result;
  result.aligned = B.cols() > 0;
  result.poses = question.poses;
  result.rms = std::sqrt(D.squaredNorm() / question.poses);
  result.median = std::sqrt(variance[variance.size() / 2]);
  result.max = std::sqrt(variance.back());
  return result;
}

}  // namespace selfcal
