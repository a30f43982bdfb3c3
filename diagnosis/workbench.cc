#include "diagnosis/workbench.h"

#include <cmath>

#include "kinematics/linear_algebra.h"

namespace selfcal {

Workbench::Workbench(const Whitened& rows, const Structure& structure) : root_(structure.root) {
  equations_ = rows.A.rows();
  const Eigen::Index n = rows.A.cols();
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(equations_ + n, n);
  stacked.topRows(equations_) = whitened(rows.A);
  stacked.bottomRows(n).diagonal() = rows.weight;
  const OrthogonalColumns qr = orthogonal_columns(stacked);
  Q_ = qr.Q;
  constant_ = -qr.log_volume;
  for (Eigen::Index i = 0; i < root_.rows(); ++i) constant_ -= std::log(root_(i, i));
  // Freedom of the rows alone: each prior determines the share of its parameter that they do not.
  nu_ = static_cast<double>(equations_) - Q_.topRows(equations_).squaredNorm();
  C_ = whitened(rows.C);
  const Eigen::MatrixXd QC = Q_.topRows(equations_).transpose() * C_;
  G_.noalias() = C_.transpose() * C_;
  G_.noalias() -= QC.transpose() * QC;
  look_at(rows.y, rows.pull);
}

Eigen::MatrixXd Workbench::whitened(const Eigen::MatrixXd& x) const {
  return solve_lower(root_, x);
}

Eigen::VectorXd Workbench::beyond_geometry(const Eigen::VectorXd& x,
                                           const Eigen::VectorXd& pull) const {
  Eigen::VectorXd z(Q_.rows());
  z << whitened(x), pull;
  z -= Q_ * (Q_.transpose() * z).eval();
  return z;
}

void Workbench::look_at(const Eigen::VectorXd& y, const Eigen::VectorXd& pull) {
  const Eigen::VectorXd left = beyond_geometry(y, pull);
  g_ = C_.transpose() * left.head(equations_);
  yy_ = left.squaredNorm();  // the strain on the priors too: a cause relieves both
}

namespace {

constexpr int kMost = 64;

/// Columns of a few terms, and the prior sigma of each.
std::pair<std::vector<int>, Eigen::VectorXd> unfold(std::span<const Workbench::Term> terms) {
  std::vector<int> columns;
  std::vector<double> sigma;
  for (const Workbench::Term& term : terms)
    for (size_t k = 0; k < term.block->columns.size(); ++k) {
      columns.push_back(term.block->columns[k]);
      sigma.push_back(term.size * term.block->unit[static_cast<Eigen::Index>(k)]);
    }
  return {columns,
          Eigen::Map<const Eigen::VectorXd>(sigma.data(), static_cast<Eigen::Index>(sigma.size()))};
}

/// At most kMost columns: one or two blocks, so small that plain loops on the stack beat any
/// library.
struct Small {
  int n = 0;
  double L[kMost][kMost];
  double z[kMost];
  double scale[kMost];
  int column[kMost];
};

}  // namespace

double Workbench::log_evidence(std::span<const Term> terms) const {
  Small s;
  for (const Term& term : terms)
    for (size_t k = 0; k < term.block->columns.size() && s.n < kMost; ++k) {
      s.column[s.n] = term.block->columns[k];
      s.scale[s.n++] = term.size * term.block->unit[static_cast<Eigen::Index>(k)];
    }
  double half_log_det = 0, explained = 0;
  for (int i = 0; i < s.n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = s.scale[i] * s.scale[j] * G_(s.column[i], s.column[j]) + (i == j ? 1 : 0);
      for (int k = 0; k < j; ++k) sum -= s.L[i][k] * s.L[j][k];
      s.L[i][j] = i == j ? std::sqrt(std::max(sum, 1e-12)) : sum / s.L[j][j];
    }
    double z = s.scale[i] * g_[s.column[i]];
    for (int k = 0; k < i; ++k) z -= s.L[i][k] * s.z[k];
    s.z[i] = z / s.L[i][i];
    explained += s.z[i] * s.z[i];
    half_log_det += std::log(s.L[i][i]);
  }
  return constant_ - half_log_det - nu_ / 2 * std::log(std::max(yy_ - explained, 1e-300));
}

Workbench Workbench::given(std::span<const Term> terms) const {
  Workbench rest;
  rest.G_ = G_;
  rest.g_ = g_;
  rest.yy_ = yy_;
  rest.nu_ = nu_;
  rest.constant_ = constant_;
  if (terms.empty()) return rest;
  const auto [columns, D] = unfold(terms);
  const Eigen::MatrixXd H = Eigen::MatrixXd::Identity(D.size(), D.size()) +
                            Eigen::MatrixXd(D.asDiagonal() * G_(columns, columns) * D.asDiagonal());
  const Eigen::MatrixXd L = cholesky_root(H);
  const Eigen::MatrixXd seen = solve_lower(L, D.asDiagonal() * G_(columns, Eigen::all));
  const Eigen::VectorXd z = solve_lower(L, D.cwiseProduct(g_(columns)));
  rest.G_.noalias() -= seen.transpose() * seen;
  rest.g_ -= seen.transpose() * z;
  rest.yy_ -= z.squaredNorm();
  rest.constant_ -= L.diagonal().array().log().sum();
  return rest;
}

Workbench::Estimate Workbench::estimate(std::span<const Term> terms) const {
  const auto [columns, D] = unfold(terms);
  const Eigen::MatrixXd H = Eigen::MatrixXd::Identity(D.size(), D.size()) +
                            Eigen::MatrixXd(D.asDiagonal() * G_(columns, columns) * D.asDiagonal());
  const Eigen::MatrixXd inverse = inverse_of_positive(H);
  Estimate estimate;
  const Eigen::VectorXd g = D.cwiseProduct(g_(columns));
  estimate.mean = D.cwiseProduct(inverse * g);
  estimate.covariance = D.asDiagonal() * inverse * D.asDiagonal();
  estimate.variance = std::max(yy_ - g.dot(inverse * g), 1e-12) / nu_;
  return estimate;
}

}  // namespace selfcal
