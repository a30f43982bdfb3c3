#include "diagnosis/report/recalibration.h"

#include "constraints/estimation/identification.h"
#include "diagnosis/report/named.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/expects.h"

namespace selfcal {

std::shared_ptr<const Robot> with_effects(const LinearisedModel& linearised,
                                          const Correction& found) {
  Problems problems;
  std::shared_ptr<const Robot> robot =
      correct(linearised.shared_geometry(), entries_of(found), linearised.context(), problems);
  expects(robot != nullptr, "what was found is effects that the robot can have");
  return robot;
}

Options free_effects(const Robot& robot) {
  Options options;
  for (const Parameter& p : robot.parameters())
    if (p.part == Part::effect) options.free.push_back(p.name);
  return options;
}

double left_with(const LinearisedModel& linearised, const DataSet& data, const Correction& found) {
  const std::shared_ptr<const Robot> robot = with_effects(linearised, found);
  return identify(*robot, data, free_effects(*robot)).residual.fit.rms_after;
}

}  // namespace selfcal
