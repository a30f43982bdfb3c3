#include "diagnosis/evidence/marginal_likelihood.h"

#include <algorithm>
#include <cmath>

#include "constraints/statistics.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {

Columns::Columns(const Whitened& rows, const Eigen::MatrixXd& root)
    : A(solve_lower(root, rows.A)), C(solve_lower(root, rows.C)) {}

MarginalLikelihood::MarginalLikelihood(std::shared_ptr<const Whitened> rows,
                                       DiscrepancyCovariance structure,
                                       std::shared_ptr<const Groups> groups)
    : MarginalLikelihood(rows, structure, std::move(groups), Columns(*rows, structure.root)) {}

MarginalLikelihood::MarginalLikelihood(std::shared_ptr<const Whitened> rows,
                                       DiscrepancyCovariance structure,
                                       std::shared_ptr<const Groups> groups,
                                       const Columns& columns) {
  Fixed fixed{std::move(rows), std::move(groups), std::move(structure), {}, {}, {}};
  const Eigen::MatrixXd& root = fixed.structure.root;
  const Eigen::Index equations = fixed.rows->A.rows();
  const OrthogonalColumns qr = orthogonal_columns(over_priors(columns.A, fixed.rows->weight));
  fixed.Q = qr.Q;
  constant_ = -qr.log_volume;
  for (Eigen::Index i = 0; i < root.rows(); ++i) constant_ -= std::log(root(i, i));
  // Freedom of the rows alone: each prior determines the share of its parameter that they do not.
  nu_ = static_cast<double>(equations) - fixed.Q.topRows(equations).squaredNorm();
  const Eigen::MatrixXd& C = columns.C;
  fixed.QC = transposed_product(fixed.Q.topRows(equations), C);
  for (const std::vector<int>& group : *fixed.groups) {
    fixed.at.push_back(kept_.size());
    for (const int i : group)
      for (const int j : group)
        kept_.push_back(C.col(i).dot(C.col(j)) - fixed.QC.col(i).dot(fixed.QC.col(j)));
  }
  fixed_ = std::make_shared<const Fixed>(std::move(fixed));
  look_at_rows();
}

Eigen::MatrixXd MarginalLikelihood::beyond_geometry(const Eigen::MatrixXd& X,
                                                    const Eigen::VectorXd& pull) const {
  const Eigen::MatrixXd& Q = fixed_->Q;
  Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(Q.rows(), X.cols());
  Z.topRows(X.rows()) = solve_lower(fixed_->structure.root, X);
  if (pull.size() > 0) Z.bottomRows(pull.size()).colwise() = pull;
  Z.noalias() -= Q * transposed_product(Q, Z);
  return Z;
}

MarginalLikelihood::Views MarginalLikelihood::views_of(const Eigen::MatrixXd& Y) const {
  return views_beyond(beyond_geometry(Y));
}

/// Of what y leave beyond structure and geometry.
MarginalLikelihood::Views MarginalLikelihood::views_beyond(const Eigen::MatrixXd& left) const {
  const Eigen::MatrixXd back =
      solve_lower_transposed(fixed_->structure.root, left.topRows(fixed_->rows->A.rows()));
  // The strain on the priors too: a cause relieves both.
  return {transposed_product(fixed_->rows->C, back), left.colwise().squaredNorm().transpose()};
}

void MarginalLikelihood::look_at(const Views& views, Eigen::Index which) {
  g_ = views.g.col(which);
  yy_ = views.yy[which];
}

void MarginalLikelihood::look_at_rows() {
  look_at(views_beyond(beyond_geometry(fixed_->rows->y, fixed_->rows->pull)), 0);
}

Eigen::MatrixXd MarginalLikelihood::products(const std::vector<int>& a) const {
  const Eigen::MatrixXd back = solve_lower_transposed(
      fixed_->structure.root, solve_lower(fixed_->structure.root, fixed_->rows->C(Eigen::all, a)));
  return transposed_product(back, fixed_->rows->C) -
         fixed_->QC(Eigen::all, a).transpose() * fixed_->QC;
}

