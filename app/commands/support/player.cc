// The simulated robot of a configuration as a process of its own: motion and temperature over DDS,
// joint readings and trigger over the transports that the configuration names.
#include <sys/prctl.h>

#include <cstdio>

#include "app/commands/support/paced_output.h"
#include "app/commands/support/signals.h"
#include "app/commands/support/simulated_robot.h"
#include "io/clock.h"
#include "io/dds/context.h"
#include "io/dds/robot_side.h"
#include "io/files/file.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kRepeat = kSecond / 10;  // of the trigger's level and the temperature

/// The robot's ends of the configured transports.
struct RobotEnds {
  std::unique_ptr<DdsRobotSide> dds;
  std::unique_ptr<JointSender> joints;
  std::unique_ptr<TriggerSender> trigger;

  static Result<RobotEnds> open(const DdsParticipant& participant, const Config& config,
                                const Machine& machine, Wakeup& wakeup) {
    const DdsContext robot{participant};
    const RobotContext context{robot, wakeup, machine.settings().trigger_pull};
    auto dds = DdsRobotSide::open(
        participant, {.robot = config.id, .temperature = config.temperature_topic}, wakeup);
    if (!dds) return tl::unexpected(dds.error());
    auto joints = config.encoders->open_sender(context);
    if (!joints) return tl::unexpected(joints.error());
    auto trigger = config.trigger->open_sender(context);
    if (!trigger) return tl::unexpected(trigger.error());
    return RobotEnds{*std::move(dds), *std::move(joints), *std::move(trigger)};
  }
};

/// Sends what has come out of the machine, each with its own stamp.
class StampedOutput {
 public:
  StampedOutput(Machine& machine, RobotEnds& ends) : machine_(machine), ends_(ends) {}

  Result<void> send() {
    samples_.clear();
    edges_.clear();
    machine_.take(samples_);
    machine_.take(edges_);
    for (const EncoderSample& sample : samples_) {
      std::vector<double> q(sample.joints);
      for (int j = 0; j < sample.joints; ++j) q[j] = machine_.scales()[j].reading(sample.counts[j]);
      if (auto sent = ends_.joints->send(sample.time, q); !sent) return sent;
    }
    for (const Edge& edge : edges_)
      if (auto sent = ends_.trigger->send(last_edge_ = edge.time, edge.closed); !sent) return sent;
    return {};
  }
  Result<void> repeat() { return ends_.trigger->send(last_edge_, machine_.closed()); }

 private:
  Machine& machine_;
  RobotEnds& ends_;
  Nanoseconds last_edge_ = 0;
  std::vector<EncoderSample> samples_;
  std::vector<Edge> edges_;
};

/// Motion and temperature, which go over DDS whatever the transports.
class Conversation {
 public:
  Conversation(Machine& machine, DdsRobotSide& robot) : machine_(machine), robot_(robot) {}

  Result<void> hear() {
    requests_.clear();
    if (auto taken = robot_.take(requests_); !taken) return taken;
    if (!robot_.connected() && machine_.moving()) machine_.stop("the service is gone");
    for (const RobotRequest& request : requests_)
      request.stop ? machine_.stop(request.why) : machine_.request(request.move);
    return {};
  }
  Result<void> reply() {
    replies_.clear();
    machine_.take(replies_);
    for (const MotionReply& reply : replies_)
      if (auto sent = robot_.reply(reply); !sent) return sent;
    return {};
  }
  /// True ten times a second: the temperature is sent, and the trigger's level is to be repeated.
  Result<bool> repeats() {
    if (machine_.now() - repeated_ < kRepeat) return false;
    repeated_ = machine_.now();
    if (auto sent = robot_.publish_temperature(machine_.now(), machine_.celsius()); !sent)
      return tl::unexpected(sent.error());
    return true;
  }

 private:
  Machine& machine_;
  DdsRobotSide& robot_;
  Nanoseconds repeated_ = 0;
  std::vector<RobotRequest> requests_;
  std::vector<MotionReply> replies_;
};

template <class Output>
Result<void> answer(Conversation& conversation, Output& output) {
  if (auto heard = conversation.hear(); !heard) return heard;
  if constexpr (requires { output.send(); })
    if (auto sent = output.send(); !sent) return sent;
  if (auto replied = conversation.reply(); !replied) return replied;
  const auto due = conversation.repeats();
  if (!due) return tl::unexpected(due.error());
  return *due ? output.repeat() : Result<void>{};
}

Result<void> play_stamped(Machine& machine, RobotEnds& ends, SystemClock& clock) {
  Conversation conversation(machine, *ends.dds);
  StampedOutput output(machine, ends);
  const Nanoseconds began = clock.now();
  while (!told_to_stop()) {
    machine.advance(clock.now() - began);
    if (auto answered = answer(conversation, output); !answered) return answered;
    clock.wait(2 * kMillisecond);
  }
  return {};
}

Result<void> play_paced(Machine& machine, RobotEnds& ends, SystemClock& clock,
                        const std::string& touches) {
  prctl(PR_SET_TIMERSLACK, 1);  // a sleep ends 50 us late otherwise
  Conversation conversation(machine, *ends.dds);
  PacedOutput output(machine, *ends.joints, *ends.trigger, clock);
  if (auto driven = output.repeat(); !driven) return driven;
  while (!told_to_stop()) {
    if (auto sent = output.turn(); !sent) return sent;
    if (!output.at_leisure()) continue;
    if (auto answered = answer(conversation, output); !answered) return answered;
  }
  if (touches.empty()) return {};
  return write_file_atomically(touches, driven_text(output.driven()));
}

}  // namespace

bool paced(const Config& config) { return config.encoders->stamped_by() == StampedBy::kernel; }

Result<void> play(Machine& machine, const Config& config, const std::string& touches) {
  Wakeup wakeup;
  SystemClock clock(wakeup);
  auto participant = DdsParticipant::open(static_cast<std::uint32_t>(config.domain), "robot");
  if (!participant) return tl::unexpected(participant.error());
  auto ends = RobotEnds::open(*participant, config, machine, wakeup);
  if (!ends) return tl::unexpected(ends.error());
  std::fprintf(stderr, "robot %s is on DDS domain %d, encoders on %s, trigger on %s\n",
               config.id.c_str(), config.domain, config.encoders->source().c_str(),
               config.trigger->source().c_str());
  return paced(config) ? play_paced(machine, *ends, clock, touches)
                       : play_stamped(machine, *ends, clock);
}

}  // namespace selfcal
