// A robot as its file has it and as a person reads it, beside its mathematics.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "kinematics/description.h"

namespace selfcal {

class RobotText {
 public:
  virtual ~RobotText() = default;

  /// The robot file's content with parameter values `xi`; the prior's centre is kept as `nominal`.
  virtual Node describe(const Eigen::VectorXd& xi) const = 0;

  /// Text that is equal for two files of one machine whatever their calibration: the maker's
  /// figures and the structure. Its SHA-256 is the model hash.
  virtual std::string identity() const = 0;

  /// What `robot check` tells a person about the model beside its parameters, line by line.
  virtual std::vector<std::string> remarks() const = 0;
};

}  // namespace selfcal
