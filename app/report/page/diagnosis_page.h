// The page of a diagnosis: diagnosis.json, its sentences, and the rows that it was judged on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/report/page/page.h"
#include "diagnosis/comparison/comparison.h"
#include "diagnosis/comparison/simulation.h"
#include "diagnosis/comparison/simulator_gap.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// Another data set, by its name, and what the comparison with it came to.
struct SinceBefore {
  std::string name;
  Comparison comparison;
};
/// A simulator's model with all that was found in the robot, run again.
struct MendedSimulator {
  std::string text;  ///< MJCF
  SimulatorGap gap;
  std::vector<std::string> left_out;  ///< what it does not hold
};
struct AgainstSimulation {
  std::string name;
  Differences differences;
  std::optional<SimulatorGap> gap = {};        ///< of a model that was asked itself
  std::optional<MendedSimulator> mended = {};  ///< of such a one
};

/// All that a person asked of one data set.
struct Findings {
  std::string name;  ///< the data set's
  Diagnosis diagnosis;
  std::optional<SinceBefore> since;
  std::optional<AgainstSimulation> sim;
};

/// How far the simulator is from the robot, before and after it was mended, what is left then, and
/// in what the two differ; empty where none was given.
std::vector<std::string> simulator_sentences(const Findings& findings);

/// diagnosis.json: the diagnosis, `since` and `sim`.
nlohmann::ordered_json to_json(const Findings& findings);

/// The page's object. `judged` are the residuals (m) of the rows behind the figures of the gap, a
/// column for each model.
nlohmann::ordered_json diagnosis_data(const PageSubject& subject, const Findings& findings);

}  // namespace selfcal
