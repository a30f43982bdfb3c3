// A session of touches in a Cell, written as a data set: what a robot would give, with noise on its
// readings.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/mujoco/arm.h"

namespace selfcal::mujoco {

struct SessionOrder {
  unsigned seed = 1;
  std::vector<std::pair<std::string, double>> compliance = {};  ///< by joint, rad/(N m)
  int least_rows = 160, most_rows = 240;
  double least_noise = 10e-6, most_noise = 20e-6;  ///< m, 1 sigma of a touch along the normal
  double repeated = 0.12, checked = 0.3;           ///< shares of the configurations
};

struct Session {
  Arm built;         ///< as simulated
  double noise = 0;  ///< m
  int rows = 0;
};

/// Writes the data set, and the model as arm.mjcf.xml, into `folder`.
Session make_session(const std::filesystem::path& folder, const SessionOrder& order);

}  // namespace selfcal::mujoco
