// Commands in a control loop, and that they touch no heap.
#include "kinematics/inverse/compensation_stream.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "constraints/sampling/random_poses.h"
#include "io/files/robot_file.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"

namespace {

thread_local long allocations = 0;
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
constexpr bool kCounted = true;
#else
constexpr bool kCounted = false;
#endif

}  // namespace

// Under the sanitizers, which have an allocator of their own, nothing is counted.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
extern "C" void* __libc_malloc(std::size_t size);  // NOLINT: glibc's own name
extern "C" void* malloc(std::size_t size) noexcept {
  ++allocations;
  return __libc_malloc(size);
}
#endif

namespace selfcal {
namespace {

/// The robot of `text`, off by 1 mm and 1 mrad in every parameter, with `effects`.
std::shared_ptr<const Robot> calibrated_robot(const Robot& nominal,
                                              const std::string& effects = "") {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Eigen::VectorXd xi = values(nominal);
  for (std::size_t i = 0; i < nominal.parameters().size(); ++i)
    if (nominal.parameters()[i].free) xi[static_cast<Eigen::Index>(i)] += 1e-3 * normal(random);
  std::string file = robot_text(nominal, xi);
  if (!effects.empty()) file += "effects: " + effects + "\n";
  return robot_of(file);
}

std::shared_ptr<const Robot> arm_of_the_examples() {
  return std::move(*load_robot(SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml"));
}

/// Readings on a path of 2 s at 1 kHz through the middle of an arm's range.
Eigen::VectorXd on_the_path(double s) {
  Eigen::VectorXd q(6);
  q << 0.5 * std::sin(3 * s), -0.6 + 0.2 * std::cos(2 * s), 0.9 + 0.3 * std::sin(s),
      0.4 * std::sin(2 * s), 1.2 + 0.2 * std::cos(3 * s), s;
  return q;
}

struct Followed {
  int reached = 0;
  double error = 0;  ///< m, at most, by the calibrated robot's own kinematics
  long allocations = 0;
};

Followed follow(const Robot& nominal, const std::shared_ptr<const Robot>& calibrated, int refresh) {
  auto stream = CompensationStream::of(calibrated, on_the_path(0));
  EXPECT_TRUE(stream.has_value());
  Followed followed;
  for (int i = 0; stream && i < 2000; ++i) {
    const Location wanted = locate(nominal, values(nominal), on_the_path(1e-3 * i));
    if (refresh > 0 && i % refresh == 0) {
      const long before = allocations;
      stream->refresh();
      EXPECT_EQ(allocations > before, kCounted) << "what uses the heap is counted";
    }
    const long before = allocations;
    const StreamedCommand command = stream->command(wanted);
    followed.allocations += allocations - before;
    followed.reached += command.status == Streamed::reached;
    const Location is = locate(*calibrated, values(*calibrated), stream->q());
    followed.error = std::max(followed.error, (is.p - wanted.p).norm());
  }
  return followed;
}

TEST(CompensationStream, FollowsAPathWithoutTheHeap) {
  const auto nominal = arm_of_the_examples();
  const Followed followed = follow(*nominal, calibrated_robot(*nominal), 0);
  EXPECT_EQ(followed.reached, 2000);
  EXPECT_LT(followed.error, 1e-7);
  EXPECT_EQ(followed.allocations, 0);
}

TEST(CompensationStream, KeepsWhatEffectsDoFromItsLastRefresh) {
  const auto nominal = arm_of_the_examples();
  const auto calibrated = calibrated_robot(
      *nominal, "[{effect: transmission_error, at: j2, sin1: 1.0e-3, cos1: 5.0e-4}]");
  const Followed followed = follow(*nominal, calibrated, 10),
                 never = follow(*nominal, calibrated, 0);
  EXPECT_EQ(followed.allocations, 0);
  // Ten cycles turn what a milliradian moves, a millimetre, by 15 mrad at most, and change it by as
  // much as joint 2 turns: 15 and 4 um.
  EXPECT_LT(followed.error, 2e-5);
  EXPECT_GT(never.error, 2 * followed.error);
}

TEST(CompensationStream, SaysThatItIsBehindAndStaysWhereItWas) {
  const auto nominal = arm_of_the_examples();
  auto stream = CompensationStream::of(nominal, on_the_path(0));
  ASSERT_TRUE(stream.has_value());
  Location far = locate(*nominal, values(*nominal), on_the_path(0));
  far.p += Eigen::Vector3d(5, 0, 0);
  const StreamedCommand command = stream->command(far);
  EXPECT_EQ(command.status, Streamed::behind);
  EXPECT_GT(command.error, 1);
  EXPECT_EQ(stream->q(), on_the_path(0));
}

TEST(CompensationStream, ReadsParallelRobotsOffTheirChains) {
  for (const char* kind : {"linear-delta", "gough-stewart", "hexaslide"}) {
    const std::shared_ptr<const Robot> nominal = robot_of(kind_examples().at(kind));
    const std::shared_ptr<const Robot> calibrated = calibrated_robot(*nominal);
    const Eigen::VectorXd q = random_poses(*nominal, nullptr, 1, 2).row(0).transpose();
    const Location wanted = locate(*nominal, values(*nominal), q);
    auto stream = CompensationStream::of(calibrated, q);
    ASSERT_TRUE(stream.has_value()) << kind;
    const long before = allocations;
    stream->command(wanted);
    EXPECT_EQ(allocations, before) << kind;
    EXPECT_LT((locate(*calibrated, values(*calibrated), stream->q()).p - wanted.p).norm(), 1e-9);
  }
}

TEST(CompensationStream, KeepsAPlatformToItsAssemblyModeAndItsPassiveLimits) {
  const auto hexapod = [](const std::string& swing) {
    std::string text = "robot: hexapod\nkind: gough-stewart\nlegs:\n";
    for (const char* joints : {"base: [0.59, -0.1, 0], platform: [0.23, -0.26, 0]",
                               "base: [0.59, 0.1, 0], platform: [0.23, 0.26, 0]",
                               "base: [-0.2, 0.56, 0], platform: [0.11, 0.33, 0]",
                               "base: [-0.39, 0.46, 0], platform: [-0.34, 0.07, 0]",
                               "base: [-0.39, -0.46, 0], platform: [-0.34, -0.07, 0]",
                               "base: [-0.2, -0.56, 0], platform: [0.11, -0.33, 0]"})
      text += std::string("  - {") + joints + ", limits: [0.4, 1.3]" + swing + "}\n";
    return robot_of(text);
  };
  const std::shared_ptr<const Robot> free = hexapod(""), held = hexapod(", swing: [0.2, 0.2]");
  const Eigen::VectorXd middle = Eigen::VectorXd::Constant(6, 0.85);
  const Location home = locate(*free, values(*free), middle);
  auto stream = CompensationStream::of(free, middle);
  ASSERT_TRUE(stream.has_value());
  // All joints lie in one plane: below the base the legs are as long, but nothing leads there.
  Location mirrored = home;
  mirrored.p.z() *= -1;
  EXPECT_EQ(stream->command(mirrored).status, Streamed::behind);
  EXPECT_EQ(stream->q(), middle);
  Location aside = home;
  aside.p.x() += 0.25;
  EXPECT_EQ(stream->command(aside).status, Streamed::reached);
  // A quarter of a metre aside turns a leg of 0.85 m by more than 0.2 rad.
  stream = CompensationStream::of(held, middle);
  const long before = allocations;
  EXPECT_EQ(stream->command(aside).status, Streamed::limit);
  EXPECT_EQ(allocations, before);
  EXPECT_FALSE(within_limits(*held, stream->q()));
}

TEST(CompensationStream, StaysWhereItWasWhenItIsGivenNoPose) {
  for (const char* kind : {"linear-delta", "gough-stewart", "hexaslide"}) {
    const std::shared_ptr<const Robot> robot = robot_of(kind_examples().at(kind));
    const Eigen::VectorXd q = random_poses(*robot, nullptr, 1, 2).row(0).transpose();
    auto stream = CompensationStream::of(robot, q);
    ASSERT_TRUE(stream.has_value()) << kind;
    Location nothing = locate(*robot, values(*robot), q);
    nothing.p.x() = std::nan("");
    EXPECT_EQ(stream->command(nothing).status, Streamed::behind) << kind;
    EXPECT_EQ(stream->q(), q) << kind;
  }
}

TEST(CompensationStream, IsNotThereForJointsThatMoveEachOther) {
  const std::shared_ptr<const Robot> coupled = robot_of(kind_examples().at("serial"));
  EXPECT_FALSE(CompensationStream::of(coupled, Eigen::Vector3d::Zero()).has_value());
}

}  // namespace
}  // namespace selfcal
