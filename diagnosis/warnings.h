// What a person must know before the answer of a diagnosis is acted on.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/view.h"

namespace selfcal {

struct Diagnosis;

/// Fits that failed, gear ratios that were off, and what the rows kept aside say of the named cause
/// where that is not plain. `after` is the geometry's fit with the named effects.
std::vector<std::string> warnings_of(const View& view, const Adjusted& after,
                                     const Diagnosis& diagnosis);

}  // namespace selfcal
