// How far what a file gives is believed, where it is not among the unknowns: ratios, planes,
// centres, lengths. What is stated holds; what has no tolerance of its own is believed to about one
// part in ten thousand.
#pragma once

#include "constraints/methods/data_set.h"
#include "kinematics/parameter.h"

namespace selfcal {

/// 1 sigma of a parameter of the robot that is fixed; 0 of one that is exact, and of base and tool:
/// where they are put is then what they are called by.
double doubt_of_fixed(const Parameter& parameter);

/// 1 sigma (m) of a length that the entry of a set gives, its own sigma apart. Two planes that are
/// a known distance apart are touched from opposite sides (`opposite`) or from the same: a probe
/// that is larger than given counts twice or not at all.
double doubt_of_length(const Set& set, const KnownLength& length, bool opposite);

/// 1 sigma (m) of a centre that is given, so far from the world's origin (m). Of a plane 0: its
/// distance is a length that is known, and in doubt as such.
double doubt_of_centre(const Set& set, double distance);

/// 1 sigma (rad) of how a surface that is given is turned; 0 of what has no direction.
double doubt_of_turn(const Set& set);

}  // namespace selfcal
