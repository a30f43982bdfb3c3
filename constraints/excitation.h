// Parameters that the methods could tell but the rows at hand do not, and the movement that is
// missing.
#pragma once

#include <vector>

#include "constraints/data_set.h"
#include "constraints/identifiability.h"
#include "constraints/identification.h"

namespace selfcal {

/// The structural answer: status of every parameter on random configurations that satisfy the
/// methods of `data.sets` (fresh random surfaces and groups), `rows` of each set that `used` marks
/// (all when it is empty).
Identifiability structural(const Robot& robot, const std::vector<Set>& sets,
                           const std::vector<char>& candidate, int rows, unsigned long long seed,
                           std::string* unreached = nullptr, int* own_freedom = nullptr,
                           const std::vector<char>& used = {});

/// Parameters identified structurally but not by `rank`, each with what is missing.
std::vector<Note> unexcited(const Robot& robot, const DataSet& data, const Identifiability& rank,
                            const std::vector<char>& candidate);

}  // namespace selfcal
