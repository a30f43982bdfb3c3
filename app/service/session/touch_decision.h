// What becomes of a touch before it is stored.
#pragma once

#include <string>

#include "app/service/session/decoding.h"
#include "app/service/session/session.h"

namespace selfcal {

/// How a touch is judged before it is stored: a machine with loops must be able to stand at the
/// readings, and the end position lie near the surface, and near that of the touches before.
struct TouchDecision {
  TouchOutcome outcome = TouchOutcome::taken;
  std::string why;
};
TouchDecision decide_on_touch(const Robot& robot, const Session& session, const Decoding& decoding,
                              const StepRecord& step, const Reading& reading, double search,
                              double tolerance);

/// Readings under a lock: legs within their lengths, and the loop closes in its assembly mode.
TouchDecision decide_on_visit(const Robot& robot, const Reading& reading);

/// Endpoint at readings `q`, at which the robot's loops must close, with its own values (m, world).
Eigen::Vector3d endpoint(const Robot& robot, const Eigen::VectorXd& q);

}  // namespace selfcal
