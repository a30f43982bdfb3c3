// Which services are found in a domain.

#include <gmock/gmock.h>

#include "io/dds/clients/discovery.h"
#include "io/dds/messenger.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

class DdsRobotsFound : public DdsTest {
 protected:
  std::unique_ptr<DdsMessenger> service(const std::string& robot) {
    return must(DdsMessenger::open(participant, robot, wakeup));
  }
  bool eventually_heard(DdsRobots& robots, const std::vector<std::string>& expected) {
    return eventually([&] { return must(robots.heard()) == expected; });
  }
};

TEST_F(DdsRobotsFound, AreThoseWhoseServiceIsThere) {
  const auto before = service("RX-90");
  const auto robots = must(DdsRobots::open(participant, wakeup));
  EXPECT_TRUE(eventually_heard(*robots, {"rx_90"}));
  {
    const auto after = service("irb1600"), twin = service("irb1600");
    EXPECT_TRUE(eventually_heard(*robots, {"irb1600", "rx_90"}));
  }
  EXPECT_TRUE(eventually_heard(*robots, {"rx_90"}));
}

TEST(RobotOfStatus, IsReadFromAStatusTopicAlone) {
  EXPECT_EQ(robot_of_status("rt/selfcal/rx_90/status"), "rx_90");
  for (const char* other : {"rt/selfcal/rx_90/progress", "rt/selfcal//status", "rt/selfcal/status",
                            "rt/selfcal/a/b/status", "selfcal/a/status", ""})
    EXPECT_EQ(robot_of_status(other), "") << other;
}

}  // namespace
}  // namespace selfcal
