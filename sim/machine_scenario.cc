#include "sim/machine_scenario.h"

#include <array>
#include <cmath>
#include <utility>

#include "sim/scenario_fields.h"

namespace selfcal {
namespace {

using What = MachineFault::What;
constexpr std::array<std::pair<std::string_view, What>, 8> kFaults = {
    {{"encoders", What::encoders},
     {"stuck", What::stuck},
     {"refuse", What::refuse},
     {"silent", What::silent},
     {"lock_refuse", What::lock_refuse},
     {"lock_late", What::lock_late},
     {"lock_open", What::lock_open},
     {"misread", What::misread}}};

MachineFault read_fault(const Node& node, Problems& problems) {
  Fields fields(node, "machine fault", problems);
  MachineFault fault;
  const std::string what = fields.text("what");
  bool known = false;
  for (const auto& [name, value] : kFaults)
    if (name == what) {
      fault.what = value;
      known = true;
    }
  if (!known)
    fields.fail("what",
                "encoders, stuck, refuse, silent, lock_refuse, lock_late, lock_open or misread");
  fault.at = fields.number("at", 0, 0, 1e9);
  fault.duration = fields.number("for", 1e9, 0, 1e9);
  if (fault.what == What::misread && known) {
    fault.joint = fields.text("joint");
    fault.by = fields.number("by");
  }
  fields.refuse_unknown();
  return fault;
}

std::vector<int> read_visits(Fields& fields) {
  std::vector<int> visits;
  const Node* list = fields.node("lock_slips");
  if (!list) return visits;
  const auto numbers = fields.numbers("lock_slips", static_cast<int>(list->items.size()));
  if (!numbers) return visits;
  for (const double each : *numbers) {
    if (each < 1 || each > 1e6 || each != std::floor(each))
      fields.fail("lock_slips", "whole numbers from 1");
    else
      visits.push_back(static_cast<int>(each));
  }
  return visits;
}

}  // namespace

MachineScenario read_machine_scenario(const Node& node, Problems& problems) {
  Fields fields(node, "machine", problems);
  MachineScenario machine;
  const auto within = [&](const char* key, double& value, double least, double most) {
    value = fields.number(key, value, least, most);
  };
  within("encoder_period", machine.encoder_period, 1e-4, 0.1);
  within("speed", machine.speed, 1e-3, 100);
  within("acceleration", machine.acceleration, 0.1, 1e4);
  within("trigger_delay", machine.trigger_delay, 0, 0.1);
  machine.bounce = fields.integer("bounce", machine.bounce, 0, 20);
  within("missed", machine.missed, 0, 0.5);
  within("lock_time", machine.lock_time, 0, 10);
  within("lock_slip", machine.lock_slip, 0, 0.1);
  machine.lock_slips = read_visits(fields);
  within("temperature", machine.temperature, -40, 80);
  within("warming", machine.warming, -20, 20);
  machine.trigger_pull = fields.text("trigger_pull", "");
  within("payload", machine.payload, 0, 1000);
  if (const Node* effects = fields.node("effects")) machine.effects = effects->items;
  if (const Node* faults = fields.node("faults"))
    for (const Node& each : faults->items) machine.faults.push_back(read_fault(each, problems));
  fields.refuse_unknown();
  return machine;
}

}  // namespace selfcal
