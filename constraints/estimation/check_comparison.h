// Whether one model meets the rows that judge better than another: the maker's and the identified,
// or the parameters in use and a candidate.
#pragma once

#include <vector>

#include "constraints/solution.h"

namespace selfcal {

/// Configurations from which a test at 95 % may say that they are met better: half to their power,
/// that all happen to be, is one in 32.
inline constexpr int kFewestCompared = 5;

struct CheckComparison {
  /// rms (m; rad where all have angles alone) of the rows that neither finds beyond the noise.
  double rms_before = 0, rms_after = 0;
  int configurations = 0;     ///< that both models meet
  double p_value = 1;         ///< of the paired test that the rows are met better
  bool lengths_fall = false;  ///< the squares of all rows, false readings left out
  bool angles_rise = false;   ///< by more than chance explains
  /// At 95 %, and no great loss beside many small gains.
  bool better() const;
  /// Met better as far as they go, and too few for any test.
  bool too_few() const { return configurations < kFewestCompared && lengths_fall && !angles_rise; }
};

/// Rows of one data set in its order; of those that only one model meets nothing is said (a loop
/// may close for one alone). The paired test is Wilcoxon's, of the signed ranks of the gains
/// |before| - |after| by configuration; repeats of one share more than their noise and count once.
/// Where some rows have angles alone and others lengths, the gains are in units of what noise makes
/// of the row, and the squares are those of lengths.
/// No row is left out because the model on trial, `after`, makes it far.
CheckComparison compare_check_rows(const std::vector<CheckRow>& before,
                                   const std::vector<CheckRow>& after);

}  // namespace selfcal
