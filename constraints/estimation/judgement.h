// The judge: residual figures before and after, on rows that identified and on rows kept aside, and
// the answer that follows from them.
#pragma once

#include <string>
#include <vector>

#include "constraints/fitting/fit.h"
#include "constraints/solution.h"

namespace selfcal {

/// Residuals of one model (before or after) on every row that counts.
struct Judged {
  std::vector<RowResidual> fit, check;
  std::vector<RowNorm> fit_norms;  ///< in place of `fit`, where these alone were asked for
  /// Of those of them that Residuals::rows shows.
  std::vector<RowPlace> fit_places, check_places;
  std::vector<OpenRow> open, open_check;  ///< rows that gave no equation
  std::vector<Scale> check_scale;         ///< by set: the noise that a check row is compared with
  std::vector<char> aligned;  ///< by set: nuisance parameters were fitted to the check rows
  /// By `check` row, beyond the noise: as far as what predicts it is in doubt (prediction.h).
  /// Empty where nobody asked.
  std::vector<char> foreseen;
  State state;  ///< with the aligned unknowns filled in
  Noise align_noise;
};

/// Fits the unknowns of sets and groups that have only `check` rows with the robot of `fit` held,
/// and takes the residuals of all rows; with `norms_alone` of the rows that identify no more than
/// their norms, which take a fifth of the memory.
Judged judge(const Robot& robot, const DataSet& data, const Equations& fit_equations,
             const Fit& fit, bool norms_alone = false);

/// The far quantile of NoiseRule: what would have been put aside among the rows that identify.
inline constexpr double kOutlierQuantile = NoiseRule{}.outlier_quantile;
/// A `check` row that would have been put aside.
bool is_outlier(const RowResidual& r, const Judged& judged);

/// Its `check` rows, each for a configuration of its own.
std::vector<CheckRow> check_rows(const Judged& judged);

/// `before` has the norms alone.
Residuals residual_figures(const DataSet& data, const Judged& before, const Judged& after,
                           const std::vector<char>& outlier);

/// Rows beyond the noise: those put aside, and `check` rows that would have been and are not
/// foreseen (they still count).
std::vector<Outlier> outlier_rows(const DataSet& data, const Judged& after,
                                  const std::vector<char>& outlier);

/// What else the answer hangs on.
struct Grounds {
  EndpointSigma endpoint, workspace;
  double target = 0;              ///< m, in the workspace
  bool orientation_seen = false;  ///< how the endpoint is turned is known as well
  bool converged = false;
  /// The moves of the parameters stay within what the maker's tolerances allow.
  bool nominal_explains = false;
  /// Most of the joints' range lies beyond the rows that identify.
  bool beyond_rows = false;
  /// What the data contradict themselves in, in words: with any of it nothing is determined.
  std::vector<std::string> contradictions = {};
  /// m, in each direction, that the robot is elsewhere than any geometry says.
  double strays = 0;
  double most_strays = 0;  ///< m, the same, that no robot does
};

/// Improved where the rows that judge are met better (check_comparison.h) and the end position is
/// known to the target.
/// `residual` is that of `before` and of the model that is judged.
Verdict verdict(const Judged& before, const Residuals& residual, const Grounds& grounds);

}  // namespace selfcal
