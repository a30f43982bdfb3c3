// Our presence in a DDS domain.
//
// Which networks it uses is the environment's matter (CYCLONEDDS_URI), as it is for ROS 2.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <string>

#include "io/dds/entity.h"
#include "io/result.h"

namespace selfcal {

inline constexpr std::uint32_t kMostDdsDomain = 232;  ///< beyond it the ports run out

class DdsParticipant {
 public:
  /// Joins `domain`, 0 to `kMostDdsDomain`; `name` is seen by others as the participant's name.
  /// Must outlive what is opened in it.
  static Result<DdsParticipant> open(std::uint32_t domain, const std::string& name);

  dds_entity_t handle() const { return entity_.handle(); }

 private:
  explicit DdsParticipant(DdsEntity entity) : entity_(std::move(entity)) {}
  DdsEntity entity_;
};

}  // namespace selfcal
