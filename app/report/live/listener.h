// What a service tells, taken as it comes, with the last of it kept.
#pragma once

#include <string>
#include <vector>

#include "app/report/live/monitor_view.h"
#include "io/clock.h"
#include "io/dds/clients/monitor.h"

namespace selfcal {

/// Takes what has come, keeps the last of it, and hands each message to `each`.
class Listener {
 public:
  Listener(DdsMonitor& monitor, const std::string& robot) : monitor_(monitor) {
    watched_.robot = robot;
  }

  /// Whether anything has come.
  template <class Each>
  bool take(Each each) {
    const bool status = take_all<StatusMessage>(each);
    const bool others =
        static_cast<int>(take_all<ProgressMessage>(each)) + take_all<ResultMessage>(each) > 0;
    std::vector<HealthReport> reports;
    monitor_.take(reports);
    hear(reports, each);
    const Nanoseconds now = monotonic_now();
    if (status) heard_ = now;
    watched_.silent = seconds(now - heard_);
    return status || others || !reports.empty();
  }
  /// Health that came another way.
  template <class Each>
  void hear(const std::vector<HealthReport>& reports, Each each) {
    for (const HealthReport& report : reports) {
      watched_.health = report.lines;
      each(report);
    }
  }
  const Watched& watched() const { return watched_; }

 private:
  template <class Message, class Each>
  bool take_all(Each& each) {
    std::vector<Message> messages;
    monitor_.take(messages);
    for (const Message& message : messages) {
      note(watched_, message);
      each(message);
    }
    return !messages.empty();
  }

  DdsMonitor& monitor_;
  Watched watched_;
  Nanoseconds heard_ = monotonic_now();
};

}  // namespace selfcal
