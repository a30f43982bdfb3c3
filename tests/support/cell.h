// A cell of a test's own: the real service in one process, its robot in the same or in another,
// watched over DDS by the test.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/support/simulated_robot.h"
#include "app/service/config/config.h"
#include "io/dds/clients/commander.h"
#include "io/dds/clients/monitor.h"
#include "io/store/store.h"
#include "tests/support/domain.h"
#include "tests/support/process.h"

namespace selfcal {

struct CellOptions {
  std::string robot = "rx90";  ///< of app/examples/ROBOT_cell.*; the model's name to its first _
  std::string id = "cell";
  int seed = 2;
  double false_triggers = 0, missed = 0;  ///< shares
  int touches = 0;                        ///< of each set; 0 as the example has it
  bool automatic = true;                  ///< accept without a person
  bool live = false;                      ///< the robot is a process of its own, and a fast one
  std::string commands = {};              ///< what the configuration says; "" as the example
  std::string machine, config;            ///< further entries of `machine`, further lines
  std::optional<std::uint32_t> domain;    ///< a new one unless given
};

/// A number of repetitions: `fallback` unless the environment's `name` says otherwise.
int repetitions(const char* name, int fallback);

class Cell {
 public:
  explicit Cell(CellOptions options);
  ~Cell();

  void start_robot();
  void start_service(const std::string& preload = {});
  void kill_service() { service_.reset(); }
  void kill_robot() { robot_.reset(); }
  /// Ends the robot, which then tells its truth.
  void end_robot();
  /// Its exit status, once it has ended by itself.
  int wait_for_service() { return service_->wait(); }
  bool service_lives() { return service_ && service_->alive(); }
  pid_t service_pid() const { return service_->pid(); }

  /// What has come since the last call is appended to the lists below.
  void listen();
  /// Listens until `holds`, at most `limit`; a failure shows the service's log.
  bool until(const std::function<bool()>& holds, Nanoseconds limit = 300 * kSecond);
  /// The reply to a command, or a failed test.
  CommandReplyMessage command(const std::string& verb);
  /// Starts a session once the service is idle; false, and a failed test, when it does not begin.
  bool start_session();
  /// Touches that were told of.
  std::size_t touches() const {
    return std::ranges::count_if(progress, [](const auto& each) { return !each.set.empty(); });
  }
  bool in_state(const std::string& state) const {
    return !statuses.empty() && statuses.back().state == state;
  }
  std::string log() const;
  std::unique_ptr<Store> store() const { return must(Store::open_to_read(folder / "state")); }
  /// The same machine as the service's or the robot's, for its truth.
  std::unique_ptr<Machine> machine() const;

  std::vector<StatusMessage> statuses;
  std::vector<ProgressMessage> progress;
  std::vector<ResultMessage> results;
  std::vector<HealthReport> health;

  CellOptions options;
  std::filesystem::path folder;
  std::uint32_t domain;

 private:
  void write_files() const;

  Wakeup wakeup_;
  DdsParticipant participant_;
  std::unique_ptr<DdsMonitor> monitor_;
  std::unique_ptr<Running> service_, robot_;
};

}  // namespace selfcal
