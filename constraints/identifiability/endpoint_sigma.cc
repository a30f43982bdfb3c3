// J of every pose; J - B (B^T B)^-1 B^T J is what remains after a rigid motion of the world and a
// shift of the target are taken out. With covariance L L^T the deviation of a pose is |J L|.
#include "constraints/identifiability/endpoint_sigma.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

/// J of every pose, three rows each, and what a motion of the world or a shift of the target would
/// look like.
struct Moves {
  Eigen::MatrixXd shift, turn;                ///< by parameter
  Eigen::MatrixXd unseen_shift, unseen_turn;  ///< by unseen motion, then by direction of the target
};

/// Of the poses from `first` on those of one block.
ConfigurationBlock block_from(const Eigen::MatrixXd& q, Eigen::Index first) {
  ConfigurationBlock block;
  block.count = static_cast<int>(std::min<Eigen::Index>(kLanes, q.rows() - first));
  block.q.resize(kLanes, q.cols());
  for (int lane = 0; lane < kLanes; ++lane)
    block.q.row(lane) = q.row(std::min(first + lane, q.rows() - 1)).array();
  return block;
}

/// Psi of the lanes that close, from pose `first` on.
void take(const PsiBlock& psi, const Closure& closure, int count, Eigen::Index first,
          Moves& moves) {
  for (Eigen::Index c = 0; c < psi.cols(); ++c)
    for (int lane = 0; lane < count; ++lane) {
      if (!closure.closes(lane)) continue;
      for (int i = 0; i < 3; ++i) {
        moves.shift(3 * (first + lane) + i, c) = psi(i * kLanes + lane, c);
        moves.turn(3 * (first + lane) + i, c) = psi((3 + i) * kLanes + lane, c);
      }
    }
}

Moves moves_of(const EndpointQuestion& question) {
  const Robot& robot = *question.robot;
  const Eigen::MatrixXd& q = question.poses;
  const auto parameters = static_cast<Eigen::Index>(robot.parameters().size());
  const Eigen::Index rows = 3 * q.rows(), motions = question.unseen.cols();
  const Eigen::Index unseen = motions + (question.point_unknown ? 3 : 0);
  Moves D{Eigen::MatrixXd::Zero(rows, parameters), Eigen::MatrixXd::Zero(rows, parameters),
          Eigen::MatrixXd::Zero(rows, unseen), Eigen::MatrixXd::Zero(rows, unseen)};
  Locations X, link;
  PsiBlock psi;
  for (Eigen::Index first = 0; first < q.rows(); first += kLanes) {
    const ConfigurationBlock block = block_from(q, first);
    // A lane that does not close with the values found has no derivative, and adds nothing.
    const Closure closure = robot.locate(block, question.xi, Body::endpoint, X, &psi);
    if (unseen > motions) robot.locate(block, question.xi, Body::last_link, link, nullptr);
    take(psi, closure, block.count, first, D);
    for (int lane = 0; lane < block.count; ++lane) {
      if (!closure.closes(lane)) continue;
      const Eigen::Index at = 3 * (first + lane);
      Eigen::Matrix<double, 3, 6> motion;
      motion << Eigen::Matrix3d::Identity(), -skew(X.p(lane));
      D.unseen_shift.block(at, 0, 3, motions) = motion * question.unseen;
      D.unseen_turn.block(at, 0, 3, motions) = question.unseen.bottomRows<3>();
      if (unseen > motions) D.unseen_shift.block(at, motions, 3, 3) = link.R(lane);
    }
  }
  return D;
}

/// Takes out of `D` whatever the rows cannot place, by least squares over the shifts of all poses.
void align(Moves& D) {
  const Eigen::MatrixXd x = least_squares_of_all(D.unseen_shift, D.shift);
  D.shift.noalias() -= D.unseen_shift * x;
  D.turn.noalias() -= D.unseen_turn * x;
}

/// |J L|^2 of every pose with C = L L^T for a symmetric C that may be singular; what is exact in it
/// is left out.
std::vector<double> variances(const Eigen::MatrixXd& shift, const Eigen::MatrixXd& C) {
  std::vector<double> variance(static_cast<size_t>(shift.rows() / 3), 0);
  std::vector<Eigen::Index> open;
  for (Eigen::Index i = 0; i < C.cols(); ++i)
    if (!C.col(i).isZero(0)) open.push_back(i);
  if (open.empty() || variance.empty()) return variance;
  const Symmetric eigen = symmetric_eigen(C(open, open));
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(C.rows(), eigen.values.size());
  L(open, Eigen::all) = eigen.vectors * eigen.values.cwiseMax(0).cwiseSqrt().asDiagonal();
  const Eigen::VectorXd squares = product(shift, L).rowwise().squaredNorm();
  for (size_t i = 0; i < variance.size(); ++i)
    variance[i] = squares.segment<3>(3 * static_cast<Eigen::Index>(i)).sum();
  return variance;
}

}  // namespace

EndpointDeviations endpoint_deviations(const EndpointQuestion& question) {
  const auto parameters = static_cast<Eigen::Index>(question.robot->parameters().size());
  EndpointDeviations result;
  result.weight = result.turn_weight = Eigen::MatrixXd::Zero(parameters, parameters);
  const Eigen::Index poses = question.poses.rows();
  if (poses == 0) return result;
  Moves D = moves_of(question);
  result.aligned = D.unseen_shift.cols() > 0;
  if (result.aligned) align(D);
  result.weight = transposed_product(D.shift, D.shift) / static_cast<double>(poses);
  result.turn_weight = transposed_product(D.turn, D.turn) / static_cast<double>(poses);
  result.shift = std::move(D.shift);
  return result;
}

EndpointSigma endpoint_sigma(const EndpointDeviations& deviations, const Eigen::MatrixXd& C) {
  EndpointSigma result;
  std::vector<double> variance = variances(deviations.shift, C);
  if (variance.empty()) return result;
  result.aligned = deviations.aligned;
  double sum = 0;
  for (const double each : variance) {
    result.by_pose.push_back(std::sqrt(each));
    sum += each;
  }
  std::ranges::sort(variance);
  result.poses = static_cast<int>(variance.size());
  result.rms = std::sqrt(sum / static_cast<double>(variance.size()));
  result.median = std::sqrt(variance[variance.size() / 2]);
  result.max = std::sqrt(variance.back());
  result.angle = endpoint_rms(deviations.turn_weight, C);
  return result;
}

double endpoint_rms(const Eigen::MatrixXd& weight, const Eigen::MatrixXd& C) {
  return std::sqrt(std::max(0.0, weight.cwiseProduct(C).sum()));
}

}  // namespace selfcal
