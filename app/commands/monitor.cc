// selfcal monitor: what a service publishes, live: a picture on a terminal, lines elsewhere, JSON
// for programs.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/commands/support/find_robot.h"
#include "app/commands/support/fleet_monitor.h"
#include "app/commands/support/live_screen.h"
#include "app/commands/support/signals.h"
#include "app/commands/support/user.h"
#include "app/report/format.h"
#include "app/report/live/listener.h"
#include "app/report/live/message_lines.h"
#include "app/report/live/monitor_view.h"
#include "app/report/live/screen.h"
#include "app/web/serve_page.h"
#include "io/clock.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kRest = 1200 * kMillisecond;  // for what follows a first status: health, once
                                                    // a second, and the last result

struct MonitorArguments {
  Whom whom;
  bool once = false;
  std::string web;  // ADDRESS:PORT; empty without the page
  PageOptions page;
};

Result<void> watch_on_terminal(Listener& listener, Wakeup& wakeup) {
  return show_live(
      wakeup, [&]() -> Result<bool> { return listener.take([](const auto&) {}); },
      [&](int columns, int rows) {
        return picture(listener.watched(), unix_now_ms(), columns, rows);
      });
}

void watch_in_lines(Listener& listener, Wakeup& wakeup, bool json) {
  MessageLines output(json);
  const std::string robot = listener.watched().robot;
  const auto add = [&](const auto& message) {
    if constexpr (std::is_same_v<decltype(message), const HealthReport&>)
      output.add(robot, message);
    else
      output.add(message);
  };
  while (!told_to_stop()) {
    listener.take(add);
    output.add_silence(listener.watched());
    if (!output.flush()) return;
    wakeup.wait(kSignalWait);
  }
}

/// Everything that a late joiner is told, or what there is when the time is over.
void listen_once(Listener& listener, Wakeup& wakeup, Nanoseconds end) {
  const Watched& watched = listener.watched();
  for (Nanoseconds now = 0; (now = monotonic_now()) < end && !told_to_stop();) {
    const bool had_status = watched.status.has_value();
    listener.take([](const auto&) {});
    if (!had_status && watched.status) end = std::min(end, now + kRest);
    if (watched.status && watched.result && !watched.health.empty()) return;
    wakeup.wait(std::min(kSignalWait, end - now));
  }
}

int show_once(Listener& listener, Wakeup& wakeup, const Whom& whom) {
  listen_once(listener, wakeup, monotonic_now() + nanoseconds(whom.wait));
  const Watched& watched = listener.watched();
  if (told_to_stop()) return kDone;
  if (!watched.status)
    return tell({kDeviceIsBad, printed("no service of robot %s was heard in DDS domain %d within "
                                       "%g s",
                                       watched.robot.c_str(), whom.domain, whom.wait)});
  if (whom.json) {
    print_last(watched);
    return kDone;
  }
  constexpr int kNoLimit = 10000;
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  const int columns = terminal ? Screen::size().columns - 1 : kNoLimit;
  for (const Line& line : picture(watched, unix_now_ms(), columns, kNoLimit))
    std::printf("%s\n", terminal ? painted(line).c_str() : line.text.c_str());
  return kDone;
}

int serve_in_browsers(const DdsParticipant& participant, const MonitorArguments& arguments) {
  const auto address = parse_web_address(arguments.web);
  if (!address) return tell(address.error());
  PageOptions options = arguments.page;
  options.address = *address;
  options.domain = arguments.whom.domain;
  options.robot = arguments.whom.robot;
  options.from = user_at_host();
  const auto served = serve_page(participant, options, told_to_stop);
  return served ? kDone : tell(served.error());
}

int monitor_command(const MonitorArguments& arguments) {
  listen_to_signals();
  const Whom& whom = arguments.whom;
  const auto participant =
      DdsParticipant::open(static_cast<std::uint32_t>(whom.domain), "selfcal monitor");
  if (!participant) return tell(participant.error());
  if (!arguments.web.empty()) return serve_in_browsers(*participant, arguments);
  const auto robots = find_robots(*participant, whom);
  if (!robots) return tell(robots.error());
  if (!*robots) return kDone;
  if ((*robots)->size() > 1) return monitor_fleet(*participant, arguments.once, whom);
  const std::string& robot = (*robots)->front();
  Wakeup wakeup;
  const auto monitor = DdsMonitor::open(*participant, robot, wakeup);
  if (!monitor) return tell(monitor.error());
  Listener listener(**monitor, robot);
  if (arguments.once) return show_once(listener, wakeup, whom);
  if (!whom.json && isatty(STDOUT_FILENO) != 0) {
    const auto watched = watch_on_terminal(listener, wakeup);
    return watched ? kDone : tell(watched.error());
  }
  watch_in_lines(listener, wakeup, whom.json);
  return kDone;
}

}  // namespace

void add_monitor(CLI::App& app, int& status) {
  auto arguments = std::make_shared<MonitorArguments>();
  CLI::App* command = app.add_subcommand("monitor", "Show what a service publishes, live");
  add_whom(*command, arguments->whom, "Most seconds to wait for a service to be found");
  CLI::Option* once = command->add_flag("--once", arguments->once, "Show what there is, and end");
  CLI::Option* web = command->add_option("--web", arguments->web,
                                         "ADDRESS:PORT: serve a page for browsers, of all robots "
                                         "of the domain; it only shows");
  for (CLI::Option* other : {once, command->get_option("--wait"), command->get_option("--json")})
    web->excludes(other);
  command
      ->add_option("CONFIG", arguments->page.configs,
                   "With --web: configurations of robots that are drawn in space, with their "
                   "history; the state's folder must be readable")
      ->needs(web);
  command
      ->add_flag("--allow-commands", arguments->page.commands,
                 "With --web: who reaches the page may command the robots")
      ->needs(web);
  command
      ->add_option("--token", arguments->page.token_file,
                   "With --web: FILE with the token that the page asks for; without it one is made "
                   "and printed where ADDRESS is not of this computer alone")
      ->needs(web);
  command->callback([arguments, &status] { status = monitor_command(*arguments); });
}

}  // namespace selfcal
