// What keeps a row from being exact: noise, false triggers, compliance, encoder steps.
#pragma once

#include "sim/scenario.h"
#include "sim/simulated.h"
#include "sim/true_robot.h"

namespace selfcal {

/// Touches that stop early or late and instruments that read a little off; notes the false ones in
/// made.false_rows and, in made.unreached, a touch whose noise no configuration has.
void disturb_measurements(const Scenario& scenario, const Robot& robot, Simulated& made);

/// What the encoders read, where so far the joints' true positions stand.
void disturb_readings(const Scenario& scenario, const std::optional<Compliance>& compliance,
                      Simulated& made);

}  // namespace selfcal
