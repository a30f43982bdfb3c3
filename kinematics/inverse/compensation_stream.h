// Compensation in a control loop: a wanted pose a cycle, the command at once.
//
// A call takes a fixed number of damped Newton steps from the last command on, or the inverse of a
// parallel robot chain by chain; it is as long every time and touches no heap. What effects add to
// the pose is kept from the last refresh(), which takes as long as it takes.
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "kinematics/inverse/operating_point.h"
#include "kinematics/inverse/screw_chain.h"
#include "kinematics/robots/platform.h"

namespace selfcal {

enum class Streamed {
  reached,
  limit,   ///< there, but with a joint, a passive one included, beyond its limit
  behind,  ///< not there: too far from the last command, near a singular place, out of reach, for
           ///< another assembly mode, or no pose at all
};

struct StreamedCommand {
  Streamed status = Streamed::behind;
  double error = 0, error_angle = 0;  ///< what is left (m, rad)
};

class CompensationStream {
 public:
  /// Begins at readings `q`. Nothing of a robot that screw_chain() does not take and that is not
  /// parallel.
  static std::optional<CompensationStream> of(std::shared_ptr<const Robot> calibrated,
                                              const Eigen::VectorXd& q,
                                              const OperatingPoint& at = {});

  /// The readings for `wanted` are in q() then; where it is not reached they stay where they were.
  StreamedCommand command(const Location& wanted);
  const Eigen::VectorXd& q() const { return q_; }

  /// Looks anew at what effects do where the robot is now. Uses the heap.
  void refresh();

 private:
  /// A linear delta: its effector keeps this turn, the tool is so far from its joints (base axes).
  struct DeltaTool {
    Eigen::Matrix3d R;
    Eigen::Vector3d tool;
  };
  using Machine = std::variant<ScrewChain, const platform::Platform*, DeltaTool>;

  CompensationStream(std::shared_ptr<const Robot> calibrated, Machine machine,
                     const Eigen::VectorXd& q, const OperatingPoint& at);
  StreamedCommand step(const ScrewChain& chain, const Location& wanted);
  StreamedCommand step(const platform::Platform* platform, const Location& wanted);
  StreamedCommand step(const DeltaTool& delta, const Location& wanted);
  StreamedCommand take(const double* q, double error, double error_angle);

  std::shared_ptr<const Robot> calibrated_, geometry_;
  Machine machine_;
  OperatingPoint at_;
  Eigen::VectorXd xi_, xi_geometry_;
  double size_;           ///< of the robot (m)
  Eigen::ArrayXd units_;  ///< of its readings
  Eigen::VectorXd q_;
  Location deviation_;  ///< by which effects move the geometry's pose, in the world
};

}  // namespace selfcal
