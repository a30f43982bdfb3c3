#include "app/web/robot_watch.h"

#include <cmath>

#include "app/report/format.h"
#include "app/report/live/message_json.h"
#include "app/web/changes.h"

namespace selfcal {
namespace {

using WatchJson = nlohmann::ordered_json;

constexpr Nanoseconds kPoseEvery = kSecond / 10;
constexpr Nanoseconds kJointsLast = 2 * kSecond;   // after the last joint state
constexpr Nanoseconds kStoreLate = kSecond;        // what was told of is in the store by then
constexpr Nanoseconds kStoreEvery = 15 * kSecond;  // the log grows without being told of

}  // namespace

Result<std::unique_ptr<RobotWatch>> RobotWatch::open(const DdsParticipant& participant,
                                                     const std::string& robot, Wakeup& wakeup,
                                                     std::unique_ptr<CellView> cell, Board& board) {
  auto monitor = DdsMonitor::open(participant, robot, wakeup, false);
  if (!monitor) return tl::unexpected(monitor.error());
  return std::unique_ptr<RobotWatch>(
      new RobotWatch(robot, *std::move(monitor), std::move(cell), board));
}

RobotWatch::RobotWatch(std::string robot, std::unique_ptr<DdsMonitor> monitor,
                       std::unique_ptr<CellView> cell, Board& board)
    : robot_(std::move(robot)),
      monitor_(std::move(monitor)),
      listener_(*monitor_, robot_),
      cell_(std::move(cell)),
      board_(board) {
  board_.restart(robot_, "touches");
  board_.restart(robot_, "news");
  if (!cell_) return;
  archive_ = std::make_unique<Archive>(cell_->config().state, cell_->config().robot);
  board_.put(robot_, "cell", cell_->cell());
}

bool RobotWatch::take(const std::vector<HealthReport>& health) {
  const auto noted = [&](const auto& message) { note(message); };
  listener_.hear(health, noted);
  const bool news = listener_.take(noted) || !health.empty();
  const double silent = watched().silent >= kSilence ? std::floor(watched().silent) : 0;
  board_.put(robot_, "silence", {{"silent", silent}});
  tell(unix_now_ms(), news_.of_silence(watched()));
  const bool fell_silent = std::exchange(silent_, silent > 0) != silent_;
  const Nanoseconds now = monotonic_now();
  if (cell_) look_at_robot(now);
  if (archive_ && now >= archive_due_) read_archive(now);
  return news || fell_silent;
}

void RobotWatch::note(const StatusMessage& status) {
  board_.put(robot_, "status", to_json(status));
  tell(status.unix_ms, news_.of(status));
  const std::string settled = status.state + std::to_string(status.session) + status.active +
                              (status.candidate ? " waits" : "");
  if (settled == settled_) return;
  settled_ = settled;
  archive_due_ = std::min(archive_due_, monotonic_now() + kStoreLate);
}

void RobotWatch::note(const ProgressMessage& progress) {
  if (progress.session != session_) board_.restart(robot_, "touches");
  session_ = progress.session;
  WatchJson json = to_json(progress);
  board_.put(robot_, "progress", json);
  if (progress.set.empty()) return tell(progress.unix_ms, news_.of(progress));
  WatchJson touch = {{"set", json["set"]},           {"index", json["index"]},
                     {"residual", json["residual"]}, {"accepted", json["accepted"]},
                     {"note", json["note"]},         {"at", nullptr}};
  if (archive_)
    if (const auto q = archive_->planned(progress.session, progress.index)) {
      const WatchJson pose = cell_->pose(*q);
      if (pose.is_object()) touch["at"] = pose["tool"];
      if (joints_heard_ == 0 && pose.is_object())
        board_.put(robot_, "pose", {{"from", "plan"}, {"lines", pose["lines"]}});
    }
  board_.append(robot_, "touches", touch, kTouches);
}

void RobotWatch::note(const ResultMessage& result) {
  WatchJson json = to_json(result);
  json["sets"] = sets_of_result(json["result"]);
  const bool warns = json["result"].is_object() && json["result"].contains("warnings") &&
                     json["result"]["warnings"].is_array();
  json["warnings"] = warns ? json["result"]["warnings"] : WatchJson::array();
  json["changes"] = changes_of_result(result.json);
  json.erase("result");
  board_.put(robot_, "result", json);
  tell(result.unix_ms, news_.of(result));
  archive_due_ = std::min(archive_due_, monotonic_now() + kStoreLate);
}

void RobotWatch::note(const HealthReport& report) {
  board_.put(robot_, "health", to_json(robot_, report.unix_ms, report.lines));
  for (const HealthMessage& line : report.lines) tell(report.unix_ms, news_.of(line));
}

void RobotWatch::tell(std::int64_t unix_ms, const std::string& line) {
  if (line.empty()) return;
  board_.append(robot_, "news", {{"unix_ms", unix_ms}, {"text", line}}, kNews);
}

void RobotWatch::look_at_robot(Nanoseconds now) {
  if (now - looked_ < kPoseEvery) return;
  looked_ = now;
  if (const auto q = cell_->heard()) {
    joints_heard_ = now;
    const WatchJson pose = cell_->pose(*q);
    if (pose.is_object())
      board_.put(robot_, "pose", {{"from", "joints"}, {"lines", pose["lines"]}});
  } else if (joints_heard_ != 0 && now - joints_heard_ > kJointsLast) {
    auto last = board_.part(robot_, "pose");
    if (last && (*last)["from"] == "joints") {
      (*last)["from"] = "before";
      board_.put(robot_, "pose", *last);
    }
  }
}

void RobotWatch::read_archive(Nanoseconds now) {
  archive_due_ = now + kStoreEvery;
  board_.put(robot_, "history", archive_->history());
  board_.put(robot_, "slots", archive_->slots());
}

}  // namespace selfcal
