// What every conversion of a robot file for another program does: the robot read, and what the
// program does not hold of it named for a person.
#pragma once

#include <string>
#include <vector>

#include "io/result.h"
#include "kinematics/chains/corrected_chain.h"

namespace selfcal {

void note_left_out(const std::vector<std::string>& all);

/// Names the effects of a robot file.
void note_effects(const Node& robot);

/// The same of a serial robot's gears, and of its coupling unless the program has it (`coupled`).
void note_transmissions(const serial::Model& model, bool coupled);

/// Names the gears whose ratios were found to be others than the maker's, which a controller keeps.
void note_gears(const serial::Model& model);

/// The serial robot that a robot file describes, its effects apart; `file` and the format `to` in
/// messages.
Result<serial::Model> serial_model(const Node& robot, const std::string& file,
                                   const std::string& to);

/// Names what moves the base, which goes into the first joint.
void note_base(const CorrectedChain& chain);

/// The chain `original`, of the file `like`, with the corrections of `model`, of `file`.
Result<CorrectedChain> corrected_by(const serial::Model& model, const std::string& file,
                                    const JointChain& original, const std::string& like);

}  // namespace selfcal
