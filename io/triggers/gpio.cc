// The trigger on a GPIO line (io/gpio/trigger.h), stamped by the kernel in the interrupt.
//
//   key              default   range        meaning
//   chip             none                   gpiochip0, a path or a label; not needed when no other
//                                           chip has a line of that name
//   line             required               name, or offset on the chip
//   bias             as-is                  as-is, pull-up, pull-down or disabled
//   active           high                   level of a closed trigger: high, or low
//
// A robot that is played drives the line through gpio-sim: `machine: {trigger_pull: FILE}` in its
// scenario.

#include "io/gpio/trigger.h"

#include <array>
#include <utility>

#include "io/gpio/sim_line.h"
#include "io/triggers.h"

namespace selfcal {
namespace {

constexpr std::array<std::pair<std::string_view, GpioBias>, 4> kBiases = {
    {{"as-is", GpioBias::as_is},
     {"pull-up", GpioBias::pull_up},
     {"pull-down", GpioBias::pull_down},
     {"disabled", GpioBias::disabled}}};

class Gpio final : public TriggerKind {
 public:
  explicit Gpio(GpioSettings settings) : settings_(std::move(settings)) {}

  StampedBy stamped_by() const override { return StampedBy::kernel; }
  std::string source() const override { return describe(settings_); }
  Result<std::unique_ptr<TouchTrigger>> open(const PortContext& context) const override {
    return GpioTrigger::open(settings_, context.wakeup);
  }
  Result<std::unique_ptr<TriggerSender>> open_sender(const RobotContext& context) const override {
    if (context.trigger_pull.empty())
      return bad_input(
          "a robot that is played drives a GPIO line through gpio-sim: its scenario needs "
          "machine: {trigger_pull: /sys/devices/platform/DEVICE/CHIP/sim_gpioN/pull}");
    return GpioSimLine::open(context.trigger_pull, settings_.active_low);
  }

 private:
  GpioSettings settings_;
};

GpioBias read_bias(Fields& fields) {
  const std::string text = fields.text("bias", "as-is");
  for (const auto& [name, bias] : kBiases)
    if (text == name) return bias;
  fields.fail("bias", "as-is, pull-up, pull-down or disabled");
  return GpioBias::as_is;
}

}  // namespace

TriggerKindPtr make_gpio(const TriggerEntry& entry) {
  Fields fields(entry.node, "trigger", entry.problems);
  GpioSettings settings;
  settings.chip = fields.text("chip", "");
  settings.line = fields.text("line");
  if (settings.chip.empty() && offset_of(settings.line) >= 0)
    fields.fail("line", "a name; an offset needs `chip`");
  settings.bias = read_bias(fields);
  const std::string active = fields.text("active", "high");
  if (active != "high" && active != "low") fields.fail("active", "high or low");
  settings.active_low = active == "low";
  fields.refuse_unknown();
  return std::make_shared<Gpio>(std::move(settings));
}

}  // namespace selfcal
