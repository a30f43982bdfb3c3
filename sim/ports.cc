#include "sim/ports.h"

namespace selfcal {

SimulatedPorts::SimulatedPorts(Machine& machine, std::int64_t unix_ms, RealWait wait)
    : encoders_(machine),
      trigger_(machine),
      mover_(machine),
      warmth_(machine),
      time_(machine, unix_ms, std::move(wait)) {}

Ports SimulatedPorts::ports() { return {&time_, &encoders_, &trigger_, &mover_, &warmth_}; }

}  // namespace selfcal
