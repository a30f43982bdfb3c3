// Two data sets of one robot: what changed from the first to the second.
//
// Both are explained by one geometry, and each thing that may have changed (a joint's zero, the
// base, the probe, a surface) gets columns of its own on the rows of the second. Which of them are
// needed is weighed as causes are. A zero that shifted between two sessions is seen here, where it
// is invisible within either.
#pragma once

#include <memory>
#include <string>

#include "constraints/methods/data_set.h"
#include "constraints/progress.h"
#include "diagnosis/comparison/comparison.h"

namespace selfcal {

/// Why a data set of `one` cannot be compared with one of `other`, to follow its name; empty when
/// it can.
std::string incomparable(const Robot& one, const Robot& other);

/// Why nothing can be compared with a data set, to follow its name: too few of its rows are there
/// to fit. Empty when it can.
std::string incomparable(const DataSet& data);

/// `before` and `after` are of one robot file (see incomparable). Sets of one name are one surface
/// or instrument.
Comparison compare(const std::shared_ptr<const Robot>& robot, const DataSet& before,
                   const DataSet& after, Between between = Between::sessions,
                   const DiagnosisOptions& options = {}, const Progress& progress = {});

}  // namespace selfcal
