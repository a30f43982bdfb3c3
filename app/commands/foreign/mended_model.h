// A robot file as a model for MuJoCo, with those of its effects that such a model can carry.
#pragma once

#include <string>

#include "io/models/mjcf_text.h"
#include "io/result.h"

namespace selfcal {

/// The model of a serial robot's file, `file` in messages.
Result<MjcfText> mjcf_of_robot(const Node& robot, const std::string& file);

/// The model `like`, whose joints and end are the robot's, with the robot's corrections and
/// effects; `tool` as read_mujoco has it.
Result<MjcfText> mjcf_mended(const Node& robot, const std::string& file, const std::string& like,
                             const std::string& tool);

}  // namespace selfcal
