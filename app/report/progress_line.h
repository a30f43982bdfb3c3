// Progress on standard error: a bar redrawn in place on a terminal, a line per stage elsewhere.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace selfcal {

class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();  ///< clears the bar
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(std::string_view stage, double share);

 private:
  bool terminal_, drawn_ = false;
  std::string stage_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace selfcal
