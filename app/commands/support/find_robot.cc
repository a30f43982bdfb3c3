#include "app/commands/support/find_robot.h"

#include "app/commands/support/signals.h"
#include "app/report/format.h"
#include "io/clock.h"
#include "io/dds/clients/discovery.h"

namespace selfcal {
namespace {

// Participants answer a newcomer at once; after the first, others have this long.
constexpr Nanoseconds kOthers = kSecond / 2;

}  // namespace

void add_whom(CLI::App& command, Whom& whom, const std::string& what_waits) {
  command.add_option("--robot", whom.robot, "Id of the robot (default: the only one heard)");
  const CLI::Option* domain =
      command.add_option("--domain", whom.domain, "DDS domain (default: ROS_DOMAIN_ID, or 0)")
          ->check(CLI::Range(0, static_cast<int>(kMostDdsDomain)));
  // An envname() would be read for commands that were not asked for, too.
  command.parse_complete_callback([&whom, domain] {
    if (domain->count() > 0) return;
    const auto of_environment = domain_of_environment();
    if (!of_environment) throw CLI::ValidationError(of_environment.error().what);
    whom.domain = *of_environment;
  });
  command.add_option("--wait", whom.wait, what_waits)
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command.add_flag("--json", whom.json, "JSON for programs");
}

Result<std::optional<std::vector<std::string>>> find_robots(const DdsParticipant& participant,
                                                            const Whom& whom) {
  if (!whom.robot.empty()) return std::vector{whom.robot};
  Wakeup wakeup;
  auto discovery = DdsRobots::open(participant, wakeup);
  if (!discovery) return tl::unexpected(discovery.error());
  Nanoseconds end = monotonic_now() + nanoseconds(whom.wait);
  std::vector<std::string> robots;
  for (Nanoseconds now = 0; (now = monotonic_now()) < end;) {
    wakeup.wait(std::min(kSignalWait, end - now));
    if (told_to_stop()) return std::nullopt;
    auto heard = (*discovery)->heard();
    if (!heard) return tl::unexpected(heard.error());
    if (robots.empty() && !heard->empty()) end = std::min(end, monotonic_now() + kOthers);
    robots = *std::move(heard);
  }
  if (robots.empty())
    return device_failed(
        printed("no service was heard in DDS domain %d within %g s; is `selfcal serve` running "
                "there? (--domain, CYCLONEDDS_URI)",
                whom.domain, whom.wait));
  return robots;
}

Result<std::optional<std::string>> find_robot(const DdsParticipant& participant, const Whom& whom) {
  const auto found = find_robots(participant, whom);
  if (!found) return tl::unexpected(found.error());
  if (!*found) return std::nullopt;
  const std::vector<std::string>& robots = **found;
  if (robots.size() == 1) return robots.front();
  std::string list;
  for (const std::string& robot : robots) list += (list.empty() ? "" : ", ") + one_line(robot);
  return tl::unexpected<Failure>(
      {kWrongUsage, printed("%zu robots are in DDS domain %d: ", robots.size(), whom.domain) +
                        list + "; choose one with --robot"});
}

}  // namespace selfcal
