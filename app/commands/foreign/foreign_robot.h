// A robot from the file of another program.
#pragma once

#include <string>

#include "io/models/urdf.h"
#include "io/result.h"

namespace selfcal {

/// The file, and what it leaves open.
struct ForeignRobot {
  std::string file;
  std::string convention;  ///< of a table: standard or modified
  UrdfEnds ends;           ///< of a URDF or a model for MuJoCo
  std::string fixed;       ///< of a URDF: merge or keep its fixed joints
};

/// A table of Denavit and Hartenberg's numbers, by its name.
bool is_table(const std::string& file);

/// Whether `text` is a URDF, and no other XML.
bool is_urdf(const std::string& text);

/// The robot file that `text`, which the file holds, comes to: a URDF, a model for MuJoCo,
/// Universal Robots' kinematics, a table or a robot file. What they leave out is noted on standard
/// error.
Result<std::string> as_robot_file(const std::string& text, const ForeignRobot& foreign);

/// A note for a person, on standard error.
void note(const std::string& what);

}  // namespace selfcal
