// What to command so that a calibrated robot is where it is wanted (Khalil and Dombre 11.5): the
// inverse of the nominal robot first, then corrections until the calibrated one, its effects
// included, is there.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "kinematics/inverse/reach_pose.h"

namespace selfcal {

enum class Reach {
  reached,
  out_of_reach,  ///< neither the nominal nor the calibrated robot gets there
  limit,         ///< only with a joint beyond its limit
  singular,  ///< the nominal robot gets there, the calibrated one does not, or only far from there
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
  /// Robots of the same joints. `starts`, readings that both can take (rows x joints), are where
  /// inverses are looked for; the first kLanes - 1 count.
  Compensation(std::shared_ptr<const Robot> nominal, std::shared_ptr<const Robot> calibrated,
               const Eigen::MatrixXd& starts);

  /// Of all solutions the one nearest to `near`, or to the middle of the readings.
  Command command(const Location& wanted, const std::optional<Eigen::VectorXd>& near) const;

 private:
  std::vector<ReachedPose> nominal_solutions(const Location& wanted,
                                             const Eigen::VectorXd& near) const;
  Command corrected(const Location& wanted, const ReachedPose& nominal) const;

  std::shared_ptr<const Robot> nominal_, calibrated_;
  Eigen::VectorXd xi_nominal_, xi_calibrated_, middle_;
  Eigen::MatrixXd starts_;
};

/// Parameters that a controller usually takes (indices): base and tool frames, the joints' offsets,
/// nonzero r and d, angles that are no multiples of a quarter turn; of a robot with loops all of
/// them, which its inverse model holds.
std::vector<int> controller_parameters(const Robot& nominal);

}  // namespace selfcal
