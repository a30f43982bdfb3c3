// Every robot of the domain on the board, as they come and go.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/report/live/domain_listener.h"
#include "app/web/board.h"
#include "app/web/robot_watch.h"

namespace selfcal {

class DomainWatch {
 public:
  /// `only`: the one robot to watch; empty for all. `cells` of robots that a configuration was
  /// given for. What is given by reference must outlive it.
  static Result<std::unique_ptr<DomainWatch>> open(const DdsParticipant& participant,
                                                   const std::string& only,
                                                   std::vector<std::unique_ptr<CellView>> cells,
                                                   Wakeup& wakeup, Board& board);

  /// Takes what has come; asked again at every news, and ten times a second at least.
  Result<void> take();

 private:
  explicit DomainWatch(Board& board) : board_(board) {}

  Board& board_;
  std::map<std::string, std::unique_ptr<CellView>> cells_;  // of robots not yet heard, by name
  std::optional<DomainListener<RobotWatch>> listener_;
  Nanoseconds told_ = 0;  // of the fleet
};

}  // namespace selfcal
