// The service and those who watch it, in one process.

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "app/report/live/message_json.h"
#include "io/dds/clients/monitor.h"
#include "io/dds/messenger.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Messages of which only these matter.
template <class Message>
Message of(const std::string& robot, std::int64_t session) {
  Message message;
  message.robot = robot;
  message.session = session;
  return message;
}

TEST_F(DdsTest, KnowsAServiceOfTheRobotThatIsThereAlready) {
  EXPECT_FALSE(must(has_service(participant, "r", 50 * kMillisecond, wakeup)));
  const auto told = must(DdsMessenger::open(participant, "r", wakeup));
  EXPECT_TRUE(must(has_service(participant, "r", kLimit, wakeup)));
  EXPECT_FALSE(must(has_service(participant, "s", 50 * kMillisecond, wakeup)));
  EXPECT_EQ(told->rivals(), 0);
  const auto second = must(DdsMessenger::open(participant, "r", wakeup));
  EXPECT_TRUE(eventually([&] { return told->rivals() == 1 && second->rivals() == 1; }));
}

class DdsService : public DdsTest {
 protected:
  std::unique_ptr<DdsMessenger> service(const std::string& robot) {
    return must(DdsMessenger::open(participant, robot, wakeup));
  }
  std::unique_ptr<DdsMonitor> monitor(const std::string& robot) {
    return must(DdsMonitor::open(participant, robot, wakeup));
  }
  // Takes until there are `count` messages in all.
  template <class Message>
  std::vector<Message> take(DdsMonitor& from, std::size_t count) {
    std::vector<Message> taken;
    EXPECT_TRUE(eventually([&] {
      from.take(taken);
      return taken.size() >= count;
    }));
    return taken;
  }
};

TEST_F(DdsService, TellsItsStatus) {
  const StatusMessage sent{.unix_ms = 1'790'000'000'123,
                           .robot = "RX-90",
                           .model_hash = "abc",
                           .version = "1.2",
                           .state = "collecting",
                           .phase = "touch",
                           .hardware = "moves slowly",
                           .why = "a person asked; \"täglich\"",
                           .session = 12,
                           .kind = "full",
                           .active = "session 11",
                           .active_since_ms = 1'780'000'000'999,
                           .candidate = true,
                           .next_due_ms = 0,
                           .temperature = 21.5};
  const auto told = service("RX-90");
  const auto watch = monitor("RX-90");

  told->publish(sent);
  const auto got = take<StatusMessage>(*watch, 1);

  ASSERT_EQ(got.size(), 1);
  EXPECT_TRUE(got[0] == sent) << line_of(to_json(got[0]));
  EXPECT_EQ(told->unsent(), 0);
}

TEST_F(DdsService, TellsItsProgress) {
  ProgressMessage sent{.unix_ms = 5,
                       .robot = "r",
                       .session = 3,
                       .kind = "check",
                       .done = 4,
                       .planned = 240,
                       .outlier = 1,
                       .seconds_left = kNan,
                       .set = "table",
                       .index = 17,
                       .residual = -3e-5,
                       .accepted = true,
                       .note = "n"};
  const auto told = service("r");
  const auto watch = monitor("r");

  told->publish(sent);
  auto got = take<ProgressMessage>(*watch, 1);

  ASSERT_EQ(got.size(), 1);
  EXPECT_TRUE(std::isnan(got[0].seconds_left));
  got[0].seconds_left = sent.seconds_left = 0;  // NaN equals nothing
  EXPECT_TRUE(got[0] == sent) << line_of(to_json(got[0]));
}

TEST_F(DdsService, TellsItsResultHoweverLong) {
  const ResultFigures figures{.p_value = 1e-9,
                              .check_before = 1e-3,
                              .check_after = 2e-5,
                              .endpoint_sigma = 1e-5,
                              .touches = 240,
                              .outliers = 3,
                              .identified = 25};
  const ResultMessage sent{figures,       6,          "r",       "h", 4,
                           "full",        "improved", "applied", "w", std::string(300'000, 'x'),
                           "backlash@j2", 0.96,       0.8};
  const auto told = service("r");
  const auto watch = monitor("r");

  told->publish(sent);
  const auto got = take<ResultMessage>(*watch, 1);

  ASSERT_EQ(got.size(), 1);
  EXPECT_TRUE(got[0] == sent) << line_of(to_json(got[0]));
}

TEST_F(DdsService, TellsItsHealth) {
  const auto told = service("RX-90");
  const auto watch = monitor("RX-90");

  told->publish({{"selfcal: encoders", Health::ok, "1000 a second", {{"age_ms", "1"}, {"n", "6"}}},
                 {"selfcal: trigger", Health::stale, "", {}}},
                "serial 7");
  const auto got = take<HealthReport>(*watch, 1);

  ASSERT_EQ(got.size(), 1);
  EXPECT_EQ(got[0].hardware_id, "serial 7");
  ASSERT_EQ(got[0].lines.size(), 2);
  EXPECT_EQ(got[0].lines[0].name, "selfcal: encoders");
  EXPECT_EQ(got[0].lines[0].level, Health::ok);
  EXPECT_EQ(got[0].lines[0].message, "1000 a second");
  EXPECT_THAT(got[0].lines[0].values, ElementsAre(Pair("age_ms", "1"), Pair("n", "6")));
  EXPECT_EQ(got[0].lines[1].level, Health::stale);
  EXPECT_TRUE(got[0].lines[1].values.empty());
}

TEST_F(DdsService, IsHeardByWhoComesLate) {
  const auto told = service("r");
  for (int session = 1; session <= 3; ++session) {
    told->publish(of<StatusMessage>("r", session));
    told->publish(of<ResultMessage>("r", session));
    told->publish(of<ProgressMessage>("r", session));
  }

  const auto watch = monitor("r");
  const auto status = take<StatusMessage>(*watch, 1);
  const auto result = take<ResultMessage>(*watch, 1);
  std::vector<ProgressMessage> progress;
  watch->take(progress);

  ASSERT_EQ(status.size(), 1);
  EXPECT_EQ(status[0].session, 3);
  ASSERT_EQ(result.size(), 1);
  EXPECT_EQ(result[0].session, 3);
  EXPECT_TRUE(progress.empty());
}

TEST_F(DdsService, DoesNotMixWithAnotherRobots) {
  const auto first = service("a"), second = service("b");
  const auto watch_first = monitor("a"), watch_second = monitor("b");

  first->publish(of<StatusMessage>("a", 1));
  second->publish(of<StatusMessage>("b", 1));
  first->publish({{"selfcal: disk", Health::ok, "of a", {}}}, "1");
  second->publish({{"selfcal: disk", Health::warn, "of b", {}}}, "2");

  EXPECT_EQ(take<StatusMessage>(*watch_first, 1).at(0).robot, "a");
  EXPECT_EQ(take<StatusMessage>(*watch_second, 1).at(0).robot, "b");
  const auto health = take<HealthReport>(*watch_second, 1);
  ASSERT_EQ(health.size(), 1);
  EXPECT_EQ(health[0].lines.at(0).message, "of b");
}

TEST_F(DdsService, FailsWhenTheDomainIsNone) {
  EXPECT_FALSE(DdsParticipant::open(kMostDdsDomain + 1, "test"));
}

}  // namespace
}  // namespace selfcal
