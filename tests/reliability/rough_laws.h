// Laws of the listed effects, and of effects that no list has, as rough as machines are: fields
// that are not smooth, steps at thresholds, lag after stops, two laws mixed, errors that depend on
// history. None is linear in anything that the search knows, none has its shapes.
#pragma once

#include <map>
#include <string>

#include "sim/trials/trial_causes.h"

namespace selfcal {

std::map<std::string, CauseMaker> rough_laws();

}  // namespace selfcal
