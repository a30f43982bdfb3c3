// What may be asked of an identification.
#pragma once

#include <string>
#include <vector>

namespace selfcal {

struct Options {
  std::vector<std::string> fix;   ///< names or patterns held at the model's value
  std::vector<std::string> free;  ///< names or patterns freed (gear ratios)
  bool gears = false;             ///< every transmission ratio is free, whatever it is called
  double gear_sigma = 0;          ///< of each ratio, 1 sigma of those that are free; 0: the robot's
  bool priors = true;  ///< false: the rows alone (tests); needs every direction determined
  double most_outliers =
      0.05;  ///< share of a set's rows that may be put aside, and 2 sigma of it, 0 to 0.5
  int most_iterations = 200;  ///< 1 to 1000
  /// 1 sigma of each of the effects' parameters; empty: what the robot says of them.
  std::vector<double> effect_sigma = {};
  unsigned long long seed = 1;  ///< of the poses at which the endpoint is judged
};

}  // namespace selfcal
