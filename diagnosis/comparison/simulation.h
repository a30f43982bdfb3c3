// A robot against its simulator: what the rows of one show that those of the other do not.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/comparison/compare.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// A cause that a diagnosis stands by, at one place.
struct ShownCause {
  std::string effect, where;  ///< where: empty for a cause without a place
  double probability = 0;
  std::vector<NamedValue> parameters;
  std::vector<std::string> confounded_with;
};

/// One parameter on both sides.
struct SideBySide {
  NamedValue robot, simulation;
  double sigmas = 0;  ///< how far they are apart
};

struct SharedCause {
  std::string effect, where;
  std::vector<SideBySide> parameters;
};

struct Differences {
  Comparison geometry;  ///< the robot less its simulation
  std::vector<ShownCause> robot_only, simulation_only;
  std::vector<SharedCause> both;
  std::vector<std::string> sentences;
};

/// Every cause that the diagnosis names or holds more probable than not; none where noise does as
/// well.
std::vector<ShownCause> shown_causes(const Diagnosis& diagnosis,
                                     const DiagnosisOptions& options = {});

/// `geometry` as compare() has it of the simulation's rows before the robot's.
Differences differences(const Diagnosis& robot, const Diagnosis& simulation, Comparison geometry,
                        const DiagnosisOptions& options = {});

}  // namespace selfcal
