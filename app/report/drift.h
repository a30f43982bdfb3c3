// How a robot's parameters have moved from one accepted calibration to the next.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kinematics/robot.h"

namespace selfcal {

/// Parameters that were accepted, of one robot.
struct AcceptedParameters {
  std::int64_t session = 0, unix_ms = 0;
  std::shared_ptr<const Robot> robot;
  std::map<std::string, double> sigma = {};  ///< by parameter; empty where it is no longer kept
};

/// One parameter over all calibrations (SI).
struct Drift {
  std::string name;                   ///< "theta2 j2.theta"
  std::string unit;                   ///< SI
  std::vector<double> since_factory;  ///< value less the maker's figure, by calibration
  std::vector<double> since_last;  ///< less that of the calibration before; of the first as above
  std::vector<double> sigma;       ///< of the value, by calibration; 0 where it is not known
};

/// The `most` parameters that moved most after the first calibration, or in it when it is the only
/// one: 1 mm counts as 1 mrad and as a ratio of 0.001. Those that never moved by more than their
/// sigma come last; those that never moved are left out. `calibrations` are of one machine, oldest
/// first.
std::vector<Drift> drifts(const std::vector<AcceptedParameters>& calibrations, std::size_t most);

/// A table in units that a person reads, a column for each of the newest calibrations and the
/// newest sigma.
std::string drift_table(const std::vector<AcceptedParameters>& calibrations,
                        const std::vector<Drift>& drifts);

}  // namespace selfcal
