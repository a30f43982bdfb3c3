// selfcal bridge CONFIG.yaml: a trajectory controller of ROS 2 as the robot of a service.
#include <cstdio>
#include <memory>

#include "app/bridge/line_relay.h"
#include "app/bridge/motion_bridge.h"
#include "app/bridge/touch_relay.h"
#include "app/commands/subcommand.h"
#include "app/commands/support/signals.h"
#include "app/service/config/config.h"
#include "io/dds/context.h"
#include "io/files/yaml.h"
#include "io/triggers.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kTurn = 5 * kMillisecond;

struct BridgeArguments {
  std::string config, action, touch, line;
  double acceleration = 1, patience = 2;
};

/// The settings of a GPIO line, as the trigger of kind gpio has them.
Result<TriggerKindPtr> line_kind(const std::string& text, const std::string& robot) {
  const auto node = parse_yaml(text, "--touch-gpio");
  if (!node) return tl::unexpected(node.error());
  Problems problems;
  TriggerKindPtr kind = make_trigger("gpio", {*node, robot, problems});
  if (problems.any()) return bad_input(problems);
  return kind;
}

Result<void> run_bridge(const BridgeArguments& arguments, const Config& config) {
  Wakeup wakeup;
  const auto participant = DdsParticipant::open(static_cast<std::uint32_t>(config.domain),
                                                "selfcal bridge " + config.id);
  if (!participant) return tl::unexpected(participant.error());
  auto service = DdsRobotSide::open(*participant, {.robot = config.id}, wakeup);
  if (!service) return tl::unexpected(service.error());
  auto action = TrajectoryAction::open(*participant, arguments.action, config.joint_names, wakeup);
  if (!action) return tl::unexpected(action.error());
  const DdsContext dds{*participant};
  auto encoders = config.encoders->open({dds, wakeup});
  if (!encoders) return tl::unexpected(encoders.error());
  std::unique_ptr<TouchRelay> touch;
  std::unique_ptr<LineRelay> line;
  std::string from = "not its own";
  if (!arguments.touch.empty() || !arguments.line.empty()) {
    auto trigger = config.trigger->open_sender({dds, wakeup, {}});
    if (!trigger) return tl::unexpected(trigger.error());
    if (!arguments.line.empty()) {
      const auto kind = line_kind(arguments.line, config.id);
      if (!kind) return tl::unexpected(kind.error());
      auto edges = (*kind)->open({dds, wakeup});
      if (!edges) return tl::unexpected(edges.error());
      line = std::make_unique<LineRelay>(*std::move(edges), *std::move(trigger));
      from = "from " + (*kind)->source();
    } else {
      auto relay = TouchRelay::open(*participant, arguments.touch, *std::move(trigger), wakeup);
      if (!relay) return tl::unexpected(relay.error());
      touch = *std::move(relay);
      from = "from topic " + arguments.touch;
    }
  }
  std::fprintf(stderr,
               "bridge of robot %s on DDS domain %d: action %s, encoders on %s, trigger %s\n",
               config.id.c_str(), config.domain, arguments.action.c_str(),
               config.encoders->source().c_str(), from.c_str());
  MotionBridge bridge({.acceleration = arguments.acceleration,
                       .patience = nanoseconds(arguments.patience),
                       .action = arguments.action},
                      config.robot->joints(), **service, **action);
  const auto pass_on = [&]() -> Result<void> {
    while (!told_to_stop()) {
      if (auto looked = bridge.look(**encoders, monotonic_now()); !looked) return looked;
      if (touch)
        if (auto passed = touch->turn(monotonic_now()); !passed) return passed;
      if (line)
        if (auto passed = line->turn(monotonic_now()); !passed) return passed;
      if (auto turned = bridge.turn(monotonic_now()); !turned) return turned;
      wakeup.wait(kTurn);
    }
    return {};
  };
  const Result<void> ran = pass_on();
  // Whatever ended it: a move that nobody watches does not go on.
  bool tells = bridge.give_up(monotonic_now()).has_value();
  while (tells && bridge.moving()) {
    wakeup.wait(kTurn);
    tells = bridge.turn(monotonic_now()).has_value();
  }
  return ran;
}

int bridge_command(const BridgeArguments& arguments) {
  const auto config = load_config(arguments.config);
  if (!config) return tell(config.error());
  if (!arguments.touch.empty() && !arguments.line.empty())
    return wrong_usage("--touch and --touch-gpio are two triggers, and one is meant");
  const bool own = !arguments.touch.empty() || !arguments.line.empty();
  if (own && config->trigger->stamped_by() == StampedBy::kernel)
    return wrong_usage(
        "--touch and --touch-gpio need a trigger of kind dds, and the configuration's is " +
        config->trigger->source());
  listen_to_signals();
  const auto ran = run_bridge(arguments, *config);
  return ran ? kDone : tell(ran.error());
}

}  // namespace

void add_bridge(CLI::App& app, int& status) {
  auto arguments = std::make_shared<BridgeArguments>();
  CLI::App* command =
      app.add_subcommand("bridge", "A trajectory controller of ROS 2 as the robot of a service");
  command->add_option("CONFIG", arguments->config, "The service's CONFIG.yaml")->required();
  command
      ->add_option("--action", arguments->action,
                   "Name of the controller's action control_msgs/action/FollowJointTrajectory")
      ->required();
  command->add_option("--touch", arguments->touch,
                      "Topic of std_msgs/Bool (true: in contact) that becomes the trigger");
  command->add_option("--touch-gpio", arguments->line,
                      "GPIO line of this computer that becomes the trigger, as "
                      "'{chip: gpiochip0, line: 3}'");
  command
      ->add_option("--acceleration", arguments->acceleration,
                   "Largest acceleration of a joint (rad/s^2 or m/s^2)")
      ->check(CLI::Range(1e-3, 1e4))
      ->capture_default_str();
  command
      ->add_option("--patience", arguments->patience,
                   "How long the controller may be away or silent (s)")
      ->check(CLI::Range(0.05, 60.0))
      ->capture_default_str();
  command->callback([arguments, &status] { status = bridge_command(*arguments); });
}

}  // namespace selfcal
