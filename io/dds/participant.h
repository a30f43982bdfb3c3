// Our presence in a DDS domain.
//
// Which networks it uses is the environment's matter (CYCLONEDDS_URI), as it is for ROS 2; what it
// says of Internal/MaxSampleSize takes precedence over kMostMessageBytes.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>
#include <string>

#include "io/dds/entity.h"
#include "io/result.h"

namespace selfcal {

inline constexpr std::uint32_t kMostDdsDomain = 232;  ///< beyond it the ports run out

/// The domain that the environment names (ROS_DOMAIN_ID), as it is for ROS 2; 0 where it names
/// none.
Result<int> domain_of_environment();

/// A message beyond this is neither sent nor taken, whoever sends it: none of ours comes near.
inline constexpr std::size_t kMostMessageBytes = std::size_t{4} << 20;

class DdsParticipant {
 public:
  /// Joins `domain`, 0 to `kMostDdsDomain`; `name` is seen by others as the participant's name.
  /// Must outlive what is opened in it.
  static Result<DdsParticipant> open(std::uint32_t domain, const std::string& name);

  dds_entity_t handle() const { return entity_.handle(); }

 private:
  DdsParticipant(std::shared_ptr<DdsEntity> domain, DdsEntity entity)
      : domain_(std::move(domain)), entity_(std::move(entity)) {}
  std::shared_ptr<DdsEntity> domain_;  ///< gone after the last participant of the process in it
  DdsEntity entity_;
};

}  // namespace selfcal
