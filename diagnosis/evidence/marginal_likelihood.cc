#include "diagnosis/evidence/marginal_likelihood.h"

#include <algorithm>
#include <cmath>

#include "constraints/statistics.h"
#include "diagnosis/constants.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

/// One block of at most kMostLooped columns: so small that plain loops on the stack beat any
/// library.
struct Small {
  int n = 0;
  double L[kMostLooped][kMostLooped];
  double z[kMostLooped];
  double scale[kMostLooped];
};

}  // namespace

MarginalLikelihood::MarginalLikelihood(std::shared_ptr<const Whitened> rows,
                                       DiscrepancyCovariance structure, const Groups& groups) {
  StructuredRows seen{.rows = std::make_shared<const EvidenceRows>(std::move(rows), groups)};
  seen.take(structure);
  const Eigen::MatrixXd AC = seen.AC();
  std::vector<double> products = seen.products();
  ObservedRows own(*seen.rows, seen.rows->rows().y, true);
  *this = MarginalLikelihood(std::move(seen), std::move(structure), AC, std::move(products), own);
}

MarginalLikelihood::MarginalLikelihood(StructuredRows seen, DiscrepancyCovariance structure,
                                       const Eigen::MatrixXd& AC, std::vector<double> products,
                                       ObservedRows& own)
    : kept_(std::move(products)) {
  const EvidenceRows& rows = *seen.rows;
  const Eigen::MatrixXd BB = rows.B().transpose() * rows.B();
  const double scale = 1 / structure.noise;
  Fixed fixed{std::move(seen), std::move(structure), {}, {}};
  fixed.root = cholesky_root(scale * fixed.seen.AA + BB);
  constant_ =
      -rows.log_volume() - fixed.root.diagonal().array().log().sum() - fixed.structure.log_volume();
  // Freedom of the rows alone: each prior determines the share of its parameter that they do not.
  const Eigen::MatrixXd half_B = solve_lower(fixed.root, rows.B().transpose());
  nu_ = static_cast<double>(rows.A().rows() - rows.A().cols()) + half_B.squaredNorm();
  for (double& each : kept_) each *= scale;
  rows.products().add(solve_lower(fixed.root, scale * AC), -1, kept_);
  const double least = rows.rows().least / fixed.structure.noise;
  if (least > 0) fixed.tail = NoiseTail(nu_);
  fixed_ = std::make_shared<const Fixed>(std::move(fixed));
  of_rows_ = std::make_shared<const Statistics>(statistics_of(own, rows.rows().pull, true));
  condition_on_rows();
}

Eigen::MatrixXd MarginalLikelihood::beyond_geometry(const Eigen::MatrixXd& X) const {
  const double scale = 1 / fixed_->structure.noise;
  const Eigen::MatrixXd& root = fixed_->root;
  const Eigen::MatrixXd AX = transposed_product(rows().A(), fixed_->seen.inverse_times(X));
  const Eigen::MatrixXd taken =
      solve_lower_transposed(root, solve_lower(root, Eigen::MatrixXd(scale * AX)));
  return scale * fixed_->seen.inverse_times(X - selfcal::product(rows().A(), taken));
}

MarginalLikelihood::Statistics MarginalLikelihood::statistics_of(const Eigen::MatrixXd& Y) const {
  ObservedRows observed(rows(), Y, true);
  return statistics_of(observed);
}

MarginalLikelihood::Statistics MarginalLikelihood::statistics_of(ObservedRows& observed) const {
  return statistics_of(observed, {}, true);
}

