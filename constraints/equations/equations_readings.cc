// The readings' own noise in the equations of a row. With the stated noise s_a of each equation,
// the joints' readings off by sigma and K = G J their derivatives, the equations of a row hang
// together,
//   C = diag(s^2) + sigma^2 K K^T.
// With D the diagonal of the set's root mean squares of C_aa, by quantity, and L the Cholesky
// factor of D^-1 C D^-1, the equations D L^-1 D^-1 r are independent, each with its quantity's
// noise in D. K is that of the maker's figures: the weights stand still while the parameters move.
#include <cmath>

#include "constraints/equations/equations_inner.h"

namespace selfcal {
namespace {

constexpr double kSmallestShare =
    1e-12;  // of the variance: keeps C regular where nothing is stated

/// Mean of the diagonals' entries of one quantity; 0 where there are none.
double mean_variance(const std::vector<Eigen::MatrixXd>& C, const std::vector<Quantity>& of,
                     Quantity quantity) {
  double sum = 0;
  int count = 0;
  for (const Eigen::MatrixXd& each : C)
    for (size_t a = 0; a < of.size(); ++a)
      if (of[a] == quantity) {
        sum += each(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(a));
        ++count;
      }
  return count > 0 ? sum / count : 0;
}

}  // namespace

void Equations::propagate_readings(int set) {
  const Set& s = data_.sets[set];
  const int items = static_cast<int>(plans_[set].items.size());
  stated_[set] = {s.noise, s.noise_angle};
  independent_[set].clear();
  if (!(s.noise_joints > 0) || items == 0) return;
  State state{nominal_values(robot_), {}, {}};
  start(state);
  const std::vector<Quantity>& quantities = quantities_[set];
  const auto n = static_cast<Eigen::Index>(quantities.size());
  Eigen::VectorXd stated(n);
  for (Eigen::Index a = 0; a < n; ++a)
    stated[a] = quantities[static_cast<size_t>(a)] == Quantity::angle ? s.noise_angle : s.noise;
  std::vector<Eigen::MatrixXd> C;
  Block block;
  Eigen::MatrixXd J;
  for (int first = 0; first < items; first += kLanes) {
    const int count = std::min(kLanes, items - first);
    evaluate(set, first, count, state, block, true);
    robot_.joint_jacobian(block.now, state.xi, s.method->body(), block.psi_now, J);
    for (int lane = 0; lane < count; ++lane) {
      Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, J.cols());
      for (Eigen::Index a = 0; a < n; ++a)
        for (int c = 0; c < 6; ++c)
          K.row(a) += block.out.G_now(lane, 6 * a + c) * J.row(c * kLanes + lane);
      C.push_back(s.noise_joints * s.noise_joints * K * K.transpose());
      C.back().diagonal() += stated.cwiseAbs2();
    }
  }
  stated_[set] = {std::sqrt(mean_variance(C, quantities, Quantity::length)),
                  std::sqrt(mean_variance(C, quantities, Quantity::angle))};
  Eigen::VectorXd D(n);
  for (Eigen::Index a = 0; a < n; ++a) D[a] = stated_[set].of(quantities[static_cast<size_t>(a)]);
  const Eigen::VectorXd inverse = D.cwiseInverse();
  for (const Eigen::MatrixXd& each : C) {
    Eigen::MatrixXd relative = inverse.asDiagonal() * each * inverse.asDiagonal();
    relative.diagonal().array() += kSmallestShare;
    const Eigen::MatrixXd L = relative.llt().matrixL();
    independent_[set].push_back(
        D.asDiagonal() * L.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(n, n)) *
        inverse.asDiagonal());
  }
}

void Equations::make_independent(int set, int first, Block& block) const {
  block.independent = nullptr;
  if (independent_[set].empty()) return;
  block.independent = &independent_[set][first];
  const auto n = static_cast<Eigen::Index>(quantities_[set].size());
  for (int lane = 0; lane < block.count; ++lane) {
    const Eigen::MatrixXd& T = block.independent[lane];
    block.out.r.row(lane) = (T * block.out.r.row(lane).matrix().transpose()).transpose().array();
    Eigen::Matrix<double, Eigen::Dynamic, 6> G(n, 6);
    for (Eigen::Index a = 0; a < n; ++a)
      G.row(a) = block.out.G_now.row(lane).segment<6>(6 * a).matrix();
    G = (T * G).eval();
    for (Eigen::Index a = 0; a < n; ++a)
      block.out.G_now.row(lane).segment<6>(6 * a) = G.row(a).array();
  }
}

}  // namespace selfcal
