// R of a QR decomposition of rows that come in pieces: the observation matrix is never stored
// whole.
#pragma once

#include <Eigen/Dense>

namespace selfcal {

/// Keeps R (columns x columns, upper triangular) of all rows pushed so far. Memory is that of R and
/// of rows that fit the fastest cache; each row costs about 2 columns^2 operations.
class StreamingQr {
 public:
  explicit StreamingQr(int columns);

  /// Appends rows (any count, `columns` wide).
  void push(const Eigen::Ref<const Eigen::MatrixXd>& rows);
  /// R such that R^T R = W^T W over all rows.
  const Eigen::MatrixXd& R();
  /// What says the same: the rows as they came where they are no more than R's, else R.
  Eigen::MatrixXd rows();

 private:
  void reduce();

  Eigen::Index filled_ = 0;
  bool reduced_ = false;
  Eigen::MatrixXd R_, buffer_;  ///< of the rows before, the rows since
};

}  // namespace selfcal
