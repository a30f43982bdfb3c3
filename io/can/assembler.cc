#include "io/can/assembler.h"

namespace selfcal {
namespace {

std::variant<SyncedCycles, FreeRunning> way_of(const CanMap& map, const CanTiming& timing,
                                               CanFaults& faults) {
  if (map.sync) return SyncedCycles(map, timing, faults);
  return FreeRunning(map, timing, faults);
}

}  // namespace

CanAssembler::CanAssembler(const CanMap& map, const CanTiming& timing, CanFaults& faults)
    : faults_(&faults), way_(way_of(map, timing, faults)) {}

void CanAssembler::add(const CanFrame& frame, Nanoseconds t, std::vector<EncoderSample>& out) {
  if (frame.lost > 0) {
    faults_->note(CanFault::overrun, t, std::to_string(frame.lost) + " frames", frame.lost);
    interrupt();
  }
  if (frame.error) {
    const std::uint64_t lost = faults_->count(CanFault::overrun);
    faults_->note_error_frame(frame, t);
    if (faults_->count(CanFault::overrun) != lost) interrupt();
    return;
  }
  // Who hears the bus is on it, whatever the last report said.
  faults_->set(CanFault::bus_off, false, t);
  std::visit([&](auto& way) { way.add(frame, t, out); }, way_);
}

void CanAssembler::interrupt() {
  std::visit([](auto& way) { way.interrupt(); }, way_);
}

std::uint64_t CanAssembler::incomplete() const {
  return std::visit([](const auto& way) { return way.incomplete(); }, way_);
}

}  // namespace selfcal
