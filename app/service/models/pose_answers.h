// What to command so that the robot is at a pose that somebody asks for, by the active parameters.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "io/dds/poses.h"
#include "kinematics/inverse/compensation.h"

namespace selfcal {

class PoseAnswers {
 public:
  /// By the robot of `active`, whose parameters are called `name`; of the maker's figures is
  /// `factory`, as the robot's controller has it. A question that cannot be understood is refused,
  /// with the reason.
  PoseReplyMessage answer(const PoseRequestMessage& question,
                          const std::shared_ptr<const Robot>& factory,
                          const std::shared_ptr<const Robot>& active, const std::string& name);

 private:
  /// The last compensation, made anew when model, load or temperature are others.
  std::shared_ptr<const Robot> active_;
  OperatingPoint at_;
  std::optional<Compensation> compensation_;
};

}  // namespace selfcal
