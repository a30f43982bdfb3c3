// What becomes of a goal on a server that encodes as rmw_fastrtps does, whose replies name nobody.
#include "io/dds/ros/fast_services.h"

#include <gmock/gmock.h>

#include "io/dds/opened.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

using What = GoalNews::What;

class FastGoal : public DdsTest {
 protected:
  void SetUp() override {
    DdsOpening opening(participant);
    opening.open(replies, action_reply_topic(kArm, "send_goal"), kExchange, &wakeup);
    opening.open(status, action_status_topic(kArm), kLatched, &wakeup);
    opening.open(cancels, action_request_topic(kArm, "cancel_goal"), kExchange, &wakeup);
    must(opening.finish([] { return 0; }));
    services = must(FastServices::open(participant, kArm, {"a"}, wakeup));
    ASSERT_TRUE(eventually(
        [&] { return replies.matched() == 1 && status.matched() == 1 && cancels.matched() == 1; }));
    must(services->send(goal, {{.time = 1, .q = {0.5}, .dq = {0}}}));
  }
  void reply(bool accepted) { must(replies.write({.accepted_ = accepted, .stamp_ = {}})); }
  /// `code` of action_msgs/GoalStatus: 2 executing, 4 succeeded.
  void tell_status(int code) {
    dds::GoalStatusArray array{};
    auto each = action_msgs_msg_dds__GoalStatus_{};
    std::ranges::copy(goal, each.goal_info_.goal_id_);
    each.status_ = static_cast<std::int8_t>(code);
    array.status_list_ = {1, 1, &each, false};
    must(status.write(array));
  }
  bool comes(What what) {
    return eventually([&] {
      std::vector<GoalNews> news;
      must(services->take(news));
      return std::ranges::count(news, what, &GoalNews::what) > 0;
    });
  }
  bool is_cancelled() {
    return eventually([&] {
      int seen = 0;
      must(cancels.take([&](const dds::FastCancelRequest& request) {
        seen += std::ranges::equal(request.goal_info_.goal_id_, goal);
      }));
      return seen > 0;
    });
  }

  static constexpr const char* kArm = "arm/f";
  const GoalId goal{1, 2, 3};
  DdsWriter<dds::FastSendGoalReply> replies;
  DdsWriter<dds::GoalStatusArray> status;
  DdsReader<dds::FastCancelRequest> cancels;
  std::unique_ptr<GoalServices> services;
};

TEST_F(FastGoal, IsAcceptedAndDoneWhenItsStatusSaysSo) {
  tell_status(2);
  EXPECT_TRUE(comes(What::accepted));
  tell_status(4);
  EXPECT_TRUE(comes(What::done));
}

TEST_F(FastGoal, IsCancelledWhereAReplyRejectsOneAndToldWhereItWasAnothers) {
  reply(false);
  EXPECT_TRUE(comes(What::rejected));
  EXPECT_TRUE(is_cancelled());
  tell_status(2);  // it came after the cancellation
  EXPECT_TRUE(comes(What::accepted)) << "who asked must hear that it moves";
}

}  // namespace
}  // namespace selfcal
