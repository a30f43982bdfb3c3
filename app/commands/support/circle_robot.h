// A nominal robot from circle points, when nothing of its lengths and angles is known.
#pragma once

#include <memory>
#include <string>

#include "constraints/axes/axis_model.h"
#include "constraints/solution.h"
#include "io/files/data_set_file.h"

namespace selfcal {

struct CircleRobot {
  std::shared_ptr<const Robot> robot;  ///< as the axes say, hardly held to it: kLittleKnown
  AxisModel model;
  std::shared_ptr<const Robot> file;  ///< the robot that the file describes
};

/// The robot that the rows of `loaded` say, whose sets are all of circle points, or what they lack.
Result<CircleRobot> circle_robot(const LoadedDataSet& loaded);

/// Puts the figures of the robot's file, in the frames of the axes, into `solution` as nominal.
/// Where the file gives lengths, and the rows have links far beyond their tolerances elsewhere, the
/// two are not of one robot: then nothing is determined, with words that say which.
void compare_with_file(const CircleRobot& start, Solution& solution);

/// The file of a robot that has what `solution` found for its maker's figures, each with its sigma
/// for tolerance where that is more than usual.
std::string nominal_text(const CircleRobot& start, const Solution& solution);

inline constexpr double kLittleKnown = 0.1;  ///< m or rad, 1 sigma of what the axes start from

}  // namespace selfcal
