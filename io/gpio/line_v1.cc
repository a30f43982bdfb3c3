// One GPIO line through libgpiod 1.6: edges are not numbered.

#include <gpiod.h>

#include <array>
#include <cerrno>

#include "io/gpio/edge_watch.h"
#include "io/gpio/line.h"

namespace selfcal {
namespace {

int flags_of(const GpioSettings& settings) {
  int flags = settings.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  if (settings.bias == GpioBias::pull_up) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
  if (settings.bias == GpioBias::pull_down) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
  if (settings.bias == GpioBias::disabled) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
  return flags;
}

}  // namespace

struct GpioLine::Handle {
  explicit Handle(GpioSettings s) : settings(std::move(s)) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (chip) gpiod_chip_close(chip);  // releases the line
  }
  bool find();

  GpioSettings settings;
  gpiod_chip* chip = nullptr;
  gpiod_line* line = nullptr;  // the chip's
};

/// False, with errno, when there is no such line.
bool GpioLine::Handle::find() {
  if (settings.chip.empty()) {
    line = gpiod_line_find(settings.line.c_str());
    if (line) chip = gpiod_line_get_chip(line);
    return line != nullptr;
  }
  chip = gpiod_chip_open_lookup(settings.chip.c_str());
  if (!chip) return false;
  const int offset = offset_of(settings.line);
  line = offset >= 0 ? gpiod_chip_get_line(chip, static_cast<unsigned>(offset))
                     : gpiod_chip_find_line(chip, settings.line.c_str());
  if (!line && errno == EINVAL) errno = ENOENT;  // past the last offset
  return line != nullptr;
}

Result<GpioLine> GpioLine::open(const GpioSettings& settings) {
  auto handle = std::make_unique<Handle>(settings);
  if (!handle->find() ||
      gpiod_line_request_both_edges_events_flags(handle->line, "selfcal", flags_of(settings)) != 0)
    return tl::make_unexpected(line_failure(settings, errno));
  return GpioLine(std::move(handle));
}

GpioLine::GpioLine(std::unique_ptr<Handle> handle) : handle_(std::move(handle)) {}
GpioLine::GpioLine(GpioLine&&) noexcept = default;
GpioLine& GpioLine::operator=(GpioLine&&) noexcept = default;
GpioLine::~GpioLine() = default;

int GpioLine::descriptor() const { return gpiod_line_event_get_fd(handle_->line); }

Result<void> GpioLine::read(std::vector<LineEvent>& out) {
  std::array<gpiod_line_event, EdgeWatch::kQueue> events;
  const int count = gpiod_line_event_read_multiple(handle_->line, events.data(), EdgeWatch::kQueue);
  if (count < 0) return tl::make_unexpected(line_failure(handle_->settings, errno));
  for (int i = 0; i < count; ++i)
    out.push_back({.time = events[i].ts.tv_sec * kSecond + events[i].ts.tv_nsec,
                   .closed = events[i].event_type == GPIOD_LINE_EVENT_RISING_EDGE});
  return {};
}

Result<bool> GpioLine::closed() {
  const int value = gpiod_line_get_value(handle_->line);
  if (value < 0) return tl::make_unexpected(line_failure(handle_->settings, errno));
  return value == 1;
}

}  // namespace selfcal
