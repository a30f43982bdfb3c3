// selfcal serve CONFIG.yaml: the service, with a real robot or a simulated one.
#include <fcntl.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <memory>
#include <system_error>

#include "app/commands/subcommand.h"
#include "app/commands/support/cell_plan.h"
#include "app/commands/support/signals.h"
#include "app/commands/support/simulated_robot.h"
#include "app/report/progress_line.h"
#include "app/service/loop/pose_thread.h"
#include "app/service/loop/service.h"
#include "io/clock.h"
#include "io/dds/context.h"
#include "io/dds/messenger.h"
#include "io/dds/motion.h"
#include "io/dds/names.h"
#include "io/dds/participant.h"
#include "io/dds/thermometer.h"
#include "io/files/file.h"
#include "io/store/folder.h"
#include "io/urgency.h"
#include "sim/ports.h"

namespace selfcal {
namespace {

constexpr int kMostSessions = 1'000'000;
constexpr Nanoseconds kRivalSearch = kSecond / 2;  // discovery takes a tenth of it

struct ServeArguments {
  std::string config, truth, log = "info";
  bool simulate = false, check = false;
  int sessions = 0;  ///< 0: no end
};

/// The state folder belongs to one service at a time.
class Lock {
 public:
  static Result<Lock> take(const std::filesystem::path& folder) {
    const std::string path = folder / "lock";
    const int file = ::open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
    if (file < 0) return device_failed(path + ": cannot be made");
    if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      ::close(file);
      return device_failed(error == EWOULDBLOCK
                               ? folder.string() + ": another service is using it"
                               : path + ": " + std::generic_category().message(error));
    }
    return Lock(file);
  }
  Lock(Lock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  Lock& operator=(Lock&&) = delete;
  ~Lock() {
    if (file_ >= 0) ::close(file_);
  }

 private:
  explicit Lock(int file) : file_(file) {}
  int file_;
};

/// The ports of a real robot: encoders and trigger of the configured kinds, the rest over DDS.
struct RobotPorts {
  std::unique_ptr<EncoderSource> encoders;
  std::unique_ptr<TouchTrigger> trigger;
  std::unique_ptr<DdsMotion> motion;
  std::unique_ptr<DdsThermometer> thermometer;

  static Result<RobotPorts> open(const DdsParticipant& participant, const Config& config,
                                 Wakeup& wakeup, Wakeup& trigger_wakeup) {
    RobotPorts ports;
    const DdsContext dds{participant};
    auto encoders = config.encoders->open({dds, wakeup});
    if (!encoders) return tl::unexpected(encoders.error());
    auto trigger = config.trigger->open({dds, trigger_wakeup, nanoseconds(config.silence)});
    if (!trigger) return tl::unexpected(trigger.error());
    auto motion = DdsMotion::open(participant, config.id, wakeup);
    if (!motion) return tl::unexpected(motion.error());
    ports.encoders = std::move(*encoders);
    ports.trigger = std::move(*trigger);
    ports.motion = std::move(*motion);
    if (config.temperature_topic.empty()) return ports;
    auto thermometer = DdsThermometer::open(participant, {.topic = config.temperature_topic});
    if (!thermometer) return tl::unexpected(thermometer.error());
    ports.thermometer = std::move(*thermometer);
    return ports;
  }
};

/// The level as the journal takes it from the beginning of a line: <3> error to <7> debug.
class JournalLevel final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& out) override {
    const int level = message.level >= spdlog::level::err    ? 3
                      : message.level == spdlog::level::warn ? 4
                      : message.level == spdlog::level::info ? 6
                                                             : 7;
    const std::string text = "<" + std::to_string(level) + ">";
    out.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<JournalLevel>();
  }
};

void set_up_log(const std::string& level) {
  auto log = spdlog::stderr_logger_mt("selfcal");
  if (std::getenv("JOURNAL_STREAM")) {  // which adds the time by itself
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<JournalLevel>('*').set_pattern("%*%v");
    log->set_formatter(std::move(formatter));
  } else {
    log->set_pattern("%Y-%m-%d %H:%M:%S %l: %v");
  }
  log->set_level(spdlog::level::from_str(level));
  spdlog::set_default_logger(std::move(log));
}

void run_sessions(Service& service, int sessions, PoseThread* poses) {
  while (!told_to_stop() && (sessions == 0 || service.extended_state().published < sessions)) {
    service.turn();
    if (poses) poses->use(service.models());
  }
  service.shut_down();
}

