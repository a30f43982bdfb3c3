// A vendor's table of Denavit and Hartenberg's numbers, as data sheets print it and a spreadsheet
// writes it: a row a joint, from base to flange.
//
//   joint, alpha [deg], a [mm], d [mm], theta [deg], type, min [deg], max [deg]
//
// Lines that begin with # may stand above the names. In any order and capitals, with units in
// brackets or parentheses behind the names (rad and m without). a is the distance along x and d
// that along z; a table after Khalil and Kleinfinger has d along x and r along z. type is revolute
// (by default), prismatic or fixed. What a table lacks but theta, which is the joint's own, is 0.
// Between semicolons or tabs a number may have a decimal comma.
#pragma once

#include <filesystem>
#include <string>

#include "io/result.h"
#include "kinematics/description.h"

namespace selfcal {

/// The robot file that the table comes to, with numbers of `convention` (standard or modified) and
/// the file's stem for a name. Refuses, with file, row and column, what it cannot read.
Result<Node> read_dh_table(const std::filesystem::path& path, const std::string& convention);

}  // namespace selfcal
