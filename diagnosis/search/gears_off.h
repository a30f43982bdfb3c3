// Gear ratios that the robot's file has wrongly. Tooth counts do not drift, and a ratio that is
// free swallows most of what gives way under gravity: so a turning joint's is held, until the rows
// speak for another.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/evidence/evidence_evaluator.h"

namespace selfcal {

/// Ratios that are held, by their columns of Whitened::A, with their names.
using HeldGears = std::vector<std::pair<Eigen::Index, std::string>>;

/// 1 sigma of those `held` ratios that explain the rows in the place of one of the most probable
/// causes, or beside all, nearly as well or better; empty where none does. The rows are the
/// evaluator's.
std::map<std::string, double> gears_off(const Whitened& rows, const HeldGears& held,
                                        const EvidenceEvaluator& evaluator, const Hypothesis& best);

}  // namespace selfcal
