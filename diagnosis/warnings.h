// What a person must know before the answer of a diagnosis is acted on.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/view.h"

namespace selfcal {

struct Diagnosis;

/// Fits that failed and gear ratios that were off. `after` is the fit with the named effects.
std::vector<std::string> warnings_of(const View& view, const Adjusted& after);

/// What the judging rows say of the named cause where that is not plain; empty where it is.
std::string warning_of_gap(const Diagnosis& diagnosis);

}  // namespace selfcal
