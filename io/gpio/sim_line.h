// A line of the kernel's gpio-sim, driven from outside through its `pull` file: the far end of the
// wire of a touch trigger.
#pragma once

#include <memory>
#include <string>

#include "io/transport.h"

namespace selfcal {

class GpioSimLine : public TriggerSender {
 public:
  /// `pull` is /sys/devices/platform/DEVICE/CHIP/sim_gpioN/pull.
  static Result<std::unique_ptr<GpioSimLine>> open(const std::string& pull, bool active_low);
  ~GpioSimLine() override;
  GpioSimLine(const GpioSimLine&) = delete;
  GpioSimLine& operator=(const GpioSimLine&) = delete;

  /// Drives the line at once, whatever the stamp. A level that the line already has is no edge.
  Result<void> send(Nanoseconds stamp, bool closed) override;

 private:
  GpioSimLine(std::string pull, int file, bool active_low)
      : pull_(std::move(pull)), file_(file), active_low_(active_low) {}
  std::string pull_;
  int file_;
  bool active_low_;
};

}  // namespace selfcal