/// With the strain on the priors (columns of A; none where it has no rows) under each y: a cause
/// relieves both.
MarginalLikelihood::Statistics MarginalLikelihood::statistics_of(ObservedRows& observed,
                                                                 const Eigen::VectorXd& pull,
                                                                 bool with_causes) const {
  const StructuredRows& seen = fixed_->seen;
  const double scale = 1 / fixed_->structure.noise;
  observed.look_over(seen);
  Eigen::MatrixXd AY = scale * observed.AY(seen);
  Statistics statistics;
  statistics.yy = scale * observed.squares(seen);
  if (pull.size() > 0) {
    AY.colwise() += rows().B().transpose() * pull;
    statistics.yy.array() += pull.squaredNorm();
  }
  const Eigen::MatrixXd half = solve_lower(fixed_->root, AY);
  statistics.yy -= half.colwise().squaredNorm().transpose();
  if (!with_causes) return statistics;
  // C'S^-1 (Y - A taken): the kernel sees what is left of Y at once.
  const Eigen::MatrixXd taken = solve_lower_transposed(fixed_->root, half);
  statistics.g = observed.CY() - transposed_product(seen.noise->AC, taken);
  if (seen.kernel) {
    const Eigen::MatrixXd left =
        seen.hidden.asDiagonal() * (observed.UY() - seen.kernel->UA * taken);
    statistics.g -= transposed_product(seen.kernel->UC, left);
  }
  statistics.g *= scale;
  return statistics;
}

void MarginalLikelihood::condition_on(const Statistics& statistics, Eigen::Index which) {
  g_ = statistics.g.col(which);
  yy_ = statistics.yy[which];
}

void MarginalLikelihood::condition_on_rows() { condition_on(*of_rows_, 0); }

Eigen::MatrixXd MarginalLikelihood::products(const std::vector<int>& a) const {
  return transposed_product(beyond_geometry(rows().rows().C(Eigen::all, a)), rows().rows().C);
}

Eigen::MatrixXd MarginalLikelihood::root_of_gram(const std::vector<int>& columns) const {
  // X' S^-1 (X - A t) = |X - A t|^2 in S^-1 + |B t|^2, t what the geometry takes of X.
  const double scale = 1 / fixed_->structure.noise;
  const Eigen::MatrixXd& root = fixed_->root;
  Eigen::MatrixXd X = rows().rows().C(Eigen::all, columns);
  const Eigen::MatrixXd AX = scale * fixed_->seen.AC(columns);
  const Eigen::MatrixXd taken = solve_lower_transposed(root, solve_lower(root, AX));
  X -= selfcal::product(rows().A(), taken);
  fixed_->seen.whiten(X);
  X *= std::sqrt(scale);
  const Eigen::Index n = X.rows();
  X.conservativeResize(n + rows().B().rows(), Eigen::NoChange);
  X.bottomRows(rows().B().rows()).noalias() = rows().B() * taken;
  return X;
}

Eigen::MatrixXd MarginalLikelihood::gram(const std::vector<int>& columns) const {
  if (columns.empty()) return Eigen::MatrixXd(0, 0);
  const Eigen::MatrixXd Z = root_of_gram(columns);
  return transposed_product(Z, Z);
}

Eigen::MatrixXd MarginalLikelihood::gram(const Block& block) const {
  if (block.group < 0) return gram(block.columns);
  const auto n = static_cast<Eigen::Index>(block.columns.size());
  return Eigen::MatrixXd::NullaryExpr(
      n, n, [&](Eigen::Index i, Eigen::Index j) { return product(block.group, i, j); });
}

std::pair<std::vector<int>, Eigen::VectorXd> MarginalLikelihood::unfold(
    std::span<const Term> terms) {
  std::vector<int> columns;
  std::vector<double> sigma;
  for (const Term& term : terms)
    for (size_t k = 0; k < term.block->columns.size(); ++k) {
      columns.push_back(term.block->columns[k]);
      sigma.push_back(term.size * term.block->unit[static_cast<Eigen::Index>(k)]);
    }
  return {columns,
          Eigen::Map<const Eigen::VectorXd>(sigma.data(), static_cast<Eigen::Index>(sigma.size()))};
}

double MarginalLikelihood::of_noise(double left, double freedom) const {
  left = std::max(left, 1e-300);
  const double log = -freedom / 2 * std::log(left);
  if (least() <= 0 || freedom <= 0) return log;
  const double value = left / least();
  const double surely = freedom + 10 * std::sqrt(2 * freedom) + 50;  // where the probability is 1
  if (value > surely) return log;
  return log +
         (freedom == nu_ ? fixed_->tail.log_below(value) : log_chi_square_below(value, freedom));
}

