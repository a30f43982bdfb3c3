// The gap between model and machine in figures, and how much of it is closed.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace selfcal {

/// Squared residuals of one row that neither a fit nor a choice has seen (m^2): of the maker's
/// model, of the calibrated one, with the named effects and no others, with everything found, and
/// of noise alone.
struct ValidationRow {
  double nominal = 0, before = 0, after = 0, all = 0, floor = 0;
  /// Rows of one block stand or fall together: they follow each other, or repeat each other.
  int block = 0;
  bool false_reading = false;  ///< no model comes near it
};

/// How much of the gap a model closes. Not cut: one that is worse than the geometry alone is below
/// 0.
struct Closed {
  std::optional<double> fraction;  ///< nothing where the gap is within 5 % of the floor
  /// 95 % interval; infinite where too many resamples lie within the floor, or too few blocks are
  /// drawn from.
  double least = -std::numeric_limits<double>::infinity(),
         most = std::numeric_limits<double>::infinity();
  bool too_few = false;  ///< blocks, and for that no interval
};

/// Of the calibrated model (before), with the named effects and no others (after; the calibrated
/// model where none is named), with everything found (all); in m.
struct Rms {
  double before = 0, after = 0, all = 0;
};

/// All figures but the last are of the rows that some model comes near.
struct Gap {
  double rms_nominal = 0, rms_before = 0, rms_after = 0, rms_all = 0;
  double max_before = 0, max_after = 0, max_all = 0;
  double noise_floor = 0;
  Closed closed, closed_all;
  std::string validated_on = "check";  ///< or "folds"
  int rows = 0;
  int false_rows = 0;        ///< left out of the above
  Rms with_false_rows = {};  ///< the same with them
};

/// The figures of these rows. The intervals are of 1000 resamples of whole blocks, each with a
/// noise floor drawn from what `floor_freedom` freedoms leave open of it (infinite: it is known).
Gap gap_of(const std::vector<ValidationRow>& rows, unsigned long long seed,
           double floor_freedom = std::numeric_limits<double>::infinity(),
           std::string validated_on = "check");

}  // namespace selfcal
