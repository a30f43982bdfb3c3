// What a person must know before the answer of a diagnosis is acted on.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/report/holdout_validation.h"

namespace selfcal {

struct CauseResult;
struct Diagnosis;

/// Fits that failed, gear ratios that were off, gears of which the rows see hardly a wave, noise
/// that only a data sheet tells or that is beyond it, rows without a time. `diagnosis` is read for
/// its verdict and gap alone.
std::vector<std::string> warnings_of(const LinearisedModel& linearised, const DataSet& data,
                                     const HoldoutValidation& validation,
                                     const Diagnosis& diagnosis);

/// That the effects of the robot's own file are not used; empty where it has none.
std::string warning_of_own_effects(const Robot& robot);

/// What warning_of_gears() begins with.
inline constexpr std::string_view kGearsOff =
    "gear ratios are free here, so that none that is off is taken for a cause; off by more than "
    "three sigma: ";
/// Where no cause is named: that a gear's ratio is off all the same, from the warning of it; empty
/// of others.
std::string gears_beside_none(const Diagnosis& diagnosis);

/// Gear ratios that `xi` puts off the maker's by more than three `sigma` (both by parameter), and
/// whether all sliding joints' are off alike, as the scale of an instrument would be; empty where
/// none is.
std::string warning_of_gears(const Robot& robot, const Eigen::VectorXd& xi,
                             const Eigen::VectorXd& sigma);

/// Named transmission errors of which hardly a wave lies in what the rows move their joint by:
/// whatever else grows along it looks like them; empty where there is none.
std::string warning_of_few_waves(const Robot& robot, const Eigen::MatrixXd& q,
                                 const std::vector<CauseResult>& named);

/// Gravity in the robot's file that is not that of the earth's surface; empty where it is.
std::string warning_of_gravity(const Robot& robot);

/// What the validation rows say of the named cause, and of the corrected model with everything
/// found, where that is not plain; empty where it is.
std::string warning_of_gap(const Diagnosis& diagnosis);

}  // namespace selfcal
