// The health of all robots of a domain, by one reader: of a reader for each robot, every one would
// hear every robot, and each service would answer for all of them.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/dds/clients/monitor.h"
#include "io/dds/endpoint.h"

namespace selfcal {

class DdsDiagnostics {
 public:
  /// `wakeup` hears of everything that comes.
  static Result<std::unique_ptr<DdsDiagnostics>> open(const DdsParticipant& participant,
                                                      Wakeup& wakeup);

  /// What came since the last call, oldest first, by the robots' names as they stand in topics.
  std::map<std::string, std::vector<HealthReport>> take();

 private:
  explicit DdsDiagnostics(DdsReader<dds::DiagnosticArray> reader) : reader_(std::move(reader)) {}

  DdsReader<dds::DiagnosticArray> reader_;
};

}  // namespace selfcal
