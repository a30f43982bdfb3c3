// What encoders and triggers over DDS, and the robot's ends of both, are opened with.
#pragma once

#include <memory>

#include "io/dds/participant.h"
#include "io/dds/time_mapping.h"

namespace selfcal {

/// The participant outlives the ports.
struct DdsContext {
  const DdsParticipant& participant;
  std::shared_ptr<TimeMapping> mapping = std::make_shared<TimeMapping>();  ///< of the one sender
};

}  // namespace selfcal
