// One GPIO line through libgpiod 2: edges are numbered, so that a lost one shows.

#include <gpiod.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <system_error>

#include "io/gpio/edge_watch.h"
#include "io/gpio/line.h"

namespace selfcal {
namespace {

constexpr std::size_t kKernelQueue = 256;  // edges; 16 when not asked for

/// Frees what libgpiod has made.
struct Free {
  void operator()(gpiod_chip* p) const { gpiod_chip_close(p); }
  void operator()(gpiod_chip_info* p) const { gpiod_chip_info_free(p); }
  void operator()(gpiod_line_settings* p) const { gpiod_line_settings_free(p); }
  void operator()(gpiod_line_config* p) const { gpiod_line_config_free(p); }
  void operator()(gpiod_request_config* p) const { gpiod_request_config_free(p); }
  void operator()(gpiod_line_request* p) const { gpiod_line_request_release(p); }
  void operator()(gpiod_edge_event_buffer* p) const { gpiod_edge_event_buffer_free(p); }
};
template <class T>
using Owned = std::unique_ptr<T, Free>;

struct Found {
  Owned<gpiod_chip> chip;
  unsigned offset = 0;
};

/// Whether `wanted` is the chip's path, name or label.
bool is_called(gpiod_chip_info* chip, const std::string& path, const std::string& wanted) {
  return wanted == path || "/dev/" + wanted == path || wanted == gpiod_chip_info_get_label(chip);
}

/// The line on this chip; nothing when it has none of that name or offset.
std::optional<unsigned> offset_on(gpiod_chip* chip, gpiod_chip_info* info,
                                  const std::string& line) {
  int offset = offset_of(line);
  if (offset < 0) offset = gpiod_chip_get_line_offset_from_name(chip, line.c_str());
  // Asked for one past the last, the kernel says but EINVAL.
  if (offset < 0 || static_cast<std::size_t>(offset) >= gpiod_chip_info_get_num_lines(info))
    return std::nullopt;
  return static_cast<unsigned>(offset);
}

/// Where the chip may be, always in the same order: a line's name may be found on two.
std::vector<std::string> paths_of(const std::string& chip) {
  if (chip.find('/') != std::string::npos) return {chip};
  std::vector<std::string> paths;
  std::error_code listing;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", listing))
    if (entry.path().filename().string().starts_with("gpiochip")) paths.push_back(entry.path());
  std::ranges::sort(paths);
  return paths;
}

/// The first chip that is the one asked for and has the line; nothing, with errno, otherwise.
std::optional<Found> find_line(const GpioSettings& settings) {
  int error = ENOENT;
  for (const std::string& path : paths_of(settings.chip)) {
    Owned<gpiod_chip> chip(gpiod_chip_open(path.c_str()));
    const Owned<gpiod_chip_info> info(chip ? gpiod_chip_get_info(chip.get()) : nullptr);
    if (!info) {
      error = errno;
      continue;
    }
    if (!settings.chip.empty() && !is_called(info.get(), path, settings.chip)) continue;
    if (const auto offset = offset_on(chip.get(), info.get(), settings.line))
      return Found{std::move(chip), *offset};
  }
  errno = error;
  return std::nullopt;
}

gpiod_line_bias bias_of(GpioBias bias) {
  switch (bias) {
    case GpioBias::pull_up:
      return GPIOD_LINE_BIAS_PULL_UP;
    case GpioBias::pull_down:
      return GPIOD_LINE_BIAS_PULL_DOWN;
    case GpioBias::disabled:
      return GPIOD_LINE_BIAS_DISABLED;
    case GpioBias::as_is:
      break;
  }
  return GPIOD_LINE_BIAS_AS_IS;
}

/// Null, with errno, when the kernel refuses the line.
Owned<gpiod_line_request> ask_for(const Found& found, const GpioSettings& wanted) {
  const Owned<gpiod_line_settings> settings(gpiod_line_settings_new());
  const Owned<gpiod_line_config> lines(gpiod_line_config_new());
  const Owned<gpiod_request_config> request(gpiod_request_config_new());
  if (!settings || !lines || !request) return nullptr;
  gpiod_line_settings_set_active_low(settings.get(), wanted.active_low);
  if (gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_INPUT) != 0 ||
      gpiod_line_settings_set_edge_detection(settings.get(), GPIOD_LINE_EDGE_BOTH) != 0 ||
      gpiod_line_settings_set_bias(settings.get(), bias_of(wanted.bias)) != 0 ||
      gpiod_line_settings_set_event_clock(settings.get(), GPIOD_LINE_CLOCK_MONOTONIC) != 0 ||
      gpiod_line_config_add_line_settings(lines.get(), &found.offset, 1, settings.get()) != 0)
    return nullptr;
  gpiod_request_config_set_consumer(request.get(), "selfcal");
  gpiod_request_config_set_event_buffer_size(request.get(), kKernelQueue);
  return Owned<gpiod_line_request>(
      gpiod_chip_request_lines(found.chip.get(), request.get(), lines.get()));
}

}  // namespace

struct GpioLine::Handle {
  GpioSettings settings;
  unsigned offset = 0;
  Owned<gpiod_line_request> request;
  Owned<gpiod_edge_event_buffer> buffer;
};

Result<GpioLine> GpioLine::open(const GpioSettings& settings) {
  const auto found = find_line(settings);
  if (!found) return tl::make_unexpected(line_failure(settings, errno));
  auto request = ask_for(*found, settings);
  Owned<gpiod_edge_event_buffer> buffer(gpiod_edge_event_buffer_new(EdgeWatch::kQueue));
  if (!request || !buffer) return tl::make_unexpected(line_failure(settings, errno));
  return GpioLine(
      std::make_unique<Handle>(settings, found->offset, std::move(request), std::move(buffer)));
}

GpioLine::GpioLine(std::unique_ptr<Handle> handle) : handle_(std::move(handle)) {}
GpioLine::GpioLine(GpioLine&&) noexcept = default;
GpioLine& GpioLine::operator=(GpioLine&&) noexcept = default;
GpioLine::~GpioLine() = default;

int GpioLine::descriptor() const { return gpiod_line_request_get_fd(handle_->request.get()); }

Result<void> GpioLine::read(std::vector<LineEvent>& out) {
  const int count = gpiod_line_request_read_edge_events(handle_->request.get(),
                                                        handle_->buffer.get(), EdgeWatch::kQueue);
  if (count < 0) return tl::make_unexpected(line_failure(handle_->settings, errno));
  for (int i = 0; i < count; ++i) {
    gpiod_edge_event* event =
        gpiod_edge_event_buffer_get_event(handle_->buffer.get(), static_cast<unsigned long>(i));
    out.push_back({.time = static_cast<Nanoseconds>(gpiod_edge_event_get_timestamp_ns(event)),
                   .closed = gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE,
                   .number = gpiod_edge_event_get_line_seqno(event)});
  }
  return {};
}

Result<bool> GpioLine::closed() {
  const gpiod_line_value value =
      gpiod_line_request_get_value(handle_->request.get(), handle_->offset);
  if (value == GPIOD_LINE_VALUE_ERROR)
    return tl::make_unexpected(line_failure(handle_->settings, errno));
  return value == GPIOD_LINE_VALUE_ACTIVE;
}

}  // namespace selfcal