Eigen::MatrixXd MarginalLikelihood::gram(const std::vector<int>& a,
                                         const std::vector<int>& b) const {
  if (a.empty() || b.empty())
    return Eigen::MatrixXd(static_cast<Eigen::Index>(a.size()),
                           static_cast<Eigen::Index>(b.size()));
  const Eigen::MatrixXd left = solve_lower(fixed_->structure.root, fixed_->rows->C(Eigen::all, a));
  const Eigen::MatrixXd right = solve_lower(fixed_->structure.root, fixed_->rows->C(Eigen::all, b));
  return transposed_product(left, right) -
         fixed_->QC(Eigen::all, a).transpose() * fixed_->QC(Eigen::all, b);
}

namespace {

constexpr double kRightSign = 0.95;  ///< prior, of the sign that physics allows
constexpr int kMost = 64;

/// One block of at most kMost columns: so small that plain loops on the stack beat any library.
struct Small {
  int n = 0;
  double L[kMost][kMost];
  double z[kMost];
  double scale[kMost];
};

}  // namespace

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
  return value > surely ? log : log + log_chi_square_below(value, freedom);
}

double MarginalLikelihood::variance(double left) const {
  return std::max(std::max(left, 1e-12) / nu_, least());
}

double MarginalLikelihood::log_evidence(std::span<const Term> terms) const {
  if (terms.empty()) return constant_ + of_noise(yy_, nu_);
  const Block& only = *terms.front().block;
  if (terms.size() > 1 || only.group < 0 || only.columns.size() > kMost) {
    const std::vector<int> columns = unfold(terms).first;
    return log_evidence(terms, gram(columns, columns));
  }
  Small s;
  s.n = static_cast<int>(only.columns.size());
  const double* G = block(only.group);
  double half_log_det = 0, explained = 0;
  for (int i = 0; i < s.n; ++i) {
    s.scale[i] = terms.front().size * only.unit[i];
    for (int j = 0; j <= i; ++j) {
      double sum = s.scale[i] * s.scale[j] * G[i * s.n + j] + (i == j ? 1 : 0);
      for (int k = 0; k < j; ++k) sum -= s.L[i][k] * s.L[j][k];
      s.L[i][j] = i == j ? std::sqrt(std::max(sum, 1e-12)) : sum / s.L[j][j];
    }
    double z = s.scale[i] * g_[only.columns[static_cast<size_t>(i)]];
    for (int k = 0; k < i; ++k) z -= s.L[i][k] * s.z[k];
    s.z[i] = z / s.L[i][i];
    explained += s.z[i] * s.z[i];
    half_log_det += std::log(s.L[i][i]);
  }
  const double log = constant_ - half_log_det + of_noise(yy_ - explained, nu_);
  if (only.positive.empty()) return log;
  using Rows = Eigen::Matrix<double, kMost, kMost, Eigen::RowMajor>;
  return log + of_signs(terms, Eigen::Map<const Rows>(&s.L[0][0]).topLeftCorner(s.n, s.n),
                        Eigen::Map<const Eigen::VectorXd>(s.z, s.n));
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
      const double in_sigmas = half.dot(z) / (half.norm() * sigma);
      const double probability = student_below(in_sigmas, nu_);
      sum += std::log(2 * (kRightSign * probability + (1 - kRightSign) * (1 - probability)));
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
  const Eigen::VectorXd z = solve_lower(L, D.cwiseProduct(g_(columns)));
  return constant_ - L.diagonal().array().log().sum() + of_noise(yy_ - z.squaredNorm(), nu_) +
         of_signs(terms, L, z);
}

Eigen::VectorXd MarginalLikelihood::log_evidences_of(const Eigen::MatrixXd& Y) const {
  Eigen::VectorXd list = beyond_geometry(Y).colwise().squaredNorm().transpose();
  for (double& each : list) each = constant_ + of_noise(each, nu_);
  return list;
}

