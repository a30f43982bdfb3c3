// Parameters that the methods could tell but the rows at hand do not, and the movement that is
// missing.
#pragma once

#include <string>
#include <vector>

#include "constraints/identifiability/identifiability.h"
#include "constraints/methods/data_set.h"
#include "constraints/solution.h"

namespace selfcal {

/// What the methods could tell.
struct StructuralRank {
  Identifiability rank;
  int nuisance = 0;  ///< freedoms of the sets' and groups' nuisance parameters
  /// Of the parameters, where the robot names the frames that it chose; of those that all joints
  /// free would tell, where some are held.
  std::vector<Lost> lost;
  std::string unreached;  ///< why rows are missing; empty when all were found
};

/// The structural answer: status of every parameter on random configurations that satisfy the
/// methods of `sets` (fresh random surfaces and groups), `rows` of each set, no more than `most`
/// says of it where it is given, the joints `held` locked at random readings.
StructuralRank structural(const Robot& robot, const std::vector<Set>& sets,
                          const std::vector<char>& free_mask, int rows, unsigned long long seed,
                          const std::vector<int>& most = {}, const std::vector<int>& held = {});

/// Parameters identified structurally but not by `rank`, each with what is missing.
std::vector<Note> unexcited(const Robot& robot, const DataSet& data, const Identifiability& rank,
                            const std::vector<char>& free_mask);

}  // namespace selfcal
