// The evidence for sets of causes, with the geometry integrated out.
//
// Whitened rows y = A a + C v + u + e: a geometry and the sets' nuisance parameters (Gaussian
// priors, own ones without), v the effects' parameters, e noise of one unknown variance s^2 and u
// structure that no known effect explains, of covariance s^2 kappa^2 K. For a set S of candidates
// with prior v ~ N(0, s^2 V) the integral over a, v and s (prior 1/s) is
//   log p(y | S) = const(K) - 1/2 log|I + V G| - nu/2 log Q,   Q = y'My - g'(V^-1 + G)^-1 g
// with M the projection beyond the whitened geometry, G = C'MC, g = C'My; and where s is s0 at
// least, + log P(chi-square of nu freedoms < Q / s0^2). g is made once for each K and y, and of G,
// which is far larger than the rows, only the blocks of what is weighed alone; a set of several
// adds the products between them. nu counts what the rows alone determine; the noise of each K is
// taken to be right already (EvidenceEvaluator::agree).
//
// Where physics knows the sign of a parameter, its prior has 0.95 of its mass there: the evidence
// gains log(2 (0.95 P + 0.05 (1 - P))), P the probability of that sign that the rows leave it (each
// such parameter by itself; those of `given` terms as they stood without the others).
#pragma once

#include <Eigen/Dense>
#include <memory>
#include <span>
#include <vector>

#include "diagnosis/evidence/whitened.h"

namespace selfcal {

/// Noise, and one structure of what no known effect explains.
struct DiscrepancyCovariance {
  int kind = 0;            ///< 0: noise alone
  double kappa = 0;        ///< its size over the noise
  Eigen::MatrixXd root;    ///< lower Cholesky factor of the covariance
  double noise = 1;        ///< variance of its noise part
  double probability = 1;  ///< prior, among those of noise alone or among those of structure
};

/// A group of columns of C with one prior: v = size * unit * N(0, 1).
struct Block {
  std::vector<int> columns;
  Eigen::VectorXd unit;            ///< prior sigma of each at a size of one
  int group = -1;                  ///< its place in the workbench's groups; -1: it is in none
  std::vector<int> positive = {};  ///< places of those that physics allows no other sign
};

/// Columns of C that are weighed together: a workbench keeps their products.
using Groups = std::vector<std::vector<int>>;

/// The rows' columns as a structure's noise leaves them: L^-1 A, L^-1 C with L its root.
struct Columns {
  Columns(const Whitened& rows, const Eigen::MatrixXd& root);
  Eigen::MatrixXd A, C;
};

class MarginalLikelihood {
 public:
  MarginalLikelihood(std::shared_ptr<const Whitened> rows, DiscrepancyCovariance structure,
                     std::shared_ptr<const Groups> groups);
  /// With the columns of that structure already at hand.
  MarginalLikelihood(std::shared_ptr<const Whitened> rows, DiscrepancyCovariance structure,
                     std::shared_ptr<const Groups> groups, const Columns& columns);
  const DiscrepancyCovariance& structure() const { return fixed_->structure; }

  /// What several y say, one a column, without a strain on the priors: made together, for then it
  /// costs a tenth, and looked at one after the other.
  struct Views {
    Eigen::MatrixXd g;   ///< columns of C x y
    Eigen::VectorXd yy;  ///< by y
  };
  Views views_of(const Eigen::MatrixXd& Y) const;
  /// Exchanges y.
  void look_at(const Views& views, Eigen::Index which);
  /// Goes back to that of the rows.
  void look_at_rows();

  struct Term {
    const Block* block;
    double size;
  };
  /// The same rows with `terms` integrated out as the geometry is: what they leave for one other
  /// block of its groups. It can neither look at another y nor be given more.
  MarginalLikelihood given(std::span<const Term> terms) const;
  /// log p(y | terms), without the constant that all structures and terms share.
  double log_evidence(std::span<const Term> terms) const;
  /// The same for any number of terms, from G of their columns (as gram() gives it) in their order.
  double log_evidence(std::span<const Term> terms, const Eigen::MatrixXd& G) const;
  /// What each column of `Y` as y (no strain on the priors) says without any term.
  Eigen::VectorXd log_evidences_of(const Eigen::MatrixXd& Y) const;
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

  /// Of G, rows a by columns b.
  Eigen::MatrixXd gram(const std::vector<int>& a, const std::vector<int>& b) const;
  /// Columns of the terms, one after the other, and the prior sigma of each.
  static std::pair<std::vector<int>, Eigen::VectorXd> unfold(std::span<const Term> terms);
  const Eigen::VectorXd& right() const { return g_; }
  double total() const { return yy_; }
  double freedom() const { return nu_; }
  /// Columns of `X` (equations) beyond structure and geometry, with the strain on the priors
  /// (columns of A; none where it has no rows) under each.
  Eigen::MatrixXd beyond_geometry(const Eigen::MatrixXd& X, const Eigen::VectorXd& pull = {}) const;

 private:
  /// What does not depend on y.
  struct Fixed {
    std::shared_ptr<const Whitened> rows;
    std::shared_ptr<const Groups> groups;
    DiscrepancyCovariance structure;
    Eigen::MatrixXd Q;            ///< of the whitened geometry and its priors
    Eigen::MatrixXd QC;           ///< geometry x columns: what the geometry holds of each column
    std::vector<std::size_t> at;  ///< of each group's block in `kept_`
  };
  MarginalLikelihood() = default;
  Views views_beyond(const Eigen::MatrixXd& left) const;
  /// a by all columns of G.
  Eigen::MatrixXd products(const std::vector<int>& a) const;
  const double* block(int group) const { return &kept_[fixed_->at[group]]; }
  /// s^2 at least.
  double least() const { return fixed_->rows->least / fixed_->structure.noise; }
  /// The part of the log evidence that the noise decides, where `left` squares (Q) of `freedom` are
  /// not explained.
  double of_noise(double left, double freedom) const;
  /// s^2 where `left` squares are not explained.
  double variance(double left) const;
  /// What the signs of the terms' parameters add to the log evidence. L: lower Cholesky factor of
  /// I + D G D, z = L^-1 D g.
  double of_signs(std::span<const Term> terms, const Eigen::MatrixXd& L,
                  const Eigen::VectorXd& z) const;

  std::shared_ptr<const Fixed> fixed_;
  std::vector<double> kept_;  ///< the groups' blocks of G, one after the other
  Eigen::VectorXd g_;
  double yy_ = 0, nu_ = 0, constant_ = 0;
};

}  // namespace selfcal
