#include "tests/hil/spinning_arm.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmath>
#include <numbers>
#include <random>

#include "io/can/robot_side.h"
#include "io/clock.h"
#include "io/gpio/sim_line.h"

namespace selfcal {
namespace {

constexpr int kJoints = 6;
constexpr double kTurn = 2 * std::numbers::pi, kPulse = kTurn / 2;  // rad/s: w
constexpr double kSwing = 0.2;                                      // rad: A

double speed(int j) { return 1.0 + 0.2 * j; }

void sleep_until(Nanoseconds t) {
  const timespec until = {t / kSecond, t % kSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

/// When the line changes next: closes within the first third of each span, and opens within it.
class Rhythm {
 public:
  Rhythm(Nanoseconds began, const SpinningArmOptions& options)
      : span_(options.touch_every),
        closed_for_(options.closed_for),
        begins_(began),
        random_(options.seed) {
    draw();
  }
  Nanoseconds at() const { return closed_ ? closes_ + closed_for_ : closes_; }
  bool change() {
    closed_ = !closed_;
    if (!closed_) draw();
    return closed_;
  }

 private:
  void draw() {
    begins_ += span_;
    closes_ = begins_ + static_cast<Nanoseconds>(random_() % static_cast<std::uint64_t>(span_ / 3));
  }
  Nanoseconds span_, closed_for_, begins_, closes_ = 0;
  bool closed_ = false;
  std::mt19937_64 random_;
};

/// Ends this process, the robot's, when something fails.
template <class T>
T or_die(Result<T> result) {
  if (result) return *std::move(result);
  std::fprintf(stderr, "robot: %s\n", result.error().what.c_str());
  _exit(1);
}

[[noreturn]] void spin(const Wiring& wires, const SpinningArmOptions& options, const Spin& truth) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  prctl(PR_SET_TIMERSLACK, 1);
  const auto bus = or_die(CanRobotSide::open(spinning_settings(wires.robot_interface)));
  const auto line = or_die(GpioSimLine::open(wires.pull, false));
  Rhythm rhythm(truth.began, options);
  for (Nanoseconds next = truth.began;;) {
    if (rhythm.at() < next) {
      sleep_until(rhythm.at());
      if (!line->send(0, rhythm.change())) _exit(1);
      continue;
    }
    sleep_until(next);
    next += options.cycle;
    // Nothing when the wall clock has been stepped meanwhile, and with it the stamp of SYNC.
    const auto moment = or_die(bus->sync(20 * kMillisecond));
    if (!moment) continue;
    const Eigen::VectorXd q = truth.q(*moment);
    if (!bus->publish_joints({q.begin(), q.end()})) _exit(1);
  }
}

}  // namespace

Eigen::VectorXd Spin::q(Nanoseconds t) const {
  const double s = seconds(t - began);
  Eigen::VectorXd q(kJoints);
  for (int j = 0; j < kJoints; ++j) q[j] = speed(j) * s + kSwing * std::sin(kPulse * s + j);
  return q;
}

Eigen::VectorXd Spin::dq(Nanoseconds t) const {
  const double s = seconds(t - began);
  Eigen::VectorXd dq(kJoints);
  for (int j = 0; j < kJoints; ++j) dq[j] = speed(j) + kSwing * kPulse * std::cos(kPulse * s + j);
  return dq;
}

CanSettings spinning_settings(const std::string& interface) {
  CanSettings settings;
  settings.interface = interface;
  settings.map.sync = CanId{.value = 0x80, .extended = false};
  for (int j = 0; j < kJoints; ++j) {
    CanJoint joint;
    joint.name = "j" + std::to_string(j + 1);
    joint.id.value = 0x181 + static_cast<std::uint32_t>(j);
    joint.field = byte_field(0, 4, false, true);
    joint.scale.step = kTurn / (262144.0 * 50);  // 0.48 urad
    settings.map.joints.push_back(joint);
  }
  EXPECT_EQ(settings.map.finish(), std::nullopt);
  settings.timing.window = 0.9e-3;
  return settings;
}

SpinningArm::SpinningArm(const Wiring& wires, const SpinningArmOptions& options)
    : truth_{monotonic_now() + kSecond / 5} {
  pid_ = fork();
  if (pid_ == 0) spin(wires, options, truth_);
}

SpinningArm::~SpinningArm() {
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

}  // namespace selfcal
