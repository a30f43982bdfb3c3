// The gap between a model and a machine: where it lies, which effect causes it, how far it closes.
//
// Only `fit` rows identify and choose; `check` rows judge how far the gap closes.
#pragma once

#include <memory>
#include <string>

#include "constraints/methods/data_set.h"
#include "constraints/progress.h"
#include "diagnosis/findings.h"
#include "kinematics/robot.h"

namespace selfcal {

Diagnosis diagnose(const std::shared_ptr<const Robot>& robot, const DataSet& data,
                   const DiagnosisOptions& options = {}, const Progress& progress = {});

/// Why these rows cannot be diagnosed, found without a search for causes; empty where they can.
std::string why_not_diagnosable(const std::shared_ptr<const Robot>& robot, const DataSet& data);

}  // namespace selfcal
