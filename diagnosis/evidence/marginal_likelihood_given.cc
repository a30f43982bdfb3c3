// What several terms leave to others, and what the rows say of their parameters.
#include <cmath>

#include "diagnosis/evidence/marginal_likelihood.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr double kAbsorbed = 1e-10;  ///< of an equation's square, that is nothing of its own

}  // namespace

double MarginalLikelihood::gained_without(std::span<const Term> terms, const Eigen::VectorXd& y,
                                          const std::vector<int>& out) const {
  if (out.empty() || terms.empty()) return 0;
  const auto unfolded = unfold(terms);
  const auto& D = unfolded.second;
  const Eigen::Index n = D.size() + 1;  // the terms, then y, then what is left out
  // An equation left out is one with an unknown of its own.
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(y.size(), n + static_cast<Eigen::Index>(out.size()));
  X.leftCols(n - 1) = rows().rows().C(Eigen::all, unfolded.first) * D.asDiagonal();
  X.col(n - 1) = y;
  for (size_t i = 0; i < out.size(); ++i) X(out[i], n + static_cast<Eigen::Index>(i)) = 1;
  const Eigen::MatrixXd all = transposed_product(X, beyond_geometry(X));
  const auto gain = [&](const Eigen::MatrixXd& G, double freedom) {
    const Eigen::MatrixXd L =
        cholesky_root(Eigen::MatrixXd::Identity(n - 1, n - 1) + G.topLeftCorner(n - 1, n - 1));
    const double square = G(n - 1, n - 1);
    const double explained =
        solve_lower(L, Eigen::VectorXd(G.col(n - 1).head(n - 1))).squaredNorm();
    return of_noise(square - explained, freedom) - of_noise(square, freedom) -
           L.diagonal().array().log().sum();
  };
  const Symmetric own = symmetric_eigen(all.bottomRightCorner(all.rows() - n, all.cols() - n));
  const double least = kAbsorbed * own.values.cwiseAbs().maxCoeff();
  const Eigen::VectorXd inverse =
      (own.values.array() > least).select(own.values.cwiseInverse(), 0.0);
  const Eigen::MatrixXd shared = own.vectors.transpose() * all.bottomLeftCorner(all.rows() - n, n);
  const Eigen::MatrixXd less =
      all.topLeftCorner(n, n) - shared.transpose() * inverse.asDiagonal() * shared;
  return gain(less, nu_ - static_cast<double>(out.size())) - gain(all.topLeftCorner(n, n), nu_);
}

MarginalLikelihood MarginalLikelihood::given(std::span<const Term> terms) const {
  return terms.empty() ? *this : given(terms, products(unfold(terms).first));
}

MarginalLikelihood MarginalLikelihood::given(std::span<const Term> terms,
                                             const Eigen::MatrixXd& products) const {
  MarginalLikelihood rest = *this;
  const auto [columns, D] = unfold(terms);
  const Eigen::MatrixXd H =
      Eigen::MatrixXd::Identity(D.size(), D.size()) +
      Eigen::MatrixXd(D.asDiagonal() * products(Eigen::all, columns) * D.asDiagonal());
  const Eigen::MatrixXd L = cholesky_root(H);
  if (!L.allFinite()) {  // alike but for rounding: no set of causes
    rest.constant_ = -INFINITY;
    return rest;
  }
  const Eigen::MatrixXd seen = solve_lower(L, D.asDiagonal() * products);
  const Eigen::VectorXd z = solve_lower(L, D.cwiseProduct(g_(columns)));
  rows().products().add(seen, -1, rest.kept_);
  rest.g_ -= seen.transpose() * z;
  rest.yy_ -= z.squaredNorm();
  rest.constant_ += of_signs(terms, L, z) - L.diagonal().array().log().sum();
  return rest;
}

MarginalLikelihood::Estimate MarginalLikelihood::estimate(std::span<const Term> terms) const {
  return estimate(terms, gram(unfold(terms).first));
}

MarginalLikelihood::Estimate MarginalLikelihood::estimate(std::span<const Term> terms,
                                                          const Eigen::MatrixXd& G) const {
  if (terms.empty()) return {{}, {}, variance(yy_)};
  const auto [columns, D] = unfold(terms);
  const Eigen::MatrixXd H = Eigen::MatrixXd::Identity(D.size(), D.size()) +
                            Eigen::MatrixXd(D.asDiagonal() * G * D.asDiagonal());
  const Eigen::MatrixXd inverse = inverse_of_positive(H);
  Estimate estimate;
  const Eigen::VectorXd g = D.cwiseProduct(g_(columns));
  estimate.mean = D.cwiseProduct(inverse * g);
  estimate.covariance = D.asDiagonal() * inverse * D.asDiagonal();
  estimate.variance = variance(yy_ - g.dot(inverse * g));
  return estimate;
}

Eigen::VectorXd MarginalLikelihood::mean(std::span<const Term> terms) const {
  // (I + Z Z')^-1 h = h - Z (I + Z'Z)^-1 Z'h: there may be more columns than equations.
  const auto [columns, D] = unfold(terms);
  if (columns.empty()) return D;
  const Eigen::VectorXd h = D.cwiseProduct(g_(columns));
  const Eigen::MatrixXd Z = D.asDiagonal() * root_of_gram(columns).transpose();
  Eigen::MatrixXd H = transposed_product(Z, Z);
  H.diagonal().array() += 1;
  const Eigen::MatrixXd L = cholesky_root(std::move(H));
  const Eigen::VectorXd Zh = Z.transpose() * h;
  return D.cwiseProduct(h - Z * solve_lower_transposed(L, solve_lower(L, Zh)));
}

}  // namespace selfcal
