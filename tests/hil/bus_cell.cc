#include "tests/hil/bus_cell.h"

#include <sched.h>
#include <signal.h>

#include <cstdio>
#include <fstream>

#include "tests/support/text.h"

namespace selfcal {
namespace {

CellOptions on_the_line(CellOptions options, const Wiring& robot) {
  options.live = true;
  options.machine += (options.machine.empty() ? "" : ", ") + ("trigger_pull: " + robot.pull);
  return options;
}

}  // namespace

CellOptions small_session() {
  CellOptions options;
  options.touches = 8;
  // Emulated, a computation takes fifty times as long.
  options.config = "limits: {planning: 1800, computing: 1800}\n";
  return options;
}

std::string encoders_on(const std::string& interface) {
  std::string text =
      "encoders:\n  kind: socketcan\n  interface: " + interface + "\n  silence: 2\n  joints:\n";
  // 2^18 counts a turn behind a gear of 50: 0.5 urad.
  for (int j = 1; j <= 6; ++j)
    text += "    j" + std::to_string(j) + ": {cia402: {node: " + std::to_string(j) +
            "}, counts_per_turn: 262144, gear: 50, speed: 200}\n";
  return text;
}

BusCell::BusCell(const CellOptions& wanted, const Wiring& service, const Wiring& robot)
    : Cell(on_the_line(wanted, robot)) {
  std::string config = text_of(folder / "config.yaml");
  replace(config, "\ntrigger: {",
          "\ntrigger: {kind: gpio, chip: " + service.chip + ", line: " + service.line + ", ");
  // Half a metre a second is no speed to meet a surface with: 10 us would be 5 um.
  replace(config, "touch_speed: 0.5", "touch_speed: 0.2");
  std::ofstream(folder / "config.yaml") << config << encoders_on(service.interface);
  std::ofstream(folder / "robot.yaml") << config << encoders_on(robot.robot_interface);
}

void BusCell::start_bus_robot() {
  robot_ = std::make_unique<Running>(
      std::vector<std::string>{"simulate", folder / (options.robot + "_cell.scenario.yaml"),
                               "--live", folder / "robot.yaml", "--truth", folder / "truth.json",
                               "--touches", folder / "touches.jsonl"},
      folder / "robot.log");
  // A real robot has a processor of its own; here the service must not take it away.
  const sched_param priority = {.sched_priority = 10};
  if (sched_setscheduler(robot_->pid(), SCHED_FIFO | SCHED_RESET_ON_FORK, &priority) != 0)
    std::printf("the robot runs without priority: its touches may come late\n");
}

void BusCell::end_bus_robot() {
  if (robot_) {
    EXPECT_EQ(robot_->end(SIGTERM), 0) << robot_log();
  }
  robot_.reset();
}

std::string BusCell::robot_log() const { return text_of(folder / "robot.log"); }

std::vector<std::string> BusCell::driven() const {
  std::ifstream stream(folder / "touches.jsonl");
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace selfcal
