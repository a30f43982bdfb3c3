// R of a QR decomposition of rows that come in pieces: the observation matrix is never stored
// whole.
#pragma once

#include <Eigen/Dense>

namespace selfcal {

/// Keeps R (columns x columns, upper triangular) of all rows pushed so far. Memory is a few times
/// columns^2 whatever the count of rows; each row costs about 3 columns^2 operations.
class StreamingQr {
 public:
  explicit StreamingQr(int columns);

  /// Appends rows (any count, `columns` wide).
  void push(const Eigen::Ref<const Eigen::MatrixXd>& rows);
  /// R such that R^T R = W^T W over all rows.
  Eigen::MatrixXd R();

 private:
  void reduce();

  Eigen::Index columns_, filled_ = 0;
  Eigen::MatrixXd buffer_;  // the current R on top, new rows below
};

}  // namespace selfcal
