// Which of many possible touches tell most together of where the end position is in the workspace,
// and which of the rest judge the result.
//
// The choice is a Design (design.h): from the best one after the other, the best touch of a set is
// taken in and the worst of the same set left out, then the best pair exchanged, as long as the
// expected variance of the end position falls (detmax.h), and a little for that of touches of the
// surfaces themselves; those chosen are moved along their surfaces until nothing near is better
// (better_places.h). The touches that judge are drawn from the rest by chance, so that they are as
// any touch of the cell is.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "constraints/planning/touch_rows.h"
#include "constraints/progress.h"
#include "constraints/workspace.h"

namespace selfcal {

/// How many touches of each set are wanted, to identify and to judge.
struct TouchCounts {
  std::vector<int> fit, check;
};

/// Indices of candidates.
struct TouchChoice {
  std::vector<int> fit, check;
};

/// What is known before a choice.
struct KnownBefore {
  /// Covariance of the robot's parameters; without rows the makers' tolerances.
  Eigen::MatrixXd prior = {};
  /// Touches made already, on the same surfaces and in the same sockets.
  std::vector<PossibleTouch> made = {};
};

/// How a candidate can be elsewhere.
struct TouchMoves {
  /// The candidate moved by each column of `by` (joints x up to kLanes) and
  /// brought back to its surface; nothing of what cannot be.
  std::function<std::vector<std::optional<PossibleTouch>>(int candidate, const Eigen::MatrixXd& by)>
      look;
  /// Makes it the one that was looked at last by that column; false where it
  /// cannot be after all.
  std::function<bool(int candidate, int column)> take;
};

/// As many of each set as are wanted or as there are, those to identify first. `xi` are the
/// parameters that are believed; the end position counts in the box of `workspace`, without one
/// over all that the joints can do.
TouchChoice choose_touches(const Robot& robot, const Eigen::VectorXd& xi,
                           const std::vector<Set>& sets,
                           const std::vector<PossibleTouch>& candidates, const TouchCounts& counts,
                           const Workspace& workspace, Random& random,
                           const Progress& progress = {}, const TouchMoves& moves = {},
                           const KnownBefore& known = {});

/// How sqrt(trace(weight C)) grows, C the covariance of the robot's parameters after the touches,
/// when one of these after another is left out, always the one that tells least: by count, from 0.
std::vector<double> sigma_by_count(const Robot& robot, const Eigen::VectorXd& xi,
                                   const std::vector<Set>& sets,
                                   const std::vector<PossibleTouch>& touches,
                                   const Eigen::MatrixXd& weight, const Progress& progress = {},
                                   const Eigen::MatrixXd& prior = {});

}  // namespace selfcal
