// Slips that leave files which look right, and what the program must say of each.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "tests/slips/files.h"

namespace selfcal::slips {

struct Slip {
  std::string set;   ///< the sound data set that it is made in
  std::string name;  ///< of the slip, in words without blanks
  std::function<void(Files&)> make;
  std::string identify_says, diagnose_says;
  /// Effects that may be named beside those of the sound set: what the slip is, or looks like.
  std::vector<std::string> may_name = {};
  /// The rows are of such a robot: a calibration that says so is right.
  bool robot_differs = false;
};

std::vector<Slip> slips();

inline void PrintTo(const Slip& slip, std::ostream* out) { *out << slip.set << " " << slip.name; }

}  // namespace selfcal::slips
