// Gear ratios that the robot's file has wrongly. Tooth counts do not drift, and a ratio that is
// free swallows most of what gives way under gravity: so a turning joint's is held, until the rows
// speak for another.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnosis/evidence/evidence_evaluator.h"

namespace selfcal {

/// A ratio that is held to what the robot's file says.
struct HeldGear {
  Eigen::Index column = 0;  ///< of Whitened::A
  std::string name;         ///< of the parameter
  double nominal = 1;
};

/// 1 sigma of those `held` ratios that explain the rows in the place of one of the most probable
/// causes or of structure, or beside all, nearly as well or better; empty where none does. The rows
/// are the evaluator's.
std::map<std::string, double> gears_off(const std::vector<HeldGear>& held,
                                        const EvidenceEvaluator& evaluator,
                                        const Posterior& posterior);

}  // namespace selfcal
