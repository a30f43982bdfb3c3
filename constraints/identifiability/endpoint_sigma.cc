// D = J L with covariance L L^T gives the deviation of every pose at once; D - B (B^T B)^-1 B^T D
// is what remains after a rigid motion of the world and a shift of the target are taken out.
#include "constraints/identifiability/endpoint_sigma.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

/// L with L L^T = C for a symmetric C that may be singular, without columns for what is exact.
Eigen::MatrixXd root(const Eigen::MatrixXd& C) {
  std::vector<Eigen::Index> open;
  for (Eigen::Index i = 0; i < C.cols(); ++i)
    if (!C.col(i).isZero(0)) open.push_back(i);
  if (open.empty()) return Eigen::MatrixXd::Zero(C.rows(), 0);
  const Symmetric eigen = symmetric_eigen(C(open, open));
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(C.rows(), eigen.values.size());
  L(open, Eigen::all) = eigen.vectors * eigen.values.cwiseMax(0).cwiseSqrt().asDiagonal();
  return L;
}

/// Deviations of every pose for one sigma of each independent part of the posterior, and what a
/// motion of the world or a shift of the target would look like; three rows a pose.
struct Deviations {
  Eigen::MatrixXd shift, turn;                ///< m, rad
  Eigen::MatrixXd unseen_shift, unseen_turn;  ///< by unseen motion, then by direction of the target
};

/// `L`: the root of the covariance.
Deviations deviations(const EndpointQuestion& question, const Eigen::MatrixXd& L) {
  const Robot& robot = *question.robot;
  const Eigen::MatrixXd& q = question.poses;
  const Eigen::Index rows = 3 * q.rows(), motions = question.unseen.cols();
  const Eigen::Index unseen = motions + (question.point_unknown ? 3 : 0);
  Deviations D{Eigen::MatrixXd::Zero(rows, L.cols()), Eigen::MatrixXd::Zero(rows, L.cols()),
               Eigen::MatrixXd::Zero(rows, unseen), Eigen::MatrixXd::Zero(rows, unseen)};
  ConfigurationBlock block;
  Locations X, link;
  PsiBlock psi;
  for (Eigen::Index first = 0; first < q.rows(); first += kLanes) {
    block.count = static_cast<int>(std::min<Eigen::Index>(kLanes, q.rows() - first));
    block.q.resize(kLanes, q.cols());
    for (int lane = 0; lane < kLanes; ++lane)
      block.q.row(lane) = q.row(std::min(first + lane, q.rows() - 1)).array();
    // A lane that does not close with the values found has no derivative, and adds nothing.
    const Closure closure = robot.locate(block, question.xi, Body::endpoint, X, &psi);
    if (unseen > motions) robot.locate(block, question.xi, Body::last_link, link, nullptr);
    const Eigen::MatrixXd moves = psi * L;
    for (int lane = 0; lane < block.count; ++lane) {
      if (!closure.closes(lane)) continue;
      Eigen::MatrixXd J(6, moves.cols());
      for (int c = 0; c < 6; ++c) J.row(c) = moves.row(c * kLanes + lane);
      Eigen::Matrix<double, 3, 6> motion;
      motion << Eigen::Matrix3d::Identity(), -skew(X.p(lane));
      const Eigen::Index at = 3 * (first + lane);
      D.shift.middleRows<3>(at) = J.topRows<3>();
      D.turn.middleRows<3>(at) = J.bottomRows<3>();
      D.unseen_shift.block(at, 0, 3, motions) = motion * question.unseen;
      D.unseen_turn.block(at, 0, 3, motions) = question.unseen.bottomRows<3>();
      if (unseen > motions) D.unseen_shift.block(at, motions, 3, 3) = link.R(lane);
    }
  }
  return D;
}

/// Takes out of `D` whatever the rows cannot place, by least squares over the shifts of all poses.
void align(Deviations& D) {
  const Eigen::MatrixXd x = least_squares_of_all(D.unseen_shift, D.shift);
  D.shift -= D.unseen_shift * x;
  D.turn -= D.unseen_turn * x;
}

}  // namespace

EndpointSigma endpoint_sigma(const EndpointQuestion& question) {
  EndpointSigma result;
  const Eigen::Index poses = question.poses.rows();
  if (poses == 0) return result;
  Deviations D = deviations(question, root(question.covariance));
  result.aligned = D.unseen_shift.cols() > 0;
  if (result.aligned) align(D);
  std::vector<double> variance(static_cast<size_t>(poses));
  for (Eigen::Index i = 0; i < poses; ++i)
    variance[static_cast<size_t>(i)] = D.shift.middleRows<3>(3 * i).squaredNorm();
  for (const double each : variance) result.by_pose.push_back(std::sqrt(each));
  std::sort(variance.begin(), variance.end());
  const auto count = static_cast<double>(poses);
  result.poses = static_cast<int>(poses);
  result.rms = std::sqrt(D.shift.squaredNorm() / count);
  result.median = std::sqrt(variance[variance.size() / 2]);
  result.max = std::sqrt(variance.back());
  result.angle = std::sqrt(D.turn.squaredNorm() / count);
  return result;
}

Eigen::MatrixXd endpoint_weight(const EndpointQuestion& question) {
  const auto parameters = static_cast<Eigen::Index>(question.robot->parameters().size());
  if (question.poses.rows() == 0) return Eigen::MatrixXd::Zero(parameters, parameters);
  Deviations D = deviations(question, Eigen::MatrixXd::Identity(parameters, parameters));
  if (D.unseen_shift.cols() > 0) align(D);
  return transposed_product(D.shift, D.shift) / static_cast<double>(question.poses.rows());
}

double endpoint_rms(const Eigen::MatrixXd& weight, const Eigen::MatrixXd& C) {
  return std::sqrt(std::max(0.0, weight.cwiseProduct(C).sum()));
}

}  // namespace selfcal
