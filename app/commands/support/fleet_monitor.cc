#include "app/commands/support/fleet_monitor.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "app/commands/support/live_screen.h"
#include "app/commands/support/signals.h"
#include "app/report/format.h"
#include "app/report/live/domain_listener.h"
#include "app/report/live/fleet.h"
#include "app/report/live/message_lines.h"
#include "app/report/live/screen.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kAllTold = 2500 * kMillisecond;  // status and health come once a second
constexpr int kEveryColumn = 10000;

/// One robot of the domain, its messages as lines where they are wanted.
class FleetRobot {
 public:
  FleetRobot(const std::string& robot, std::unique_ptr<DdsMonitor> monitor, bool lines, bool json)
      : monitor_(std::move(monitor)), listener_(*monitor_, robot), lines_(json, robot) {
    tells_ = lines;
  }

  bool take(const std::vector<HealthReport>& health) {
    const auto each = [this](const auto& message) { note(message); };
    listener_.hear(health, each);
    const bool news = listener_.take(each) || !health.empty();
    if (tells_) lines_.add_silence(watched());
    return news;
  }
  const Watched& watched() const { return listener_.watched(); }
  bool connected() const { return monitor_->connected(); }
  bool flush() { return lines_.flush(); }

 private:
  template <class Message>
  void note(const Message& message) {
    if (!tells_) return;
    if constexpr (std::is_same_v<Message, HealthReport>)
      lines_.add(watched().robot, message);
    else
      lines_.add(message);
  }

  std::unique_ptr<DdsMonitor> monitor_;
  Listener listener_;
  MessageLines lines_;
  bool tells_;
};

using Fleet = DomainListener<FleetRobot>;

Result<Fleet> watch(const DdsParticipant& participant, Wakeup& wakeup, bool lines, bool json) {
  return Fleet::open(participant, wakeup,
                     [&participant, &wakeup, lines,
                      json](const std::string& robot) -> Result<std::unique_ptr<FleetRobot>> {
                       auto monitor = DdsMonitor::open(participant, robot, wakeup, false);
                       if (!monitor) return tl::unexpected(monitor.error());
                       return std::make_unique<FleetRobot>(robot, *std::move(monitor), lines, json);
                     });
}

std::vector<Line> fleet_now(const Fleet& fleet, int columns, int rows) {
  std::vector<nlohmann::ordered_json> lines;
  for (const auto& [name, robot] : fleet.robots()) lines.push_back(fleet_line(robot->watched()));
  return fleet_picture(fleet_json(std::move(lines)), unix_now_ms(), columns, rows);
}

/// For what every robot tells once a second, and its last result.
Result<void> listen_to_all(Fleet& fleet, Wakeup& wakeup, const Whom& whom) {
  const Nanoseconds begin = monotonic_now();
  const Nanoseconds end = begin + std::min(nanoseconds(whom.wait), kAllTold);
  for (Nanoseconds now = begin; now < end && !told_to_stop(); now = monotonic_now()) {
    if (const auto taken = fleet.take(); !taken) return tl::unexpected(taken.error());
    wakeup.wait(std::min(kSignalWait, end - now));
  }
  return {};
}

void print_table(const Fleet& fleet) {
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  const int columns = terminal ? Screen::size().columns - 1 : kEveryColumn;
  for (const Line& line : fleet_now(fleet, columns, kEveryColumn))
    std::printf("%s\n", terminal ? painted(line).c_str() : line.text.c_str());
}

void print_json(const Fleet& fleet) {
  for (const auto& [name, robot] : fleet.robots()) print_last(robot->watched());
}

Result<void> follow_in_lines(Fleet& fleet, Wakeup& wakeup) {
  while (!told_to_stop()) {
    if (const auto taken = fleet.take(); !taken) return tl::unexpected(taken.error());
    for (const auto& [name, robot] : fleet.robots())
      if (!robot->flush()) return {};
    fleet.forget();
    wakeup.wait(kSignalWait);
  }
  return {};
}

Result<void> follow_on_terminal(Fleet& fleet, Wakeup& wakeup) {
  return show_live(
      wakeup,
      [&] {
        fleet.forget();
        return fleet.take();
      },
      [&](int columns, int rows) { return fleet_now(fleet, columns, rows); });
}

}  // namespace

int monitor_fleet(const DdsParticipant& participant, bool once, const Whom& whom) {
  const bool live = !once && !whom.json && isatty(STDOUT_FILENO) != 0;
  Wakeup wakeup;
  auto fleet = watch(participant, wakeup, !once && !live, whom.json);
  if (!fleet) return tell(fleet.error());
  const auto done = live    ? follow_on_terminal(*fleet, wakeup)
                    : !once ? follow_in_lines(*fleet, wakeup)
                            : listen_to_all(*fleet, wakeup, whom);
  if (!done) return tell(done.error());
  if (once) whom.json ? print_json(*fleet) : print_table(*fleet);
  return kDone;
}

}  // namespace selfcal
