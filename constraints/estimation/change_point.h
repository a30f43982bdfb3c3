// A step in the mean of rows that come in an order.
#pragma once

#include <Eigen/Dense>
#include <optional>

namespace selfcal {

struct ChangePoint {
  int at = 0;            ///< the first row after it
  Eigen::VectorXd step;  ///< mean after it less mean before
  double statistic = 0;  ///< n1 n2 / (n1 + n2) |step|^2 / sigma^2
  double p_value = 1;    ///< of rows without a step, for as many splits as were tried
};

/// The split of `all` rows (rows x equations) with the largest statistic, `fewest` rows or more on
/// either side; nothing of fewer than twice as many. sigma, of one equation, is taken from the
/// differences of successive rows, which a step leaves alone, and is `least_sigma` or more. A false
/// row between good ones is no step.
std::optional<ChangePoint> change_point(const Eigen::MatrixXd& all, double least_sigma, int fewest);

}  // namespace selfcal
