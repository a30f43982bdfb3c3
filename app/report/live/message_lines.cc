#include "app/report/live/message_lines.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "app/report/format.h"
#include "app/report/live/message_json.h"

namespace selfcal {

MessageLines::MessageLines(bool json, const std::string& robot)
    : json_(json), begin_(robot.empty() ? "" : one_line(robot) + ": ") {}

void MessageLines::add(const StatusMessage& message) {
  put(message.unix_ms, json_ ? line_of(to_json(message)) : news_.of(message));
}

void MessageLines::add(const ProgressMessage& message) {
  put(message.unix_ms, json_ ? line_of(to_json(message)) : news_.of(message));
}

void MessageLines::add(const ResultMessage& message) {
  put(message.unix_ms, json_ ? line_of(to_json(message)) : news_.of(message));
}

void MessageLines::add(const std::string& robot, const HealthReport& report) {
  if (json_) return put(report.unix_ms, line_of(to_json(robot, report.unix_ms, report.lines)));
  for (const HealthMessage& line : report.lines) put(report.unix_ms, news_.of(line));
}

void MessageLines::add_silence(const Watched& watched) {
  const std::string text = news_.of_silence(watched);
  if (text.empty() || !json_) return put(unix_now_ms(), text);
  put(unix_now_ms(), line_of({{"topic", "silence"},
                              {"unix_ms", unix_now_ms()},
                              {"robot", watched.robot},
                              {"silent", watched.silent >= kSilence}}));
}

bool MessageLines::flush() {
  std::ranges::stable_sort(lines_, {}, &Entry::first);
  for (const auto& [when, text] : lines_)
    std::printf("%s%s%s\n", json_ ? "" : (clock_time(when) + " ").c_str(),
                json_ ? "" : begin_.c_str(), text.c_str());
  lines_.clear();
  if (std::fflush(stdout) == 0) return true;
  if (errno == EPIPE) std::clearerr(stdout);  // a reader who has seen enough is no failure
  return false;
}

void MessageLines::put(std::int64_t when, std::string text) {
  if (!text.empty()) lines_.emplace_back(when, std::move(text));
}

void print_last(const Watched& watched) {
  MessageLines lines(true);
  if (watched.status) lines.add(*watched.status);
  if (watched.result) lines.add(*watched.result);
  if (!watched.health.empty())
    lines.add(watched.robot, HealthReport{unix_now_ms(), "", watched.health});
  lines.flush();
}

}  // namespace selfcal
