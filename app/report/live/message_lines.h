// What a service tells as lines on standard output, of text or JSON.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/report/live/monitor_news.h"
#include "io/dds/clients/monitor.h"
#include "io/messages.h"

namespace selfcal {

/// One line for each message of a robot, in the order in which they were sent.
class MessageLines {
 public:
  /// `robot`: told at the beginning of each line of text; empty where there is only one.
  explicit MessageLines(bool json, const std::string& robot = {});

  void add(const StatusMessage& message);
  void add(const ProgressMessage& message);
  void add(const ResultMessage& message);
  void add(const std::string& robot, const HealthReport& report);
  void add_silence(const Watched& watched);
  /// False when nobody reads any more.
  bool flush();

 private:
  using Entry = std::pair<std::int64_t, std::string>;  // ms since 1970 (UTC)
  void put(std::int64_t when, std::string text);

  bool json_;
  std::string begin_;
  News news_;
  std::vector<Entry> lines_;
};

/// The last that was heard of a robot, as JSON.
void print_last(const Watched& watched);

}  // namespace selfcal
