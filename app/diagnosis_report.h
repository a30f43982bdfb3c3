// A diagnosis as a page that a person understands in a minute: one file, no script, nothing
// fetched.
#pragma once

#include <string>

#include "diagnosis/diagnosis.h"

namespace selfcal {

/// `name` is the data set's.
std::string html_report(const Diagnosis& diagnosis, const std::string& name);

}  // namespace selfcal