double MarginalLikelihood::gained_without(std::span<const Term> terms, const Eigen::VectorXd& y,
                                          const std::vector<int>& out) const {
  if (out.empty() || terms.empty()) return 0;
  const auto unfolded = unfold(terms);
  const auto& D = unfolded.second;
  Eigen::MatrixXd seen(y.size(), D.size() + 1);  // the terms, then y
  seen << fixed_->rows->C(Eigen::all, unfolded.first) * D.asDiagonal(), y;
  const Eigen::MatrixXd X = beyond_geometry(seen);
  // An equation left out is one with an unknown of its own.
  Eigen::MatrixXd alone = Eigen::MatrixXd::Zero(y.size(), static_cast<Eigen::Index>(out.size()));
  for (size_t i = 0; i < out.size(); ++i) alone(out[i], static_cast<Eigen::Index>(i)) = 1;
  const Eigen::MatrixXd free = beyond_geometry(alone);
  const auto gain = [&](const Eigen::MatrixXd& of, double freedom) {
    const auto c = of.leftCols(D.size());
    const Eigen::MatrixXd L =
        cholesky_root(Eigen::MatrixXd::Identity(D.size(), D.size()) + c.transpose() * c);
    const double all = of.col(D.size()).squaredNorm();
    const double explained = solve_lower(L, c.transpose() * of.col(D.size())).squaredNorm();
    return of_noise(all - explained, freedom) - of_noise(all, freedom) -
           L.diagonal().array().log().sum();
  };
  const Eigen::MatrixXd Q = orthogonal_columns(free).Q;
  const Eigen::MatrixXd less = X - Q * (Q.transpose() * X).eval();
  return gain(less, nu_ - static_cast<double>(out.size())) - gain(X, nu_);
}

MarginalLikelihood MarginalLikelihood::given(std::span<const Term> terms) const {
  MarginalLikelihood rest = *this;
  if (terms.empty()) return rest;
  const auto [columns, D] = unfold(terms);
  const Eigen::MatrixXd G = products(columns);
  const Eigen::MatrixXd H =
      Eigen::MatrixXd::Identity(D.size(), D.size()) +
      Eigen::MatrixXd(D.asDiagonal() * G(Eigen::all, columns) * D.asDiagonal());
  const Eigen::MatrixXd L = cholesky_root(H);
  const Eigen::MatrixXd seen = solve_lower(L, D.asDiagonal() * G);
  const Eigen::VectorXd z = solve_lower(L, D.cwiseProduct(g_(columns)));
  std::size_t at = 0;
  for (const std::vector<int>& group : *fixed_->groups)
    for (const int i : group)
      for (const int j : group) rest.kept_[at++] -= seen.col(i).dot(seen.col(j));
  rest.g_ -= seen.transpose() * z;
  rest.yy_ -= z.squaredNorm();
  rest.constant_ += of_signs(terms, L, z) - L.diagonal().array().log().sum();
  return rest;
}

MarginalLikelihood::Estimate MarginalLikelihood::estimate(std::span<const Term> terms) const {
  if (terms.empty()) return {{}, {}, variance(yy_)};
  const auto [columns, D] = unfold(terms);
  const Eigen::MatrixXd H =
      Eigen::MatrixXd::Identity(D.size(), D.size()) +
      Eigen::MatrixXd(D.asDiagonal() * gram(columns, columns) * D.asDiagonal());
  const Eigen::MatrixXd inverse = inverse_of_positive(H);
  Estimate estimate;
  const Eigen::VectorXd g = D.cwiseProduct(g_(columns));
  estimate.mean = D.cwiseProduct(inverse * g);
  estimate.covariance = D.asDiagonal() * inverse * D.asDiagonal();
  estimate.variance = variance(yy_ - g.dot(inverse * g));
  return estimate;
}

}  // namespace selfcal
