// A line of the kernel's gpio-sim, driven from outside.

#include "io/gpio/sim_line.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace selfcal {

Result<std::unique_ptr<GpioSimLine>> GpioSimLine::open(const std::string& pull, bool active_low) {
  const int file = ::open(pull.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) return device_failed(pull + ": " + std::strerror(errno));
  return std::unique_ptr<GpioSimLine>(new GpioSimLine(pull, file, active_low));
}

GpioSimLine::~GpioSimLine() { ::close(file_); }

Result<void> GpioSimLine::send(Nanoseconds, bool closed) {
  const std::string_view text = closed != active_low_ ? "pull-up" : "pull-down";
  if (::pwrite(file_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size())) return {};
  return device_failed(pull_ + ": " + std::strerror(errno));
}

}  // namespace selfcal
