// W^T W of rows that come in pieces: half the work of a triangular factor and none of its waiting,
// for half of its digits.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace selfcal {

/// Keeps the products of all columns of the rows added so far. Each row costs about columns^2
/// operations.
class ColumnProducts {
 public:
  explicit ColumnProducts(int columns);

  /// Adds rows whose count is a multiple of kernels::kMultiple, stored whole.
  void add(const Eigen::MatrixXd& rows);
  /// Adds rows (any count).
  void push(const Eigen::Ref<const Eigen::MatrixXd>& rows);
  /// W^T W, columns x columns.
  Eigen::MatrixXd sum();

 private:
  bool wide() const { return square_.size() > 0; }

  Eigen::Index columns_, filled_ = 0;
  Eigen::MatrixXd buffer_;
  std::vector<double> sums_;  ///< of few columns, as kernels::add_column_products keeps them
  Eigen::MatrixXd square_;    ///< of many, whose sums no cache would hold: its lower triangle
};

}  // namespace selfcal
