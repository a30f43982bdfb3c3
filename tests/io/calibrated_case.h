// What the tests of calibrated robots for other programs share.
#pragma once

#include <gmock/gmock.h>

#include <string>

#include "io/files/yaml.h"
#include "kinematics/robots/serial.h"

namespace selfcal {

inline constexpr double kAsGood = 1e-9;  // m, rad: what is asked of a conversion

inline serial::Model model_in(const std::string& text) {
  Problems problems;
  serial::Model model = serial::read(*parse_yaml(text, "calibrated.yaml"), problems);
  EXPECT_THAT(problems.list, testing::IsEmpty());
  return model;
}

}  // namespace selfcal
