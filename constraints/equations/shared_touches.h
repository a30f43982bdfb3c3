// Rows that share a touch: differences of successive touches, r_k = x_k - x_{k-1}, are not
// independent. With equal noise of the touches neighbours correlate by -1/2.
#pragma once

#include <Eigen/Dense>
#include <map>

namespace selfcal {

/// Makes successive rows independent as they pass (Cholesky factor of the correlation, row by row):
///   v_1 = s_1,   v_k = (s_k - a_k v_{k-1}) / b_k,   a_k = -1 / (2 b_{k-1}),   b_k^2 = 1 - a_k^2.
class SharedTouches {
 public:
  using Row = Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>>;

  /// `s` is the row of touch `row` less touch `previous`, over its sigma. A row of zeros was put
  /// aside: the next one begins anew.
  void whiten(int row, int previous, Row s);

 private:
  struct Last {
    Eigen::RowVectorXd v;
    double b = 1;
  };
  std::map<int, Last> by_touch_;  ///< by the row that the next one may share; one a chain
};

}  // namespace selfcal
