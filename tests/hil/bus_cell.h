// A cell whose encoders are on a CAN bus and whose trigger is a GPIO line: the service in one
// process, the robot in another.
#pragma once

#include "tests/hil/wiring.h"
#include "tests/support/cell.h"

namespace selfcal {

/// The cell of a small session: 48 touches, so that it can be emulated in minutes.
CellOptions small_session();

/// Six joints of a CiA 402 arm on a bus, as CONFIG.yaml has them.
std::string encoders_on(const std::string& interface);

class BusCell : public Cell {
 public:
  BusCell(const CellOptions& options, const Wiring& service, const Wiring& robot);

  void start_bus_robot();
  /// Ends it; it then has told its truth and the edges it drove.
  void end_bus_robot();
  pid_t robot_pid() const { return robot_->pid(); }
  std::string robot_log() const;
  /// One JSON object for each edge that the robot drove (app/report/paced_output.h).
  std::vector<std::string> driven() const;

 private:
  std::unique_ptr<Running> robot_;
};

}  // namespace selfcal
