// One trial of the diagnosis: a data set from a machine with a known cause, or none, in it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "kinematics/robot.h"
#include "sim/trials/trial_causes.h"

namespace selfcal {

struct TrialRequest {
  std::shared_ptr<const Robot> robot;  ///< null: an arm of the trial's own
  std::optional<bool> touches;         ///< of four planes, or tracked positions; drawn when missing
  int least_rows = 120, most_rows = 400;
  unsigned long long seed = 1;
  int number = 0;           ///< of the trial; each has its own draws
  std::string effect;       ///< or "none", "unknown"; empty: drawn, alone or in a pair
  std::string second = {};  ///< beside `effect`; empty: that one alone
  std::optional<double> r;  ///< drawn when missing
  /// Other laws of the same effects, by name, in place of the generator's own; of an effect that it
  /// lacks the generator's.
  std::map<std::string, CauseMaker> laws = {};
};

/// What only the sealed file says.
struct TrialLedger {
  std::string effect = "none", second, measure, physics;
  std::map<std::string, std::vector<std::string>> where;  ///< by effect
  double noise = 0;                                       ///< m, 1 sigma of one scalar
  double r = 0;  ///< of each cause: what calibration leaves of it, rms over the noise
  int rows = 0;
  std::optional<double> told_closed;  ///< closed fraction of a fit that is told the true shapes
};

struct MadeTrial {
  std::shared_ptr<const Robot> robot;
  DataSet data;
  TrialLedger truth;
  std::vector<int> false_rows;  ///< from 0
  Eigen::MatrixXd shifts;       ///< rows x 3: where the causes move the tip (m)
  double visible = 0;           ///< of all causes together, at the final rows
  std::string unreached;        ///< why there is no trial; empty when there is one
};

/// One seed and number, one trial.
MadeTrial make_trial(const TrialRequest& request);

}  // namespace selfcal
