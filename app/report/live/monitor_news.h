// What was heard of a service, line by line: only what has changed is told.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "app/report/live/monitor_view.h"

namespace selfcal {

class News {
 public:
  /// The line that a message is worth, without its time; empty when it brings nothing new.
  std::string of(const StatusMessage& status);
  std::string of(const ProgressMessage& progress) const;
  std::string of(const ResultMessage& result) const;
  std::string of(const HealthMessage& line);
  /// Whether the service has fallen silent, or is heard again, since it was last asked.
  std::string of_silence(const Watched& watched);

 private:
  std::string status_;
  std::map<std::string, Health> levels_;
  bool silent_ = false;
};

}  // namespace selfcal