double MarginalLikelihood::variance(double left) const {
  return std::max(std::max(left, 1e-12) / nu_, least());
}

double MarginalLikelihood::log_evidence(std::span<const Term> terms) const {
  if (terms.empty()) return constant_ + of_noise(yy_, nu_);
  const Block& only = *terms.front().block;
  if (terms.size() > 1 || only.group < 0 || only.columns.size() > kMostLooped) {
    const std::vector<int> columns = unfold(terms).first;
    return log_evidence(terms, gram(columns));
  }
  Small s;
  s.n = static_cast<int>(only.columns.size());
  double half_log_det = 0, explained = 0;
  for (int i = 0; i < s.n; ++i) {
    s.scale[i] = terms.front().size * only.unit[i];
    for (int j = 0; j <= i; ++j) {
      double sum = s.scale[i] * s.scale[j] * product(only.group, i, j) + (i == j ? 1 : 0);
      for (int k = 0; k < j; ++k) sum -= s.L[i][k] * s.L[j][k];
      // I and what is no less than nothing have no pivot below one, but for rounding.
      s.L[i][j] = i == j ? std::sqrt(std::max(sum, 1.0)) : sum / s.L[j][j];
    }
    double z = s.scale[i] * g_[only.columns[static_cast<size_t>(i)]];
    for (int k = 0; k < i; ++k) z -= s.L[i][k] * s.z[k];
    s.z[i] = z / s.L[i][i];
    explained += s.z[i] * s.z[i];
    half_log_det += std::log(s.L[i][i]);
  }
  const double log = constant_ - half_log_det + of_noise(yy_ - explained, nu_);
  if (only.positive.empty()) return log;
  using Rows = Eigen::Matrix<double, kMostLooped, kMostLooped, Eigen::RowMajor>;
  return log + of_signs(terms, Eigen::Map<const Rows>(&s.L[0][0]).topLeftCorner(s.n, s.n),
                        Eigen::Map<const Eigen::VectorXd>(s.z, s.n));
}

double MarginalLikelihood::of_sign(double in_sigmas) const {
  const double probability = student_below_nearly(in_sigmas, nu_);
  return std::log(2 * (kDiagnosis.evidence.right_sign * probability +
                       (1 - kDiagnosis.evidence.right_sign) * (1 - probability)));
}

double MarginalLikelihood::of_signs(std::span<const Term> terms, const Eigen::MatrixXd& L,
                                    const Eigen::VectorXd& z) const {
  const double sigma = std::sqrt(variance(yy_ - z.squaredNorm()));
  double sum = 0;
  Eigen::Index first = 0;
  for (const Term& term : terms) {
    for (const int i : term.block->positive) {
      Eigen::VectorXd one = Eigen::VectorXd::Zero(z.size());
      one[first + i] = 1;
      const Eigen::VectorXd half = solve_lower(L, one);
      sum += of_sign(half.dot(z) / (half.norm() * sigma));
    }
    first += static_cast<Eigen::Index>(term.block->columns.size());
  }
  return sum;
}

double MarginalLikelihood::log_evidence(std::span<const Term> terms,
                                        const Eigen::MatrixXd& G) const {
  const auto [columns, D] = unfold(terms);
  const Eigen::MatrixXd H = Eigen::MatrixXd::Identity(D.size(), D.size()) +
                            Eigen::MatrixXd(D.asDiagonal() * G * D.asDiagonal());
  const Eigen::MatrixXd L = cholesky_root(H);
  if (!L.allFinite()) return -INFINITY;  // alike but for rounding: no set of causes
  const Eigen::VectorXd z = solve_lower(L, D.cwiseProduct(g_(columns)));
  return constant_ - L.diagonal().array().log().sum() + of_noise(yy_ - z.squaredNorm(), nu_) +
         of_signs(terms, L, z);
}

Eigen::VectorXd MarginalLikelihood::log_evidences_of(ObservedRows& observed) const {
  Eigen::VectorXd list = statistics_of(observed, {}, false).yy;
  for (double& each : list) each = constant_ + of_noise(each, nu_);
  return list;
}

}  // namespace selfcal
