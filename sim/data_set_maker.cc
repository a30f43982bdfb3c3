// The stages in their order: who the robot is, where the sets are, exact rows, what disturbs them.
#include "sim/data_set_maker.h"

#include "sim/disturbances.h"
#include "sim/rows.h"
#include "sim/true_robot.h"
#include "sim/true_sets.h"

namespace selfcal {

Simulated make_data_set(const Scenario& scenario, const Robot& robot, Problems& problems) {
  Simulated made;
  made.data.target = scenario.target.value_or(made.data.target);
  made.data.sets = make_sets(scenario, problems);
  if (const std::string why = lacking_body(robot, made.data.sets); !why.empty())
    problems.list.push_back(why);
  made.truth.xi = true_parameters(scenario, robot, problems);
  const std::optional<Compliance> compliance =
      true_compliance(scenario, robot, made.truth.xi, problems);
  made.locked = locked_joints(scenario, robot, problems);
  if (problems.any()) return made;
  made.truth.nuisance = true_own_values(scenario, made.data.sets, robot, made.truth.xi, problems);
  if (problems.any()) return made;
  take_rows(scenario, robot, made);
  if (made.unreached.empty()) disturb_measurements(scenario, robot, made);
  if (made.unreached.empty()) disturb_readings(scenario, compliance, made);
  return made;
}

}  // namespace selfcal
