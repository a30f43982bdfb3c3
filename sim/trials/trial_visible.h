// How much of a deviation calibration leaves, and how far a fit that is told the cause would close
// the gap.
#pragma once

#include <optional>

#include "sim/trials/trial_session.h"

namespace selfcal {

/// The rows' equations with the geometry's columns (links, gears, base, tool, planes), whitened by
/// `noise` (m) and the makers' priors.
class TrialCalibration {
 public:
  TrialCalibration(const TrialSession& session, double noise);

  /// By equation, what a shift of the tip in each row (rows x 3, m) means, over the noise.
  Eigen::VectorXd seen(const Eigen::MatrixXd& shifts) const;

  /// Root mean square over the rows that identify: whole, and beyond what geometry takes up.
  struct Size {
    double whole = 0, visible = 0;
  };
  Size size(const Eigen::VectorXd& seen) const;

  /// Closed fraction on the rows kept aside of a fit to `y` that is told the columns `causes`
  /// (equations x causes), as diagnosis.json counts it; nothing where geometry alone leaves noise.
  std::optional<double> told_closed(const Eigen::VectorXd& y, const Eigen::MatrixXd& causes) const;

 private:
  Eigen::VectorXd left(const Eigen::VectorXd& y, const Eigen::MatrixXd& causes) const;

  Eigen::MatrixXd A_;       ///< equations x geometry
  Eigen::VectorXd weight_;  ///< by column: 1 / sigma of its prior, 0 without
  Eigen::MatrixXd along_;   ///< equations x 3: direction that the equation measures, over the noise
  std::vector<int> row_, fit_, check_;
};

}  // namespace selfcal
