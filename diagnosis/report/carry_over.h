// What was found beside the named causes and does not carry over to rows that no choice has seen.
//
// Everything found together explains the rows that it was found in. Where it leaves more of the
// rows that judge than the named causes alone (or than the geometry alone, where none is named), a
// robot that is corrected by it would be worse off: it is left out.
#pragma once

#include <string>

#include "constraints/methods/data_set.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// Takes it out of the correction and the model, which is identified anew without it, and out of
/// the figures. What was done, in words; empty where nothing was.
std::string leave_out_what_does_not_carry_over(const DataSet& data, const DiagnosisOptions& options,
                                               Diagnosis& diagnosis);

}  // namespace selfcal
