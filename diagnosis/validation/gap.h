// The gap between model and machine in figures, and how much of it is closed.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace selfcal {

/// Squared residuals of one row that neither a fit nor a choice has seen (m^2): of the maker's
/// model, of the calibrated one, with the named effects and no others, with everything found, and
/// of noise alone.
struct JudgedRow {
  double nominal = 0, before = 0, after = 0, all = 0, floor = 0;
};

/// How much of the gap a model closes. Not cut: one that is worse than the geometry alone is below
/// 0.
struct Closed {
  std::optional<double> fraction;  ///< nothing where the gap is within 5 % of the floor
  double least = 0, most = 1;      ///< 95 % interval
};

/// Of the calibrated model (before), with the named effects and no others (after; the calibrated
/// model where none is named), with everything found (all); in m.
struct Gap {
  double rms_nominal = 0, rms_before = 0, rms_after = 0, rms_all = 0;
  double max_before = 0, max_after = 0, max_all = 0;
  double noise_floor = 0;
  Closed closed, closed_all;
  std::string judged_on = "check";  ///< or "folds"
  int rows = 0;
};

/// The figures of these rows; the interval is of 1000 resamples.
Gap gap_of(const std::vector<JudgedRow>& rows, unsigned long long seed);

}  // namespace selfcal
