// Which of many possible further rows hold causes apart best: one after the other the row that
// leaves least of the expected confusion, sum over pairs of w exp(-G / 2), G what the rows taken so
// far add to the squared sigmas between the two (separation.h).
#pragma once

#include <vector>

#include "constraints/methods/data_set.h"
#include "diagnosis/evidence/linearised_model.h"

namespace selfcal {

/// Is it the one, or the other (none: noise)?
struct CausePair {
  std::vector<Node> one, other;  ///< entries of a robot file with their values
  double weight = 1;             ///< probability of taking the one for the other now
};

struct RowChoice {
  std::vector<int> rows;      ///< of the data set, in the order in which they were taken
  std::vector<double> apart;  ///< by pair: squared sigmas that they add
};

/// At most `most` of the rows of `data` from `first` on; fewer where more would tell nothing.
RowChoice choose_rows(const LinearisedModel& linearised, const DataSet& data, int first,
                      const std::vector<CausePair>& pairs, int most);

}  // namespace selfcal
