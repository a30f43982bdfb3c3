// Which services are there, by the topics that they write.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/dds/entity.h"
#include "io/dds/participant.h"
#include "io/wakeup.h"

namespace selfcal {

class DdsRobots {
 public:
  /// Listens from now on; `wakeup` hears of every writer in the domain that comes or goes, and
  /// must outlive this.
  static Result<std::unique_ptr<DdsRobots>> open(const DdsParticipant& participant, Wakeup& wakeup);

  /// Names, as they stand in topics, of the robots whose service is there now; sorted.
  Result<std::vector<std::string>> heard();

 private:
  explicit DdsRobots(DdsEntity reader) : reader_(std::move(reader)) {}

  DdsEntity reader_;
  std::map<dds_instance_handle_t, std::string> writers_;  // of status
};

/// The robot of a status topic "rt/selfcal/ROBOT/status"; empty of any other topic.
std::string robot_of_status(std::string_view topic);

}  // namespace selfcal
