// The rows that a diagnosis asks for, so that causes which look alike come apart.
#pragma once

#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "io/result.h"

namespace selfcal {

/// One thing to do, best first.
struct SeparatingStep {
  std::string what;                    ///< in words
  std::vector<std::string> separates;  ///< causes
  double probability_after = 0;        ///< of the answer then; NaN where it is not known
  DataSet rows;                        ///< to measure, in the order of a short tour

  /// Nothing is asked for after it, as far as is known beforehand.
  bool settles() const;
};

struct SeparatingRows {
  std::vector<SeparatingStep> steps;
  std::string why;  ///< there are none, or are not enough
};

/// Of `diagnosis.json`, or of the file that `diagnose --next` writes.
Result<SeparatingRows> read_separating_rows(const std::string& file);

/// The steps, numbered, and why there are no more.
std::string separating_report(const SeparatingRows& rows);

}  // namespace selfcal
