// Chosen measurements moved until nothing near them is better.
//
// Powell's conjugate directions (Computer Journal 7, 1964), one unit of a design after another:
// along each of its directions, at first those of its coordinates, the best of steps either way
// that halve every second time; then along the way that a round of these has led, which takes the
// place of the direction that gained most. Each step is judged by the objective itself, through
// Woodbury's rule. The merit never falls.
#pragma once

#include <functional>
#include <vector>

#include "constraints/planning/design.h"
#include "constraints/progress.h"
#include "kinematics/robot.h"

namespace selfcal {

/// Where units of a design could be.
struct Moves {
  /// By coordinate of a unit, of how far it can go altogether (rad, m); 0 of one that does not.
  std::function<Eigen::VectorXd(int unit)> range;
  /// Rows of the unit, as a candidate's, moved by each column of `by` (coordinates x up to kLanes);
  /// without rows where it cannot be.
  std::function<std::vector<Eigen::MatrixXd>(int unit, const Eigen::MatrixXd& by)> look;
  /// Moves the unit there, by that column of the last look; false where it cannot be after all.
  std::function<bool(int unit, int column)> take;
  int sweeps = 4;  ///< at most, of all units
};

/// Moves the chosen units of `design`; returns how often one was moved.
int move_to_better_places(Design& design, const Moves& moves, const Progress& progress = {});

}  // namespace selfcal
