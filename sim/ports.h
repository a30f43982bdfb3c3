// The simulated robot behind the service's ports, in the service's own process.
//
// Its time passes as fast as the service can follow while the robot moves, and as fast as the wall
// clock while it stands: a night's session takes seconds, and a computation beside it takes no time
// limit by surprise.
#pragma once

#include <functional>

#include "io/ports.h"
#include "sim/machine.h"

namespace selfcal {

class SimulatedPorts {
 public:
  /// Waits for real at most so long and says how long it was (ns); woken early by news.
  using RealWait = std::function<Nanoseconds(Nanoseconds longest)>;

  /// `machine` outlives the ports. `unix_ms` is the wall clock at the machine's time 0.
  SimulatedPorts(Machine& machine, std::int64_t unix_ms, RealWait wait);
  Ports ports();

 private:
  struct Encoders final : EncoderSource {
    explicit Encoders(Machine& m) : machine(m) {}
    const std::vector<EncoderScale>& scales() const override { return machine.scales(); }
    Result<void> take(std::vector<EncoderSample>& out) override {
      machine.take(out);
      return {};
    }
    std::uint64_t dropped() const override { return 0; }
    Machine& machine;
  };
  struct Trigger final : TouchTrigger {
    explicit Trigger(Machine& m) : machine(m) {}
    std::optional<bool> closed() override { return machine.closed(); }
    Result<void> take(std::vector<Edge>& out) override {
      machine.take(out);
      return {};
    }
    std::uint64_t dropped() const override { return 0; }
    Machine& machine;
  };
  struct Mover final : Motion {
    explicit Mover(Machine& m) : machine(m) {}
    Result<void> request(const MotionRequest& request) override {
      machine.request(request);
      return {};
    }
    Result<void> stop(const std::string& why) override {
      machine.stop(why);
      return {};
    }
    Result<void> take(std::vector<MotionReply>& out) override {
      machine.take(out);
      return {};
    }
    Machine& machine;
  };
  struct Warmth final : Thermometer {
    explicit Warmth(Machine& m) : machine(m) {}
    std::optional<double> celsius() override { return machine.celsius(); }
    Machine& machine;
  };
  struct Time final : Clock {
    Time(Machine& m, std::int64_t start, RealWait w)
        : machine(m), unix_ms_at_start(start), real_wait(std::move(w)) {}
    Nanoseconds now() override { return machine.now(); }
    std::int64_t unix_ms() override { return unix_ms_at_start + machine.now() / kMillisecond; }
    void wait(Nanoseconds longest) override {
      machine.advance(machine.now() + (machine.busy() ? longest : real_wait(longest)));
    }
    Machine& machine;
    std::int64_t unix_ms_at_start;
    RealWait real_wait;
  };

  Encoders encoders_;
  Trigger trigger_;
  Mover mover_;
  Warmth warmth_;
  Time time_;
};

}  // namespace selfcal
