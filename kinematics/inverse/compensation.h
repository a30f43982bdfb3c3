// What to command so that a calibrated robot is where it is wanted (Khalil and Dombre 11.5): the
// inverse of the nominal robot first, then corrections until the calibrated one, its effects
// included, is there.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "kinematics/inverse/exact_inverse.h"
#include "kinematics/inverse/operating_point.h"
#include "kinematics/inverse/reach_pose.h"

namespace selfcal {

enum class Reach {
  reached,
  out_of_reach,  ///< neither the nominal nor the calibrated robot gets there
  limit,         ///< only with a joint beyond its limit
  singular,  ///< the nominal robot gets there, the calibrated one does not, or only far from there
             ///< and from what was asked for
};
/// "out-of-reach".
std::string_view to_string(Reach reach);

struct Command {
  Reach status = Reach::out_of_reach;
  Eigen::VectorXd q;                  ///< readings to command; empty unless the pose is reached
  int iterations = 0;                 ///< corrections after the nominal inverse
  double error = 0, error_angle = 0;  ///< what is left (m, rad) of the nearest that was found
};

class Compensation {
 public:
  /// Robots of the same joints; the calibrated one stands as it does at `at`.
  Compensation(std::shared_ptr<const Robot> nominal, std::shared_ptr<const Robot> calibrated,
               const OperatingPoint& at = {});

  /// Of all solutions the one nearest to `near`, or to the middle of the readings (of a robot
  /// without a closed form, the one that steps from there come to): corrected from the nominal
  /// robot's, else the calibrated robot's own.
  Command command(const Location& wanted, const std::optional<Eigen::VectorXd>& near) const;
  /// Of every solution within the limits, nearest first: all that the nominal robot has where it
  /// has a closed form (exact_inverse.h), those that were found else. Without any, what command()
  /// says.
  std::vector<Command> commands(const Location& wanted,
                                const std::optional<Eigen::VectorXd>& near) const;

 private:
  std::vector<ReachedPose> nominal_solutions(const Location& wanted, const Eigen::VectorXd& near,
                                             bool all) const;
  std::vector<ReachedPose> searched(const Location& wanted, const Eigen::VectorXd& near,
                                    bool all) const;
  /// `near`, and readings all over the range.
  Eigen::MatrixXd starts_from(const Eigen::VectorXd& near) const;
  Command best_of(const Location& wanted, const std::vector<ReachedPose>& solutions) const;
  std::optional<Command> own_solution(const Location& wanted, const Eigen::MatrixXd& starts,
                                      const Eigen::VectorXd& near, double at_most) const;
  std::optional<Command> nearer_own(const Location& wanted, const Command& command,
                                    const Eigen::VectorXd& near) const;
  Command corrected(const Location& wanted, const ReachedPose& nominal) const;
  Command corrected_from(const Location& wanted, const Eigen::VectorXd& near, bool there) const;
  Eigen::VectorXd turned_within(const Eigen::VectorXd& q) const;

  std::shared_ptr<const Robot> nominal_, calibrated_;
  OperatingPoint at_;
  Eigen::VectorXd xi_nominal_, xi_calibrated_, middle_;
  Eigen::MatrixXd starts_;  ///< where solutions are looked for
  ExactInverse exact_;
  ExactInverse exact_calibrated_;  ///< of a parallel robot
};

}  // namespace selfcal