Result<void> serve(const ServeArguments& arguments, Config config) {
  if (auto made = make_folder(config.state); !made) return made;
  const auto lock = Lock::take(config.state);
  if (!lock) return tl::unexpected(lock.error());
  const auto taken_over = own_folder(config.state, config.id);
  if (!taken_over) return tl::unexpected(taken_over.error());
  if (*taken_over)
    spdlog::warn("{}: its store was nobody's by name, and is robot {}'s from now on (robot.id)",
                 config.state.string(), config.id);
  auto opened = Store::open(config.state);
  if (!opened) return tl::unexpected(opened.error());
  auto models = Models::load(config.robot, *opened->store);
  if (!models) return tl::unexpected(models.error());
  // Before the file that others read changes with them.
  if (!opened->set_aside.empty()) spdlog::error("{}", opened->set_aside);
  if (!models->refused().empty()) spdlog::error("{}", models->refused());
  if (auto written = models->write_active(config.state); !written) return written;

  const auto reach = dds_reach(config.domain, robot_topic(config.id, "command"));
  if (!reach) return tl::unexpected(reach.error());
  if (auto held = config.commands.hold(*reach); !held) return held;
  spdlog::info("robot {} in DDS domain {}, topics rt/selfcal/{}/...; {}", config.id, config.domain,
               ros_name(config.id), config.commands.text());
  receive_urgently();
  if (!may_become_urgent())
    spdlog::info(
        "no real-time priority here: on a busy computer a touch may be noticed late (LimitRTPRIO)");

  Wakeup wakeup, trigger_wakeup;
  SystemClock clock(wakeup), trigger_clock(trigger_wakeup);
  auto participant =
      DdsParticipant::open(static_cast<std::uint32_t>(config.domain), "selfcal " + config.id);
  if (!participant) return tl::unexpected(participant.error());
  const auto taken = has_service(*participant, config.id, kRivalSearch, wakeup);
  if (!taken) return tl::unexpected(taken.error());
  if (*taken)
    return device_failed("a service of robot " + config.id + " is in DDS domain " +
                         std::to_string(config.domain) + " already: one robot has one service");
  auto messenger = DdsMessenger::open(*participant, config.id, wakeup);
  if (!messenger) return tl::unexpected(messenger.error());

  // Who may command it may ask it for readings.
  std::unique_ptr<PoseThread> poses;
  if (config.commands.over != CommandRules::Over::none) {
    auto opened_poses = PoseThread::open(*participant, config.id, *models);
    if (!opened_poses) return tl::unexpected(opened_poses.error());
    poses = *std::move(opened_poses);
  }

  auto beside = Store::open(config.state);
  if (!beside) return tl::unexpected(beside.error());
  Journal journal(std::move(beside->store));
  const auto serve_with = [&](const Ports& ports) {
    Service service(config, ports, **messenger, *opened->store, journal, std::move(*models),
                    opened->set_aside);
    run_sessions(service, arguments.sessions, poses.get());
    return Result<void>{};
  };
  if (!arguments.simulate) {
    auto robot = RobotPorts::open(*participant, config, wakeup, trigger_wakeup);
    if (!robot) return tl::unexpected(robot.error());
    return serve_with({&clock, robot->encoders.get(), robot->trigger.get(), robot->motion.get(),
                       robot->thermometer.get(), &trigger_clock, &wakeup});
  }
  auto machine = load_machine(config.simulation, config);
  if (!machine) return tl::unexpected(machine.error());
  SimulatedPorts simulated(**machine, clock.unix_ms(), [&](Nanoseconds longest) {
    const Nanoseconds began = clock.now();
    clock.wait(longest);
    return clock.now() - began;
  });
  auto served = serve_with(simulated.ports());
  if (!arguments.truth.empty())
    if (auto written = write_file_atomically(arguments.truth, machine_truth(**machine)); !written)
      return written;
  return served;
}

/// What a session would do, for a person.
int show_plan(const Config& config) {
  std::printf("%s: robot %s, %zu joints, state in %s, DDS domain %d\n", config.id.c_str(),
              config.robot->name().c_str(), config.robot->joints().size(), config.state.c_str(),
              config.domain);
  std::printf("  encoders: %s\n  trigger: %s\n", config.encoders->source().c_str(),
              config.trigger->source().c_str());
  ProgressLine line;
  const CellPlan cell =
      plan_cell(config, [&](std::string_view stage, double share) { line.show(stage, share); });
  std::fputs(cell_plan_report(config, cell).c_str(), stdout);
  return cell.reaches(config) ? kDone : kAnswerIsNo;
}

int serve_command(const ServeArguments& arguments) {
  auto config = load_config(arguments.config);
  if (!config) return tell(config.error());
  if (arguments.simulate && config->simulation.empty())
    return wrong_usage("--simulate needs `simulation: SCENARIO.yaml` in " + arguments.config);
  if (arguments.simulate)
    if (const auto machine = load_machine(config->simulation, *config); !machine)
      return tell(machine.error());
  if (const auto owned = may_own_folder(config->state, config->id); !owned)
    return tell(owned.error());
  if (arguments.check) return show_plan(*config);
  set_up_log(arguments.log);
  listen_to_signals();
  if (const auto served = serve(arguments, std::move(*config)); !served)
    return tell(served.error());
  return kDone;
}

}  // namespace

void add_serve(CLI::App& app, int& status) {
  auto arguments = std::make_shared<ServeArguments>();
  CLI::App* command = app.add_subcommand("serve", "Run the calibration service of one robot");
  command->add_option("CONFIG", arguments->config, "CONFIG.yaml (see man selfcal-config)")
      ->required();
  CLI::Option* simulate =
      command->add_flag("--simulate", arguments->simulate,
                        "With the simulated robot of the configuration's `simulation`");
  CLI::Option* check =
      command->add_flag("--check", arguments->check, "Validate, print the plan, and end");
  command
      ->add_option("--sessions", arguments->sessions, "End after so many sessions (default: never)")
      ->check(CLI::Range(1, kMostSessions))
      ->excludes(check);
  command
      ->add_option("--truth", arguments->truth,
                   "With --simulate: file for what the simulated robot really is")
      ->needs(simulate)
      ->excludes(check);
  command->add_option("--log", arguments->log, "Least level logged")
      ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
      ->capture_default_str()
      ->excludes(check);
  command->callback([arguments, &status] { status = serve_command(*arguments); });
}

}  // namespace selfcal
