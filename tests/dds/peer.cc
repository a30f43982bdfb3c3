#include "tests/dds/peer.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>

#include "io/dds/messenger.h"
#include "io/dds/robot_side.h"
#include "io/dds/senders.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

std::atomic<bool> ending = false;

// Joint states a thousand times a second, with the trigger closed from the first request on; every
// move is done at once.
void play_robot(const DdsParticipant& participant) {
  Wakeup wakeup;
  const auto robot = must(DdsRobotSide::open(participant, {.robot = "r"}, wakeup));
  const auto joints = must(DdsJointSender::open(participant, "joint_states", {"a", "b"}, wakeup));
  const auto trigger = must(DdsTriggerSender::open(participant, "touch_trigger", wakeup));
  bool closed = false;
  Nanoseconds changed = realtime_now();
  for (Nanoseconds next = 0; !ending;) {
    const Nanoseconds now = realtime_now();
    if (now >= next) {
      next = now + kMillisecond;
      must(joints->send(now, {1, 2}));
      must(trigger->send(changed, closed));
    }
    std::vector<RobotRequest> requests;
    must(robot->take(requests));
    for (const auto& request : requests) {
      if (!closed) changed = realtime_now();
      closed = true;
      must(robot->reply(
          {.id = request.move.id,
           .outcome = request.stop ? MotionReply::Outcome::stopped : MotionReply::Outcome::done,
           .why = request.why}));
    }
    wakeup.wait(next - realtime_now());
  }
}

// A status and a long result at the start; accepts all commands.
void play_service(const DdsParticipant& participant) {
  Wakeup wakeup;
  const auto service = must(DdsMessenger::open(participant, "r", wakeup));
  service->publish(StatusMessage());
  ResultMessage result;
  result.json.assign(300'000, 'x');
  service->publish(result);
  while (!ending) {
    std::vector<CommandMessage> commands;
    service->take(commands);
    for (const auto& command : commands)
      service->reply({.id = command.id, .verb = command.verb, .accepted = true, .why = ""});
    wakeup.wait(10 * kMillisecond);
  }
}

}  // namespace

Peer::Peer(const std::string& role, std::uint32_t domain) : pid_(fork()) {
  if (pid_ != 0) return;
  const std::string number = std::to_string(domain);
  execl("/proc/self/exe", "peer", "--play", role.c_str(), number.c_str(), nullptr);
  _exit(127);
}

void Peer::kill() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  pid_ = 0;
}

int Peer::end() {
  int status = 0;
  ::kill(pid_, SIGTERM);
  waitpid(pid_, &status, 0);
  pid_ = 0;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int play(const std::string& role, std::uint32_t domain) {
  signal(SIGTERM, [](int) { ending = true; });
  const auto participant = must(DdsParticipant::open(domain, role));
  if (role == "robot") play_robot(participant);
  if (role == "service") play_service(participant);
  return ::testing::Test::HasFailure() ? 1 : 0;
}

}  // namespace selfcal

int main(int argc, char** argv) {
  if (argc == 4 && std::string(argv[1]) == "--play")
    return selfcal::play(argv[2], static_cast<std::uint32_t>(std::stoul(argv[3])));
  ::testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
