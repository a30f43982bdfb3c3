// Which of many possible touches tell most together of where the end position is in the workspace,
// and which of the rest judge the result.
//
// The choice is a Design (design.h): from the best one after the other, the best touch of a set is
// taken in and the worst of the same set left out, then the best pair exchanged, as long as the
// expected variance of the end position falls (detmax.h); those chosen are moved along their
// surfaces until nothing near is better (better_places.h). The touches that judge are drawn from
// the rest by chance, so that they are as any touch of the cell is.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/methods/method.h"
#include "constraints/progress.h"
#include "constraints/workspace.h"
#include "kinematics/robot.h"

namespace selfcal {

/// A touch that could be made.
struct PossibleTouch {
  Eigen::VectorXd q;        ///< readings in the contact
  int set = 0, group = -1;  ///< group: of sockets and nests
  Eigen::Vector3d outward;  ///< of a surface (world, unit)
};

/// 1 sigma² of where a surface or socket lies, or how it is turned, that is not known (m², rad²).
inline constexpr double kPlaceVariance = 1;

/// Inverse of the covariance `C`, whose directions without variance get a little.
Eigen::MatrixXd inverse_of_covariance(const Eigen::MatrixXd& C);

/// 1 sigma of a touch of the set as its data sheet says (m), 20 um where it says none.
double touch_noise(const Set& set);
/// The same of an angle (rad).
double angle_noise(const Set& set);

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

/// Orthonormal motions of the world (6 x k, shift then turn) that the touches cannot see, for their
/// places are not given (see gauge.h).
Eigen::MatrixXd unseen_by_touches(const Robot& robot, const Eigen::VectorXd& xi,
                                  const std::vector<Set>& sets,
                                  const std::vector<PossibleTouch>& touches);

/// Covariance of the robot's parameters after the touches, from their priors and each set's noise
/// (20 um where a set says none); surfaces and sockets are unknown where they are not given, and
/// what is given is in doubt (given_doubt.h).
Eigen::MatrixXd covariance_after(const Robot& robot, const Eigen::VectorXd& xi,
                                 const std::vector<Set>& sets,
                                 const std::vector<PossibleTouch>& touches,
                                 const Eigen::MatrixXd& prior = {});

}  // namespace selfcal
