// The gap between model and machine in figures, and how much of it is closed.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace selfcal {

/// Squared residuals of one row that neither a fit nor a choice has seen (m^2): of the maker's
/// model, of the calibrated one, with the named effects, and of noise alone.
struct JudgedRow {
  double nominal = 0, before = 0, after = 0, floor = 0;
};

struct Gap {
  double rms_nominal = 0, rms_before = 0, rms_after = 0, max_before = 0, max_after = 0;  ///< m
  double noise_floor = 0;
  std::optional<double> closed_fraction;
  double closed_least = 0, closed_most = 1;  ///< 95 % interval
  std::string judged_on = "check";           ///< or "folds"
  int rows = 0;
};

/// The figures of these rows; the interval is of 1000 resamples.
Gap gap_of(const std::vector<JudgedRow>& rows, unsigned long long seed);

}  // namespace selfcal
