// The touch trigger on a GPIO line, read by a thread of its own: the kernel keeps but 16 edges.
#pragma once

#include <atomic>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "io/gpio/edge_watch.h"
#include "io/gpio/line.h"
#include "io/wakeup.h"

namespace selfcal {

class GpioTrigger : public TouchTrigger {
 public:
  /// Fails when the line cannot be had. One that goes away later is unknown and in trouble() until
  /// it is back. `wakeup` hears of edges and outlives the trigger.
  static Result<std::unique_ptr<GpioTrigger>> open(const GpioSettings& settings, Wakeup& wakeup);
  ~GpioTrigger() override;
  GpioTrigger(const GpioTrigger&) = delete;
  GpioTrigger& operator=(const GpioTrigger&) = delete;

  /// Nothing in the first 0.6 s, in which a chattering line would show, and while it is gone.
  std::optional<bool> closed() override;
  Result<void> take(std::vector<Edge>& out) override;
  /// Lost in the kernel, as far as it shows (with libgpiod 1.6 a full queue hides how many and
  /// counts as one), or pushed out before they were taken.
  std::uint64_t dropped() const override;
  std::string trouble() const override;

 private:
  GpioTrigger(GpioSettings settings, Wakeup& wakeup, int stop);
  Result<void> take_line();
  void watch();
  Result<void> read_once(bool readable);
  void keep(const std::vector<Edge>& edges);

  GpioSettings settings_;
  Wakeup& wakeup_;
  int stop_;  ///< eventfd that ends the thread
  std::optional<GpioLine> line_;
  std::vector<LineEvent> events_;
  std::vector<Edge> edges_;

  mutable std::mutex mutex_;  ///< of what follows
  std::optional<EdgeWatch> watch_;
  std::deque<Edge> waiting_;
  std::uint64_t lost_before_ = 0, overflowed_ = 0;
  std::string gone_;  ///< why there is no line

  std::thread thread_;
};

}  // namespace selfcal
