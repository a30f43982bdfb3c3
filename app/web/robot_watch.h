// One robot of the domain: what its service tells goes to the board.
//
//   part       what
//   status, progress, result, health   the last of each, as `monitor --json` has it; a result
//              without its own JSON, but with "changes" (from the maker's figures) and "sets"
//   silence    {"silent"}: whole seconds, 0 while it is heard
//   cell, pose, history, slots         of its configuration: CellView, Archive
//   list       touches (of one session, "at" where its plan is known), news (lines)
#pragma once

#include <memory>
#include <string>

#include "app/report/live/listener.h"
#include "app/report/live/monitor_news.h"
#include "app/web/archive.h"
#include "app/web/board.h"
#include "app/web/cell_view.h"

namespace selfcal {

class RobotWatch {
 public:
  static constexpr std::size_t kTouches = 2000, kNews = 200;  ///< kept

  /// Watches `robot`, as it stands in topics; `cell` is null where no configuration is given.
  static Result<std::unique_ptr<RobotWatch>> open(const DdsParticipant& participant,
                                                  const std::string& robot, Wakeup& wakeup,
                                                  std::unique_ptr<CellView> cell, Board& board);

  /// Takes what has come, and its part of what came for all robots. Whether its line of the fleet
  /// may have changed.
  bool take(const std::vector<HealthReport>& health);
  const Watched& watched() const { return listener_.watched(); }
  bool connected() const { return monitor_->connected(); }
  std::unique_ptr<CellView> give_back_cell() { return std::move(cell_); }

 private:
  RobotWatch(std::string robot, std::unique_ptr<DdsMonitor> monitor, std::unique_ptr<CellView> cell,
             Board& board);

  void note(const StatusMessage& status);
  void note(const ProgressMessage& progress);
  void note(const ResultMessage& result);
  void note(const HealthReport& report);
  void tell(std::int64_t unix_ms, const std::string& line);
  void look_at_robot(Nanoseconds now);
  void read_archive(Nanoseconds now);

  std::string robot_;
  std::unique_ptr<DdsMonitor> monitor_;
  Listener listener_;
  News news_;
  std::unique_ptr<CellView> cell_;
  std::unique_ptr<Archive> archive_;
  Board& board_;
  std::int64_t session_ = 0;  // of the touches on the board
  std::string settled_;       // what of the status the archive was read for
  Nanoseconds archive_due_ = 0, looked_ = 0;
  Nanoseconds joints_heard_ = 0;  // 0: never
  bool silent_ = false;
};

}  // namespace selfcal
