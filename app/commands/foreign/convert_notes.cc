#include "app/commands/foreign/convert_notes.h"

#include "app/commands/foreign/foreign_robot.h"
#include "app/report/format.h"
#include "kinematics/rotation.h"

namespace selfcal {

void note_left_out(const std::vector<std::string>& all) {
  for (const std::string& each : all) note("left out: " + each);
}

void note_effects(const Node& robot) {
  const Node* effects = robot.find("effects");
  if (!effects) return;
  for (const Node& entry : effects->items) {
    const Node* name = entry.find("effect");
    const Node* at = entry.find("at");
    note("left out: the effect " + (name ? name->text : "?") +
         (at && !at->text.empty() ? " at " + at->text : ""));
  }
}

void note_transmissions(const serial::Model& model, bool coupled) {
  for (const serial::Frame& frame : model.frames)
    if (frame.gear != 1)
      note("left out: the gear ratio of " + frame.name + ", " + format_number(frame.gear) +
           ": positions there are the ratio times the reading");
  if (!coupled && model.coupling.size() > 0)
    note("left out: the coupling of joints: positions there are coupling times readings");
}

void note_gears(const serial::Model& model) {
  for (const serial::Frame& frame : model.frames)
    if (frame.gear != frame.gear_nominal)
      note("left out: the gear ratio of " + frame.name + " as it was found, " +
           format_number(frame.gear) + ": the controller keeps the maker's, " +
           format_number(frame.gear_nominal));
}

Result<serial::Model> serial_model(const Node& robot, const std::string& file,
                                   const std::string& to) {
  if (robot.find("kind")->text != "serial")
    return bad_input(file + ": a robot of kind " + robot.find("kind")->text + " has loops, and " +
                     to + " holds chains of joints only");
  Problems problems;
  serial::Model model = serial::read(robot.without({"effects"}), problems);
  if (problems.any()) return bad_input(problems);
  return model;
}

void note_base(const CorrectedChain& chain) {
  const double length = chain.base.translation().norm();
  const double angle = log_rotation(chain.base.linear()).norm();
  if (length > 1e-9 || angle > 1e-9)
    note(
        printed("the base moves by %.3f mm and %.3f mrad, to where the data set's world has it; "
                "this goes into the first joint",
                1e3 * length, 1e3 * angle));
}

Result<CorrectedChain> corrected_by(const serial::Model& model, const std::string& file,
                                    const JointChain& original, const std::string& like) {
  CorrectedChain chain = corrected_chain(original, model);
  if (!chain.problem.empty())
    return bad_input(file + ": is no calibration of " + like + ": " + chain.problem);
  return chain;
}

}  // namespace selfcal
