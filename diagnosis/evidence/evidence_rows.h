// The rows in the form that every structure of the noise shares, so that a structure costs no more
// than what is its own: S = s L (I + kappa^2 W diag(variance) W') L', S^-1 = (P - U diag(h) U') /
// s,
//   P = L^-T L^-1,  U = L^-T W,  h = kappa^2 variance / (1 + kappa^2 variance).
// P A, U'A, U'C and the like are made once for all sizes kappa and scales s.
#pragma once

#include <Eigen/Dense>
#include <memory>
#include <vector>

#include "diagnosis/evidence/kernel_basis.h"
#include "diagnosis/evidence/noise_blocks.h"
#include "diagnosis/evidence/whitened.h"

namespace selfcal {

/// Columns of C that are weighed together: their products are kept.
using Groups = std::vector<std::vector<int>>;

/// Covariance of noise, and of one structure of what no known effect explains.
struct DiscrepancyCovariance {
  int kind = 0;                                    ///< 0: noise alone; else a KernelDomain
  int joint = -1;                                  ///< whose errors it is of; -1: of none
  double kappa = 0;                                ///< size of the structure over the noise
  std::shared_ptr<const NoiseBlocks> blocks = {};  ///< L
  std::shared_ptr<const KernelBasis> kernel = {};  ///< W and its variances; null where it is in L
  double noise = 1;                                ///< s: variance of its noise part
  double probability = 1;  ///< prior, among those of noise alone or among those of structure

  /// kappa^2 variance / (1 + kappa^2 variance) of each direction of the kernel.
  Eigen::VectorXd hidden() const;
  /// log |S| / 2.
  double log_volume() const;
  /// A draw of it, from a `normal` one of the equations' number: by its lower Cholesky factor.
  Eigen::VectorXd coloured(const Eigen::VectorXd& normal) const;
  /// S itself, equations x equations.
  Eigen::MatrixXd matrix() const;
};

/// Products of columns by a group's own columns, lower triangles one after the other.
class GroupProducts {
 public:
  explicit GroupProducts(const Groups& groups);
  std::size_t size() const { return size_; }
  std::size_t at(int group) const { return at_[static_cast<std::size_t>(group)]; }
  /// Of X' X for columns X as C's, added times `factor` to `to`.
  void add(const Eigen::MatrixXd& X, double factor, std::vector<double>& to) const;
  /// Of X' diag(weight) X for each column of `weights`: rows of the result are the products.
  Eigen::MatrixXd weighted(const Eigen::MatrixXd& X, const Eigen::MatrixXd& weights) const;

 private:
  struct Pair {
    int first, second;  ///< columns
  };
  std::vector<Pair> pairs_;
  std::vector<std::size_t> at_;
  std::size_t size_ = 0;
};

class EvidenceRows {
 public:
  EvidenceRows(std::shared_ptr<const Whitened> rows, const Groups& groups);

  const Whitened& rows() const { return *rows_; }
  const GroupProducts& products() const { return products_; }
  /// The geometry's columns over its priors, made orthonormal: A over B.
  const Eigen::MatrixXd& A() const { return A_; }
  const Eigen::MatrixXd& B() const { return B_; }
  double log_volume() const { return log_volume_; }  ///< of what was made orthonormal
  /// What the geometry and the columns `causes` of C with priors `sigma` leave of `y`, fitted in
  /// noise of one, no strain on the priors.
  Eigen::VectorXd left_of(const Eigen::VectorXd& y, const std::vector<int>& causes,
                          const Eigen::VectorXd& sigma) const;

  /// What structures of one noise share.
  struct OverNoise {
    std::shared_ptr<const NoiseBlocks> blocks;
    Eigen::MatrixXd PA;            ///< P A
    Eigen::MatrixXd AA, AC;        ///< A'P A, A'P C
    std::vector<double> products;  ///< of the groups, in P
  };
  /// What structures of one kernel share beside that.
  struct OverKernel {
    std::shared_ptr<const KernelBasis> kernel;
    Eigen::MatrixXd UA, UC;  ///< U'A, U'C
  };
  OverNoise over(std::shared_ptr<const NoiseBlocks> blocks) const;
  OverKernel over(const NoiseBlocks& blocks, std::shared_ptr<const KernelBasis> kernel) const;

 private:
  std::shared_ptr<const Whitened> rows_;
  GroupProducts products_;
  Eigen::MatrixXd A_, B_;
  double log_volume_ = 0;
};

/// One structure at a noise of one (s = 1): what it takes to weigh causes at any noise.
struct StructuredRows {
  std::shared_ptr<const EvidenceRows> rows;
  std::shared_ptr<const EvidenceRows::OverNoise> noise = {};
  std::shared_ptr<const EvidenceRows::OverKernel> kernel = {};  ///< null without one
  Eigen::VectorXd hidden = {};
  Eigen::MatrixXd AA = {};  ///< A'S^-1 A

  /// Goes over to another structure: what it shares with the last one stays.
  void take(const DiscrepancyCovariance& structure);
  /// S^-1 X.
  Eigen::MatrixXd inverse_times(Eigen::MatrixXd X) const;
  /// X becomes a root of S^-1 times X: its square is X'S^-1 X.
  void whiten(Eigen::MatrixXd& X) const;
  /// A'S^-1 C, and that of some columns of C.
  Eigen::MatrixXd AC() const;
  Eigen::MatrixXd AC(const std::vector<int>& columns) const;
  std::vector<double> products() const;
};

/// Several y, one a column, as structures see them: what is shared is made once, as long as the
/// structures come in order.
class ObservedRows {
 public:
  ObservedRows(const EvidenceRows& rows, Eigen::MatrixXd Y, bool with_causes);
  Eigen::Index count() const { return Y_.cols(); }
  void look_over(const StructuredRows& structure);
  /// At a noise of one: A'S^-1 Y, and y'S^-1 y by column.
  Eigen::MatrixXd AY(const StructuredRows& structure) const;
  Eigen::VectorXd squares(const StructuredRows& structure) const;
  const Eigen::MatrixXd& CY() const { return CY_; }  ///< C'P Y
  const Eigen::MatrixXd& UY() const { return UY_; }

 private:
  const EvidenceRows& rows_;
  const Eigen::MatrixXd Y_;
  const bool with_causes_;
  std::shared_ptr<const EvidenceRows::OverNoise> noise_;
  std::shared_ptr<const EvidenceRows::OverKernel> kernel_;
  Eigen::MatrixXd white_;  ///< L^-1 Y
  Eigen::MatrixXd AY_, CY_, UY_;
  Eigen::VectorXd squares_;
};

}  // namespace selfcal
