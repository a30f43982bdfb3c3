// The verdict in a sentence or two.
#pragma once

#include <string>

#include "diagnosis/findings.h"

namespace selfcal {

/// What is named, each with its probability and, of several, its share of the gap; what it cannot
/// be told from; sizes far beyond the usual.
std::string verdict_in_words(const Diagnosis& diagnosis);
/// "backlash at j1 and joint_compliance at j2 and j3".
std::string names_in_words(const std::vector<CauseResult>& causes);

}  // namespace selfcal
