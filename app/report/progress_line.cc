// Progress on standard error. Work of less than a second stays silent.
#include "app/report/progress_line.h"

#include <unistd.h>

#include <cstdio>

namespace selfcal {

ProgressLine::ProgressLine()
    : terminal_(isatty(STDERR_FILENO) != 0), start_(std::chrono::steady_clock::now()) {}

ProgressLine::~ProgressLine() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void ProgressLine::show(std::string_view stage, double share) {
  if (std::chrono::steady_clock::now() - start_ < std::chrono::seconds(1)) return;
  if (terminal_) {
    constexpr int kWidth = 30;
    std::string bar(kWidth, '.');
    for (int i = 0; i < static_cast<int>(share * kWidth) && i < kWidth; ++i) bar[i] = '#';
    std::fprintf(stderr, "\r\033[K[%s] %.*s", bar.c_str(), static_cast<int>(stage.size()),
                 stage.data());
    drawn_ = true;
  } else if (stage != stage_) {
    std::fprintf(stderr, "%.*s\n", static_cast<int>(stage.size()), stage.data());
  }
  stage_ = stage;
}

}  // namespace selfcal
