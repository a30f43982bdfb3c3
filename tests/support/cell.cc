#include "tests/support/cell.h"

#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "io/clock.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

/// Replaces the rest of the line after `key` at the beginning of a line.
void set_line(std::string& text, const std::string& key, const std::string& value) {
  const std::size_t at = text.find("\n" + key + ":");
  if (at == std::string::npos) {
    text += key + ": " + value + "\n";
    return;
  }
  const std::size_t from = at + key.size() + 2, to = text.find('\n', from);
  text.replace(from, to - from, " " + value);
}

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

}  // namespace

int repetitions(const char* name, int fallback) {
  const char* value = std::getenv(name);
  return value ? std::atoi(value) : fallback;
}

Cell::Cell(CellOptions given)
    : options(std::move(given)),
      folder(std::filesystem::path(testing::TempDir()) /
             ("session_" + std::to_string(getpid()) + "_" + options.id)),
      domain(options.domain ? *options.domain : new_domain()),
      participant_(must(DdsParticipant::open(domain, "test"))),
      monitor_(must(DdsMonitor::open(participant_, options.id, wakeup_))) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  write_files();
}

Cell::~Cell() {
  service_.reset();
  robot_.reset();
  if (!testing::Test::HasFailure()) std::filesystem::remove_all(folder);
}

void Cell::write_files() const {
  const std::filesystem::path examples = SELFCAL_SOURCE_DIR "/app/examples";
  const std::string model = options.robot.substr(0, options.robot.find('_')) + ".robot.yaml";
  std::filesystem::copy_file(examples / model, folder / model);
  std::string config = text_of(examples / (options.robot + "_cell.config.yaml"));
  std::string scenario = text_of(examples / (options.robot + "_cell.scenario.yaml"));
  set_line(scenario, "seed", std::to_string(options.seed));
  set_line(scenario, "false_triggers",
           "{share: " + std::to_string(options.false_triggers) + ", size: [1.0e-3, 8.0e-3]}");
  std::string machine = "{encoder_period: 0.002, trigger_delay: 0.0005, bounce: 2, missed: " +
                        std::to_string(options.missed);
  machine += options.live ? ", speed: 60, acceleration: 3000" : ", speed: 6, acceleration: 60";
  const std::size_t from = scenario.find("\nmachine:"), to = scenario.find("\n\n", from);
  scenario.replace(
      from, to - from,
      "\nmachine: " + machine + (options.machine.empty() ? "" : ", ") + options.machine + "}");
  set_line(config, "id", options.id);
  set_line(config, "state", "state");
  set_line(config, "domain", std::to_string(domain));
  set_line(config, "accept",
           options.automatic ? "{auto: true, check: 0.2}" : "{auto: false, check: 0.2}");
  set_line(config, "simulation", options.robot + "_cell.scenario.yaml");
  set_line(config, "schedule", "{}");
  if (!options.commands.empty()) set_line(config, "commands", options.commands);
  if (options.live) {
    replace_all(config, "  speed: 3.0", "  speed: 40.0");
    replace_all(config, "touch_speed: 0.05", "touch_speed: 0.5");
  }
  if (options.touches > 0)
    for (const char* was : {"touches: 30", "touches: 60"})
      replace_all(config, was, "touches: " + std::to_string(options.touches));
  std::ofstream(folder / "config.yaml") << config << options.config;
  std::ofstream(folder / (options.robot + "_cell.scenario.yaml")) << scenario;
}

void Cell::start_robot() {
  robot_ = std::make_unique<Running>(
      std::vector<std::string>{"simulate", folder / (options.robot + "_cell.scenario.yaml"),
                               "--live", folder / "config.yaml", "--truth", folder / "truth.json"},
      folder / "robot.log");
}

void Cell::end_robot() {
  if (robot_) {
    EXPECT_EQ(robot_->end(SIGTERM), 0);
  }
  robot_.reset();
}

void Cell::start_service(const std::string& preload) {
  std::vector<std::string> arguments = {"serve", folder / "config.yaml"};
  if (!options.live) arguments.push_back("--simulate");
  service_ = std::make_unique<Running>(arguments, folder / "service.log", preload);
}

void Cell::listen() {
  monitor_->take(statuses);
  monitor_->take(progress);
  monitor_->take(results);
  monitor_->take(health);
}

bool Cell::until(const std::function<bool()>& holds, Nanoseconds limit) {
  const Nanoseconds end = monotonic_now() + limit;
  for (;;) {
    listen();
    if (holds()) return true;
    if (monotonic_now() > end) break;
    wakeup_.wait(20 * kMillisecond);
  }
  ADD_FAILURE() << "waited too long; the service's log:\n" << log();
  return false;
}

CommandReplyMessage Cell::command(const std::string& verb) {
  const auto commander = must(DdsCommander::open(participant_, options.id));
  return must(commander->send({DdsCommander::new_id(), verb, "test"}, 20 * kSecond));
}

bool Cell::start_session() {
  if (!until([&] { return in_state("idle"); })) return false;
  const CommandReplyMessage reply = command("start");
  EXPECT_TRUE(reply.accepted) << reply.why;
  return reply.accepted;
}

std::string Cell::log() const { return text_of(folder / "service.log"); }

std::unique_ptr<Machine> Cell::machine() const {
  return must(load_machine(folder / (options.robot + "_cell.scenario.yaml"),
                           must(load_config(folder / "config.yaml"))));
}

}  // namespace selfcal
