// The two figures to which the gap of a diagnosis closes, each called by its name.
#pragma once

#include <string>

#include "diagnosis/comparison/simulator_gap.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// "joint compliance at j2 and j3; backlash at j1 (named)", "… (named; nothing else was found)";
/// empty where no effect is named.
std::string named_in_words(const Diagnosis& diagnosis);

/// "everything found (13 effects, 10 of them not named)"; empty where that is the named effects,
/// or nothing.
std::string found_in_words(const Diagnosis& diagnosis);

/// "40 % of what calibration leaves is closed by what is named (35 to 44 %), 91 % by everything
/// found (88 to 93 %)"; empty where nothing can be said.
std::string closed_in_words(const Diagnosis& diagnosis);

/// "3 rows kept aside are false readings …; with them 2.1 mm calibrated, …"; empty without such.
std::string false_rows_in_words(const Diagnosis& diagnosis);

/// "0.52 mm from the robot on 40 rows kept aside (rms)", or why that cannot be said.
std::string gap_in_words(const SimulatorGap& gap);

/// " (then 95 % sure of joint_compliance@j2 or backlash@j1)", " (tells how much is noise)".
std::string next_in_words(const NextStep& step);

/// " at j1, j2 and j3"; empty for the whole robot.
std::string places_in_words(const std::vector<std::string>& where);
/// "joint compliance".
std::string effect_in_words(std::string effect);

}  // namespace selfcal
