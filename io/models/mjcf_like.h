// The user's own model for MuJoCo with what a calibration has found.
#pragma once

#include <string>

#include "io/models/mjcf_effects.h"
#include "io/models/mjcf_text.h"
#include "io/models/mujoco.h"
#include "io/result.h"
#include "kinematics/chains/corrected_chain.h"

namespace selfcal {

/// The model `text` (`file` in messages), which `read` is of, with its bodies where `corrected` has
/// the joints and with `effects` of the calibrated `robot`; all else as it was. Refuses a model
/// whose bodies are not all in this one file.
Result<MjcfText> mjcf_like(const std::string& text, const std::string& file,
                           const MujocoChain& read, const CorrectedChain& corrected,
                           const serial::Model& robot, const MjcfEffects& effects);

}  // namespace selfcal
