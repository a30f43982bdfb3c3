// What a robot's controller can take of a calibration, and how far that gets it.
//
// A controller has a base and a tool frame, the joints' offsets, the lengths and the angles that
// its own inverse kinematics has, and nothing else. What the rest of the calibration says is given
// to these as far as they can take it: their values are fitted anew so that a robot that has
// nothing else is nearest to the calibrated one, effects included.
#pragma once

#include <vector>

#include "kinematics/inverse/operating_point.h"

namespace selfcal {

/// Parameters that a controller usually takes (indices): base and tool frames, the joints' offsets,
/// nonzero r and d, angles that are no multiples of a quarter turn; of a robot with loops all of
/// them, which its inverse model holds.
std::vector<int> controller_parameters(const Robot& nominal);

/// Off the calibrated robot at the same readings (m, rad).
struct ControllerError {
  double rms = 0, most = 0, rms_angle = 0, most_angle = 0;
  int configurations = 0;
};

struct ControllerModel {
  std::vector<int> taken;
  Eigen::VectorXd xi;        ///< of the nominal robot: these fitted, the others the maker's
  Eigen::VectorXd as_found;  ///< the same with these as they were identified
};

/// Fitted over configurations `q` (one a row, at least one) that both robots can take.
ControllerModel controller_model(const Robot& nominal, const Robot& calibrated,
                                 const Eigen::MatrixXd& q, const OperatingPoint& at = {});

/// Of the nominal robot with parameters `xi`, over those of the configurations that both can take.
ControllerError controller_error(const Robot& nominal, const Eigen::VectorXd& xi,
                                 const Robot& calibrated, const Eigen::MatrixXd& q,
                                 const OperatingPoint& at = {});

}  // namespace selfcal
