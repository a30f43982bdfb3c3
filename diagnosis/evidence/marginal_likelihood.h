// The evidence for sets of causes, with the geometry integrated out.
//
// Whitened rows y = A a + C v + u + e: a geometry and the sets' nuisance parameters (Gaussian
// priors, own ones without), v the effects' parameters, e noise of one unknown variance s^2 and u
// structure that no known effect explains, of covariance s^2 kappa^2 K. For a set S of candidates
// with prior v ~ N(0, s^2 V) the integral over a, v and s (prior 1/s) is
//   log p(y | S) = const(K) - 1/2 log|I + V G| - nu/2 log Q,   Q = y'My - g'(V^-1 + G)^-1 g
// with M the projection beyond the whitened geometry, G = C'MC, g = C'My; and where s is s0 at
// least, + log P(chi-square of nu freedoms < Q / s0^2). With the geometry's orthonormal columns A
// over B (EvidenceRows) and S the covariance of u + e,
//   M = S^-1 - S^-1 A (A'S^-1 A + B'B)^-1 A'S^-1
// g is made once for each K and y, and of G, which is far larger than the rows, only the blocks of
// what is weighed alone; a set of several adds the products between them. nu counts what the rows
// alone determine; the noise of each K is taken to be right already (EvidenceEvaluator::agree).
//
// Where physics knows the sign of a parameter, its prior has 0.95 of its mass there: the evidence
// gains log(2 (0.95 P + 0.05 (1 - P))), P the probability of that sign that the rows leave it (each
// such parameter by itself; those of `given` terms as they stood without the others).
#pragma once

#include <Eigen/Dense>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "diagnosis/evidence/evidence_rows.h"
#include "diagnosis/evidence/tails.h"

namespace selfcal {

/// Columns of a block that plain loops on the stack weigh; with more it takes a library.
inline constexpr std::size_t kMostLooped = 64;

/// A group of columns of C with one prior: v = size * unit * N(0, 1).
struct Block {
  std::vector<int> columns;
  Eigen::VectorXd unit;            ///< prior sigma of each at a size of one
  int group = -1;                  ///< its place among the groups; -1: it is in none
  std::vector<int> positive = {};  ///< places of those that physics allows no other sign
};

class MarginalLikelihood {
 public:
  /// By itself; many share what their structures have in common in the other way.
  MarginalLikelihood(std::shared_ptr<const Whitened> rows, DiscrepancyCovariance structure,
                     const Groups& groups);
  /// `seen` is of that structure, `AC` and `products` are its A'S^-1 C and group products, `own`
  /// are the rows' y.
  MarginalLikelihood(StructuredRows seen, DiscrepancyCovariance structure,
                     const Eigen::MatrixXd& AC, std::vector<double> products, ObservedRows& own);
  const DiscrepancyCovariance& structure() const { return fixed_->structure; }
  const EvidenceRows& rows() const { return *fixed_->seen.rows; }

  /// Sufficient statistics of several y, one a column, without a strain on the priors: made
  /// together, for then it costs a tenth, and conditioned on one after the other.
  struct Statistics {
    Eigen::MatrixXd g;   ///< columns of C x y
    Eigen::VectorXd yy;  ///< by y
  };
  Statistics statistics_of(const Eigen::MatrixXd& Y) const;
  /// The same of rows that other structures have too.
  Statistics statistics_of(ObservedRows& observed) const;
  /// Exchanges y.
  void condition_on(const Statistics& statistics, Eigen::Index which);
  /// Goes back to that of the rows.
  void condition_on_rows();

