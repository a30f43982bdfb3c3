#include "app/pretend.h"

#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "io/clock.h"
#include "io/dds/participant.h"
#include "io/dds/robot_side.h"
#include "io/robot_file.h"
#include "io/yaml.h"

namespace selfcal {
namespace {

volatile std::sig_atomic_t stop_asked = 0;
void on_signal(int) { stop_asked = 1; }

constexpr Nanoseconds kRepeat = kSecond / 10;  // of the trigger's level and the temperature

/// What has come out of the machine since the last turn goes out over DDS.
class Player {
 public:
  Player(Machine& machine, DdsRobotSide& robot) : machine_(machine), robot_(robot) {}

  Result<void> turn(Nanoseconds now) {
    std::vector<RobotRequest> requests;
    if (auto taken = robot_.take(requests); !taken) return taken;
    machine_.advance(now);
    if (!robot_.connected() && machine_.moving()) machine_.stop("the service is gone");
    for (const RobotRequest& request : requests)
      request.stop ? machine_.stop(request.why) : machine_.request(request.move);
    samples_.clear();
    edges_.clear();
    replies_.clear();
    machine_.take(samples_);
    machine_.take(edges_);
    machine_.take(replies_);
    for (const EncoderSample& sample : samples_) {
      std::vector<double> q(sample.joints);
      for (int j = 0; j < sample.joints; ++j)
        q[j] = static_cast<double>(sample.counts[j]) * machine_.scales()[j].step;
      if (auto sent = robot_.publish_joints(sample.time, q); !sent) return sent;
    }
    for (const Edge& edge : edges_)
      if (auto sent = robot_.publish_trigger(last_edge_ = edge.time, edge.closed); !sent)
        return sent;
    for (const MotionReply& reply : replies_)
      if (auto sent = robot_.reply(reply); !sent) return sent;
    if (now - repeated_ < kRepeat) return {};
    repeated_ = now;
    if (auto sent = robot_.publish_trigger(last_edge_, machine_.closed()); !sent) return sent;
    return robot_.publish_temperature(now, machine_.celsius());
  }

 private:
  Machine& machine_;
  DdsRobotSide& robot_;
  Nanoseconds last_edge_ = 0, repeated_ = 0;
  std::vector<EncoderSample> samples_;
  std::vector<Edge> edges_;
  std::vector<MotionReply> replies_;
};

}  // namespace

bool told_to_stop() { return stop_asked != 0; }

void listen_to_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::signal(SIGPIPE, SIG_IGN);
}

Result<Scenario> load_scenario(const std::string& path) {
  const Result<Node> node = read_yaml(path);
  if (!node) return tl::unexpected(node.error());
  Problems problems;
  Scenario scenario = read_scenario(*node, problems);
  if (problems.any()) return bad_input(problems);
  return scenario;
}

Result<std::unique_ptr<Machine>> load_machine(const std::string& path, const Config& config) {
  const Result<Scenario> scenario = load_scenario(path);
  if (!scenario) return tl::unexpected(scenario.error());
  auto robot = load_robot(std::filesystem::path(path).parent_path() / scenario->robot);
  if (!robot) return tl::unexpected(robot.error());
  if (model_hash(**robot) != model_hash(*config.robot))
    return bad_input(path + ": its robot is another than the configuration's");
  Problems problems;
  auto machine =
      std::make_unique<Machine>(*scenario, std::move(*robot), config.plan.home, problems);
  if (problems.any()) return bad_input(problems);
  return machine;
}

std::string machine_truth(const Machine& machine) {
  nlohmann::ordered_json json, parameters = nlohmann::ordered_json::object();
  const std::vector<Parameter>& names = machine.robot().parameters();
  for (std::size_t i = 0; i < names.size(); ++i)
    parameters[names[i].name] = machine.truth().xi[static_cast<Eigen::Index>(i)];
  json["parameters"] = std::move(parameters);
  json["false_touches"] = machine.false_touches();
  json["visits"] = machine.visits();
  return json.dump(1) + "\n";
}

Result<void> play(Machine& machine, const Config& config) {
  Wakeup wakeup;
  SystemClock clock(wakeup);
  auto participant = DdsParticipant::open(static_cast<std::uint32_t>(config.domain), "robot");
  if (!participant) return tl::unexpected(participant.error());
  auto robot = DdsRobotSide::open(*participant,
                                  {.robot = config.id,
                                   .joints = config.joint_names,
                                   .joint_states = config.joint_topic,
                                   .trigger = config.trigger_topic,
                                   .temperature = config.temperature_topic},
                                  wakeup);
  if (!robot) return tl::unexpected(robot.error());
  std::fprintf(stderr, "robot %s is on DDS domain %d\n", config.id.c_str(), config.domain);
  Player player(machine, **robot);
  const Nanoseconds began = clock.now();
  while (!told_to_stop()) {
    if (auto played = player.turn(clock.now() - began); !played) return played;
    clock.wait(2 * kMillisecond);
  }
  return {};
}

}  // namespace selfcal
