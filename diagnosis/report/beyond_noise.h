// Noise is said to be all, and the rows that nothing was chosen by say otherwise.
#pragma once

#include <string>

#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// That the rows kept aside are left farther than their noise and what the geometry is in doubt
/// explain, where nothing is found, in words; empty where they are not.
std::string beyond_noise(const LinearisedModel& linearised, const DataSet& data,
                         const Diagnosis& diagnosis);

}  // namespace selfcal
