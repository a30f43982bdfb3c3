#include "io/dds/clients/diagnostics.h"

#include "io/dds/convert.h"
#include "io/dds/names.h"

namespace selfcal {
namespace {

// All robots write at the full second.
constexpr DdsQos kDiagnosticsOfAll{.depth = 1024};

/// The name before the first line's "/"; a service's message is of one robot.
std::string robot_of_lines(const dds::DiagnosticArray& array) {
  if (array.status_._length == 0) return {};
  const std::string_view name = array.status_._buffer[0].name_;
  const std::size_t end = name.find('/');
  return end == std::string_view::npos ? std::string() : std::string(name.substr(0, end));
}

}  // namespace

Result<std::unique_ptr<DdsDiagnostics>> DdsDiagnostics::open(const DdsParticipant& participant,
                                                             Wakeup& wakeup) {
  auto reader = DdsReader<dds::DiagnosticArray>::open(participant, ros_topic("diagnostics"),
                                                      kDiagnosticsOfAll, &wakeup);
  if (!reader) return tl::unexpected(reader.error());
  return std::unique_ptr<DdsDiagnostics>(new DdsDiagnostics(*std::move(reader)));
}

std::map<std::string, std::vector<HealthReport>> DdsDiagnostics::take() {
  std::map<std::string, std::vector<HealthReport>> reports;
  // A reader that fails has nothing more to tell, and the next call tries again.
  (void)reader_.take([&](const dds::DiagnosticArray& array) {
    const std::string robot = robot_of_lines(array);
    if (robot.empty()) return;  // of other programs, which use the topic too
    auto report = to_plain(array, robot);
    if (!report.lines.empty()) reports[robot].push_back(std::move(report));
  });
  return reports;
}

}  // namespace selfcal
