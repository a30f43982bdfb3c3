// The session of a trial: when, where, how fast and how warm each row is taken, before any
// deviation.
#pragma once

#include <memory>
#include <string>

#include "constraints/equations/equations.h"
#include "constraints/methods/data_set.h"
#include "sim/trials/trial_world.h"

namespace selfcal {

struct SessionPlan {
  bool touches = true;
  int rows = 200;          ///< repeats counted
  double repeated = 0.12;  ///< share of the configurations taken two or three times
};

struct TrialSession {
  std::shared_ptr<const Robot> robot;  ///< nominal
  DataSet data;                        ///< sets and rows; readings as if nothing deviated
  State truth;                         ///< geometry and planes
  TrialWorld world;
  std::string unreached;  ///< why rows are missing
};

/// `xi` is the true geometry.
TrialSession draw_session(const std::shared_ptr<const Robot>& robot, const Eigen::VectorXd& xi,
                          const SessionPlan& plan, Random& random);

}  // namespace selfcal
