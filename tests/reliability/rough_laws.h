// Laws of the listed effects, and of effects that no list has, as rough as machines are: fields
// that are not smooth, steps at thresholds, lag after stops, two laws mixed, errors that depend on
// history. None is linear in anything that the search knows, none has its shapes.
#pragma once

#include <map>
#include <string>

#include "sim/trials/trial_causes.h"

namespace selfcal {

/// Of joints, links, warmth and the base, and of what no list has.
std::map<std::string, CauseMaker> rough_laws();
/// Of the tool (in rough_site_laws.cc), of surfaces and of instruments; of those that only touches
/// or only instruments see, nothing comes where these are not.
std::map<std::string, CauseMaker> rough_site_laws();

}  // namespace selfcal
