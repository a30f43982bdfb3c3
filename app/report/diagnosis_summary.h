// A diagnosis as a person reads it.
#pragma once

#include <string>

#include "diagnosis/findings.h"

namespace selfcal {

std::string summary(const Diagnosis& diagnosis);

}  // namespace selfcal
