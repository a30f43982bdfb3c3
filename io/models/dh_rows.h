// A serial robot as rows of a table of Denavit and Hartenberg's numbers, base and tool with it.
#pragma once

#include <string>
#include <vector>

#include "kinematics/robots/serial.h"

namespace selfcal {

/// rad, m; of the modified convention Rot(x, alpha) Trans(x, a) Rot(z, theta) Trans(z, d), of the
/// standard one Rot(z, theta) Trans(z, d) Trans(x, a) Rot(x, alpha).
struct DhRow {
  std::string name;
  serial::Motion motion = serial::Motion::fixed;
  double alpha = 0, a = 0, d = 0, theta = 0;
};

/// A row a frame; of a fixed frame that no row is (a whole pose, or one with beta) up to four. Of a
/// moving frame beta is left out.
std::vector<DhRow> modified_rows(const serial::Model& robot);

/// Rows of the standard convention that put the last frame and every joint's axis where these do:
/// theta and d of a row, a and alpha of the one behind it. Those of the first get a row of their
/// own.
std::vector<DhRow> standard_rows(const std::vector<DhRow>& modified);

}  // namespace selfcal
