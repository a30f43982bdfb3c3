// What a diagnosis may be asked and what it answers with.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "constraints/estimation/options.h"
#include "constraints/methods/observations.h"
#include "constraints/solution.h"
#include "diagnosis/evidence/hypothesis.h"
#include "diagnosis/evidence/kernel_domain.h"
#include "diagnosis/options.h"
#include "diagnosis/validation/correction.h"
#include "diagnosis/validation/gap.h"
#include "kinematics/suppositions.h"

namespace selfcal {

/// Rows that can be taken next, as the rows of the data set are; nothing measured.
struct PossibleRows {
  Observations rows;              ///< of the data set's sets
  std::vector<std::string> what;  ///< by row, in a few words: "in another posture"
};

struct NamedValue {
  std::string name, unit;
  double value = 0, sigma = 0, usual_least = 0, usual_most = 0;
  bool positive = false;  ///< physics allows no other sign
};

struct CauseResult {
  std::string effect;
  std::vector<std::string> where = {};
  double probability = 0;
  /// With what goes along with the rows' order as well; of the verdict: with the known causes that
  /// cannot be told from it. 0 where it is no more than its own.
  double together = 0;
  double beyond_nuisance = 0;  ///< share of it that calibration cannot absorb
  double rms_after =
      0;               ///< m, on the validation rows with this cause alone; 0 where hardly probable
  double visible = 0;  ///< rms of its visible part over the noise
  std::string shape = {};  ///< since when, how fast: "from 1840 s on"; empty where there is no such
  std::optional<std::pair<double, double>> between = {};  ///< s, rows: of a step, likely
  double settles = 0;  ///< s, rows: steps at one place no farther apart are one that settles
  std::vector<NamedValue> parameters = {};
  std::vector<std::string> confounded_with = {};
  /// Of the search on noise that it answers to, (1 + k) / (1 + B); NaN where it was not asked.
  double p_value = std::numeric_limits<double>::quiet_NaN();
  /// Of a named one: the share of the gap that it closes alone, and that it adds to the other named
  /// ones.
  std::optional<double> closes_alone = {}, closes_beside = {};
  Correction correction = {};  ///< with its values

  /// Probability that it or what these rows cannot tell from it is there: what it is named by.
  double of_its_kind() const { return std::max(probability, together); }
};

struct Detectable {
  std::string effect, where, unit;
  double smallest = 0;
};

struct Share {
  std::string name;
  double share = 0;
};
struct Region {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0, share = 0;
};
struct Interval {
  double from = 0, to = 0, share = 0;
};

struct Where {
  std::vector<Share> by_joint, by_set;
  std::vector<Region> by_region;
  std::vector<Interval> by_time;
};

struct NextStep {
  std::string what;
  std::vector<std::string> separates;
  double probability_after = 0;  ///< NaN where it is not known
  Observations rows;  ///< to measure: readings, set, and what else shall hold (nothing measured)
  std::vector<int> chosen = {};  ///< which of the possible rows these are, from 0
};

/// What simulated sessions over the same configurations taught.
struct SimulationBasedCalibration {
  int sessions = 0;
  double right = 0;         ///< share of the causes in them that were named
  double false_alarms = 0;  ///< share of the sessions without one that named one
  double temperature = 1;   ///< by which log odds are divided
};

struct Diagnosis {
  /// Why these rows cannot be diagnosed; all else is empty then. Empty: they can.
  std::string problem;
  bool converged = true;  ///< the fits that the gap is taken between
  Gap gap;
  std::string gap_unjudged;                    ///< why the gap has no rows; empty where it has
  std::vector<ValidationRow> validation_rows;  ///< that the gap is the figures of
  CauseResult verdict;  ///< effect "none" or "unknown" without a place, else one of `candidates`
  /// What is named, the verdict's first: all that were sure before what speaks against them was
  /// counted. None where the verdict is "none".
  std::vector<CauseResult> named;
  std::optional<UnknownStructure> unknown = {};  ///< how the rows err that `unknown` explains
  std::string scatter;  ///< in words, of rows that scatter more than stated, where `unknown` makes
                        ///< them or repeats say that it is noise
  std::string uneven;   ///< in words, of noise that is not the same everywhere
  std::string why;      ///< the verdict in words
  /// Of the verdict, or of what it was refused for: (1 + k) / (1 + B), by the tail of what was
  /// found where the statistic is beyond all B.
  double p_value = 1;
  std::vector<CauseResult> candidates;  ///< most probable first, `none` and `unknown` among them
  SimulationBasedCalibration simulation;
  Where where;
  std::vector<Detectable> detectable;
  std::vector<Untestable> untestable;
  std::vector<NextStep> next;
  std::string next_why;  ///< why there is none of these, or why they promise little
  std::vector<Outlier> outliers;
  std::vector<std::string> warnings;
  Correction found;                    ///< the effects of `model`, in its order
  std::shared_ptr<const Robot> model;  ///< geometry and everything found, and its values
  Eigen::VectorXd values;
  double noise = 0;        ///< m, 1 sigma of one length; 0: none is measured
  double angles_left = 0;  ///< rad, of the best explanation, 1 sigma; 0: no angle is measured
  double floor_freedom = std::numeric_limits<double>::infinity();  ///< that it is known by
};

}  // namespace selfcal
