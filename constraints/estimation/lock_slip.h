// A lock that slips between two of its rows leaves a step in what is left of them.
#pragma once

#include <string>
#include <vector>

#include "constraints/estimation/judgement.h"
#include "constraints/solution.h"

namespace selfcal {

/// Rows, to fit or to check, on either side of a slip: fewer tell nothing of it.
inline constexpr int kFewestBesideSlip = 5;
/// Share of the sets without a slip in which one is seen all the same, at most.
inline constexpr double kFalseSlips = 1e-3;

/// The rows of a set in the order in which they were taken.
std::vector<int> rows_in_time(const Observations& rows, int set);

/// The largest slip of each locked joint's set, as far as one is certain.
std::vector<LockSlip> lock_slips(const DataSet& data, const Judged& after);

/// "the lock of leg 1 universal (set a) slipped by 1 mrad between its rows 20 and 21".
std::string slip_words(const LockSlip& slip);

}  // namespace selfcal
