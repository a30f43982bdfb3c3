// What a service tells, for programs that watch it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/dds/endpoint.h"
#include "io/messages.h"

namespace selfcal {

class DdsMonitor {
 public:
  /// Watches the service of `robot`; its last status and result come at once. `wakeup` hears of
  /// everything that comes and of services that come and go. Without `health` that is left to a
  /// DdsDiagnostics, which hears all robots by one reader.
  static Result<std::unique_ptr<DdsMonitor>> open(const DdsParticipant& participant,
                                                  const std::string& robot, Wakeup& wakeup,
                                                  bool health = true);

  /// Each appends what came since its last call, oldest first.
  void take(std::vector<StatusMessage>& out);
  void take(std::vector<ProgressMessage>& out);
  void take(std::vector<ResultMessage>& out);
  void take(std::vector<HealthReport>& out);

  /// Whether a service is there.
  bool connected() const { return dds_.status.matched() > 0; }

 private:
  struct Endpoints {
    DdsReader<dds::Status> status;
    DdsReader<dds::Progress> progress;
    DdsReader<dds::Result> result;
    DdsReader<dds::DiagnosticArray> diagnostics;
  };
  DdsMonitor(std::string robot, Endpoints endpoints, bool health)
      : robot_(std::move(robot)), dds_(std::move(endpoints)), health_(health) {}

  std::string robot_;
  Endpoints dds_;
  bool health_;  // whether the reader of diagnostics is open
};

}  // namespace selfcal
