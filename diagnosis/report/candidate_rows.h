// Rows that could be measured next: what a person at the robot can change from one visit to
// another.
#pragma once

#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "diagnosis/evidence/linearised_model.h"

namespace selfcal {

struct CandidateRows {
  std::string what;  ///< to do, in words
  DataSet both;      ///< the rows at hand and after them the further ones, nothing measured
  /// What they show of structure that no known effect explains; empty where nothing.
  std::string tells = {};
};

/// Rows of `data`, spread over those that are fitted, once more: twice at once, with a payload,
/// approached from the other side, faster, at the end, with the joints elsewhere, with the tool
/// rolled about its axis, in another posture (elbow up and down). What this robot or these rows
/// cannot do is not among them.
std::vector<CandidateRows> candidate_rows(const LinearisedModel& linearised, const DataSet& data);

}  // namespace selfcal
