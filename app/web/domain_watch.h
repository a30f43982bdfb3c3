// Every robot of the domain, as they come and go.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/web/board.h"
#include "app/web/robot_watch.h"
#include "io/dds/clients/diagnostics.h"
#include "io/dds/clients/discovery.h"

namespace selfcal {

class DomainWatch {
 public:
  static constexpr std::size_t kMostRobots = 256;
  /// A robot whose service has gone is shown as silent for so long.
  static constexpr double kRemembered = 3600;  ///< s

  /// `only`: the one robot to watch; empty for all. `cells` of robots that a configuration was
  /// given for. What is given by reference must outlive it.
  static Result<std::unique_ptr<DomainWatch>> open(const DdsParticipant& participant,
                                                   const std::string& only,
                                                   std::vector<std::unique_ptr<CellView>> cells,
                                                   Wakeup& wakeup, Board& board);

  /// Takes what has come; asked again at every news, and ten times a second at least.
  Result<void> take();

 private:
  DomainWatch(const DdsParticipant& participant, std::string only, Wakeup& wakeup, Board& board)
      : participant_(participant), only_(std::move(only)), wakeup_(wakeup), board_(board) {}
  Result<void> find();
  void forget();

  const DdsParticipant& participant_;
  std::string only_;
  Wakeup& wakeup_;
  Board& board_;
  std::unique_ptr<DdsRobots> discovery_;
  std::unique_ptr<DdsDiagnostics> diagnostics_;
  std::map<std::string, std::unique_ptr<CellView>> cells_;  // of robots not yet heard, by name
  std::map<std::string, std::unique_ptr<RobotWatch>> robots_;
  Nanoseconds told_ = 0;  // of the fleet
};

}  // namespace selfcal