  struct Term {
    const Block* block;
    double size;
  };
  /// The same rows with `terms` integrated out as the geometry is: what they leave for one other
  /// block of its groups. It can neither exchange y nor be given more.
  MarginalLikelihood given(std::span<const Term> terms) const;
  /// With products(columns) of the terms' columns at hand.
  MarginalLikelihood given(std::span<const Term> terms, const Eigen::MatrixXd& products) const;
  /// log p(y | terms), without the constant that all structures and terms share.
  double log_evidence(std::span<const Term> terms) const;
  /// The same for any number of terms, from G of their columns (as gram() gives it) in their order.
  double log_evidence(std::span<const Term> terms, const Eigen::MatrixXd& G) const;
  /// Of a block that is in a group, what any y is weighed by: with D G D = U diag(value) U' the log
  /// of its volume at each of `sizes`, value, U by column.
  void add_spectrum(const Block& block, std::span<const double> sizes,
                    std::vector<double>& to) const;
  static std::size_t spectrum_size(const Block& block, std::size_t sizes);
  /// The log evidence of one block at each of `sizes`, from its spectrum, into `logs`.
  void log_evidences(const Block& block, std::span<const double> sizes, const double* spectrum,
                     double* logs) const;
  /// No less than the log evidence of one block at any size; infinite where that is not known
  /// cheaply.
  double at_most(const Block& block) const;
  /// What each of the rows' y says without any term, no strain on the priors.
  Eigen::VectorXd log_evidences_of(ObservedRows& observed) const;
  /// By how much the terms' log evidence over that of none grows when equations `out` of `y` are
  /// left out; signs are not asked.
  double gained_without(std::span<const Term> terms, const Eigen::VectorXd& y,
                        const std::vector<int>& out) const;
  /// Posterior means of the terms' columns, one after the other, and their covariance over s^2.
  struct Estimate {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
    double variance = 1;  ///< s^2
  };
  Estimate estimate(std::span<const Term> terms) const;
  /// The same from G of their columns (as gram() gives it) in their order.
  Estimate estimate(std::span<const Term> terms, const Eigen::MatrixXd& G) const;
  /// The means alone, of any number of terms.
  Eigen::VectorXd mean(std::span<const Term> terms) const;

  /// Of G: two columns of a group, by their places in it.
  double product(int group, Eigen::Index i, Eigen::Index j) const {
    const auto at = static_cast<std::size_t>(i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i);
    return kept_[rows().products().at(group) + at];
  }
  /// Of G, rows and columns `columns`.
  Eigen::MatrixXd gram(const std::vector<int>& columns) const;
  /// The same of a block, at no cost where it is in a group.
  Eigen::MatrixXd gram(const Block& block) const;
  /// a by all columns of G.
  Eigen::MatrixXd products(const std::vector<int>& a) const;
  /// Columns of the terms, one after the other, and the prior sigma of each.
  static std::pair<std::vector<int>, Eigen::VectorXd> unfold(std::span<const Term> terms);
  const Eigen::VectorXd& right() const { return g_; }
  double total() const { return yy_; }
  double freedom() const { return nu_; }

 private:
  /// What does not depend on y.
  struct Fixed {
    StructuredRows seen;
    DiscrepancyCovariance structure;
    Eigen::MatrixXd root;  ///< lower Cholesky factor of A'S^-1 A + B'B
    NoiseTail tail;
  };
  MarginalLikelihood() = default;
  /// M X: what of S^-1 X is beyond the geometry.
  Eigen::MatrixXd beyond_geometry(const Eigen::MatrixXd& X) const;
  /// Z with Z'Z of G, rows and columns `columns`: equations and geometry x columns.
  Eigen::MatrixXd root_of_gram(const std::vector<int>& columns) const;
  Statistics statistics_of(ObservedRows& observed, const Eigen::VectorXd& pull,
                           bool with_causes) const;
  /// s^2 at least.
  double least() const { return rows().rows().least / fixed_->structure.noise; }
  /// The part of the log evidence that the noise decides, where `left` squares (Q) of `freedom` are
  /// not explained.
  double of_noise(double left, double freedom) const;
  /// s^2 where `left` squares are not explained.
  double variance(double left) const;
  /// What the sign that physics allows adds, where its estimate lies `in_sigmas` on its side.
  double of_sign(double in_sigmas) const;
  /// What the signs of the terms' parameters add to the log evidence. L: lower Cholesky factor of
  /// I + D G D, z = L^-1 D g.
  double of_signs(std::span<const Term> terms, const Eigen::MatrixXd& L,
                  const Eigen::VectorXd& z) const;

  std::shared_ptr<const Fixed> fixed_;
  std::shared_ptr<const Statistics> of_rows_;
  std::vector<double> kept_;  ///< the groups' blocks of G, lower triangles one after the other
  Eigen::VectorXd g_;
  double yy_ = 0, nu_ = 0, constant_ = 0;
};

}  // namespace selfcal
