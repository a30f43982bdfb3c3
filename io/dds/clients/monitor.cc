// What a service tells, for programs that watch it.

#include "io/dds/clients/monitor.h"

#include "io/dds/convert.h"
#include "io/dds/names.h"
#include "io/dds/opened.h"

namespace selfcal {
namespace {

// A reader that fails has nothing more to tell, and the next call tries again.
template <class Wire, class Plain>
void take_all(DdsReader<Wire>& reader, std::vector<Plain>& out) {
  (void)reader.take([&](const Wire& message) { out.push_back(to_plain(message)); });
}

}  // namespace

Result<std::unique_ptr<DdsMonitor>> DdsMonitor::open(const DdsParticipant& participant,
                                                     const std::string& robot, Wakeup& wakeup,
                                                     bool health) {
  Endpoints endpoints;
  DdsOpening opening(participant);
  opening.open(endpoints.status, robot_topic(robot, "status"), kLatchedReader, &wakeup);
  opening.open(endpoints.progress, robot_topic(robot, "progress"), kProgress, &wakeup);
  opening.open(endpoints.result, robot_topic(robot, "result"), kLatchedReader, &wakeup);
  if (health) opening.open(endpoints.diagnostics, ros_topic("diagnostics"), kDiagnostics, &wakeup);
  return opening.finish([&] {
    return std::unique_ptr<DdsMonitor>(new DdsMonitor(robot, std::move(endpoints), health));
  });
}

void DdsMonitor::take(std::vector<StatusMessage>& out) { take_all(dds_.status, out); }
void DdsMonitor::take(std::vector<ProgressMessage>& out) { take_all(dds_.progress, out); }
void DdsMonitor::take(std::vector<ResultMessage>& out) { take_all(dds_.result, out); }

void DdsMonitor::take(std::vector<HealthReport>& out) {
  if (!health_) return;
  (void)dds_.diagnostics.take([&](const dds::DiagnosticArray& array) {
    auto report = to_plain(array, robot_);
    if (!report.lines.empty()) out.push_back(std::move(report));
  });
}

}  // namespace selfcal
