// The trigger on a line of the kernel's own gpio-sim. Runs where the environment names it:
// SELFCAL_GPIO_PULL (its `pull` file), SELFCAL_GPIO_CHIP and SELFCAL_GPIO_LINE.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "io/clock.h"
#include "io/gpio/sim_line.h"
#include "io/gpio/trigger.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

std::string environment(const char* name) {
  const char* text = std::getenv(name);
  return text ? text : "";
}

class GpioKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (pull.empty() || settings.line.empty())
      GTEST_SKIP() << "no line of gpio-sim: SELFCAL_GPIO_PULL, SELFCAL_GPIO_CHIP and "
                      "SELFCAL_GPIO_LINE do not name one";
    wire = must(GpioSimLine::open(pull, false));
    must(wire->send(0, false));
  }
  void open() {
    trigger = must(GpioTrigger::open(settings, wakeup));
    ASSERT_TRUE(eventually(wakeup, [&] { return trigger->closed().has_value(); }));
  }
  /// Drives the line and waits for the edge.
  Edge driven(bool closed) {
    std::vector<Edge> edges;
    must(wire->send(0, closed));
    EXPECT_TRUE(eventually(wakeup, [&] {
      must(trigger->take(edges));
      return !edges.empty();
    }));
    return edges.empty() ? Edge{} : edges.front();
  }
  static void pause(Nanoseconds length) {
    Wakeup nobody;
    nobody.wait(length);
  }

  std::string pull = environment("SELFCAL_GPIO_PULL");
  GpioSettings settings{.chip = environment("SELFCAL_GPIO_CHIP"),
                        .line = environment("SELFCAL_GPIO_LINE")};
  Wakeup wakeup;
  std::unique_ptr<GpioSimLine> wire;
  std::unique_ptr<GpioTrigger> trigger;
};

TEST_F(GpioKernel, StampsEveryEdgeWhileTheLineIsDriven) {
  open();
  std::vector<Nanoseconds> late;
  for (int i = 0; i < 400; ++i) {
    const Nanoseconds before = monotonic_now();
    const Edge edge = driven(i % 2 == 0);
    ASSERT_EQ(edge.closed, i % 2 == 0) << i;
    EXPECT_TRUE(edge.timed);
    EXPECT_GE(edge.time, before);
    EXPECT_LE(edge.time, monotonic_now());
    late.push_back(edge.time - before);
    EXPECT_EQ(trigger->closed(), edge.closed);
  }
  EXPECT_EQ(trigger->dropped(), 0u);
  std::ranges::sort(late);
  std::printf("driven to stamped: median %.1f us, 99 %% %.1f us\n",
              1e-3 * static_cast<double>(late[late.size() / 2]),
              1e-3 * static_cast<double>(late[late.size() * 99 / 100]));
}

TEST_F(GpioKernel, KnowsTheLevelThatTheLineAlreadyHad) {
  must(wire->send(0, true));
  open();
  EXPECT_EQ(trigger->closed(), true);
  std::vector<Edge> edges;
  must(trigger->take(edges));
  EXPECT_TRUE(edges.empty());
}

TEST_F(GpioKernel, TurnsTheLevelRoundForALineThatIsActiveLow) {
  settings.active_low = true;
  open();
  EXPECT_EQ(trigger->closed(), true);
  EXPECT_FALSE(driven(true).closed) << "high is open";
  EXPECT_EQ(trigger->closed(), false);
}

TEST_F(GpioKernel, PullsAnOpenLine) {
  settings.bias = GpioBias::pull_up;
  open();
  EXPECT_EQ(trigger->closed(), true);
}

TEST_F(GpioKernel, HasTheRightLevelAfterMoreEdgesThanAnyQueueHolds) {
  open();
  constexpr int kEdges = 2001;
  for (int i = 0; i < kEdges; ++i) must(wire->send(0, i % 2 == 0));
  EXPECT_TRUE(eventually(wakeup, [&] { return trigger->closed() == true; }));
  pause(300 * kMillisecond);  // three looks at the level
  EXPECT_EQ(trigger->closed(), true);
  std::vector<Edge> edges;
  must(trigger->take(edges));
  ASSERT_FALSE(edges.empty());
  EXPECT_LE(edges.size(), TouchTrigger::kMostEdges);
  for (std::size_t i = 1; i < edges.size(); ++i)
    EXPECT_NE(edges[i].closed, edges[i - 1].closed) << i;
  EXPECT_TRUE(edges.back().closed);
  // How many is not known where edges are not numbered; that some are is.
  EXPECT_GT(trigger->dropped(), 0u);
  std::printf("%d edges at once: %zu kept, %llu dropped\n", kEdges, edges.size(),
              static_cast<unsigned long long>(trigger->dropped()));
}

TEST_F(GpioKernel, LosesNothingOfFiftyEdgesASecond) {
  open();
  std::size_t taken = 0;
  std::vector<Edge> edges;
  for (int i = 0; i < 100; ++i) {
    must(wire->send(0, i % 2 == 0));
    pause(20 * kMillisecond);
    if (i % 10 != 9) continue;  // the service may be busy
    edges.clear();
    must(trigger->take(edges));
    for (const Edge& edge : edges) EXPECT_TRUE(edge.timed);
    taken += edges.size();
  }
  EXPECT_EQ(taken, 100u);
  EXPECT_EQ(trigger->dropped(), 0u);
  EXPECT_EQ(trigger->trouble(), "");
}

TEST_F(GpioKernel, TellsOfALineThatChatters) {
  open();
  for (int i = 0; i < 100; ++i) {
    must(wire->send(0, i % 2 == 0));
    pause(8 * kMillisecond);
  }
  EXPECT_THAT(trigger->trouble(), HasSubstr("chatters"));
}

TEST_F(GpioKernel, SaysThatALineIsInUse) {
  open();
  EXPECT_THAT(GpioTrigger::open(settings, wakeup).error().what, HasSubstr("in use"));
  trigger.reset();
  open();
}

TEST_F(GpioKernel, SaysThatTheChipHasNoSuchLine) {
  settings.line = "4711";
  EXPECT_THAT(GpioTrigger::open(settings, wakeup).error().what, HasSubstr("no such chip or line"));
  settings.line = "no-such-name";
  EXPECT_THAT(GpioTrigger::open(settings, wakeup).error().what, HasSubstr("no such chip or line"));
}

}  // namespace
}  // namespace selfcal
