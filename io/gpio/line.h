// One GPIO line that reports both its edges: the seam to libgpiod, whose versions 1.6 and 2 have
// different interfaces. line_v1.cc or line_v2.cc is built, by what the build finds.
#pragma once

#include <memory>
#include <vector>

#include "io/gpio/settings.h"
#include "io/ports.h"

namespace selfcal {

/// An edge as the kernel reports it: the moment is that of the interrupt (CLOCK_MONOTONIC), the
/// level was read a little later.
struct LineEvent {
  Nanoseconds time = 0;
  bool closed = false;
  std::uint64_t number = 0;  ///< grows by one with every edge of the line; 0 when not numbered
};

class GpioLine {
 public:
  /// Asks the kernel for the line as an input with both edges.
  static Result<GpioLine> open(const GpioSettings& settings);
  GpioLine(GpioLine&&) noexcept;
  GpioLine& operator=(GpioLine&&) noexcept;
  ~GpioLine();

  /// Readable while edges wait.
  int descriptor() const;
  /// Appends the edges that wait, of which there must be one; oldest first.
  Result<void> read(std::vector<LineEvent>& out);
  /// The level now.
  Result<bool> closed();

 private:
  struct Handle;
  explicit GpioLine(std::unique_ptr<Handle> handle);
  std::unique_ptr<Handle> handle_;
};

}  // namespace selfcal
