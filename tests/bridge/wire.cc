// Requests on the wire against bytes worked out by hand from the encoding of rmw_cyclonedds: CDR,
// little endian, 8 bytes of the client and 8 of the request's number before the fields.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <gmock/gmock.h>

#include <cstring>

#include "io/dds/names.h"
#include "tests/bridge/controller.h"

namespace selfcal {
namespace {

/// CDR as it is read on paper: each number at a multiple of its size.
class Bytes {
 public:
  template <class T>
  Bytes& add(T value) {
    while (all.size() % sizeof value != 0) all.push_back(0);
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    all.append(raw, sizeof value);
    return *this;
  }
  Bytes& text(const std::string& value) {
    add(static_cast<std::uint32_t>(value.size() + 1));
    all += value;
    all.push_back(0);
    return *this;
  }
  std::string all;
};

class Wire : public DdsTest {
 protected:
  /// What the reader's next message was on the wire, without the 4 bytes that name the encoding;
  /// padding at the end cut to `size`.
  std::string next(dds_entity_t reader, std::size_t size) {
    ddsi_serdata* data = nullptr;
    dds_sample_info_t info;
    EXPECT_TRUE(
        eventually([&] { return dds_takecdr(reader, &data, 1, &info, DDS_ANY_STATE) == 1; }));
    if (!data) return {};
    std::string bytes(ddsi_serdata_size(data), 0);
    ddsi_serdata_to_ser(data, 0, bytes.size(), bytes.data());
    ddsi_serdata_unref(data);
    EXPECT_EQ(bytes.substr(0, 2), std::string("\0\1", 2)) << "CDR, little endian";
    EXPECT_LT(bytes.size() - 4 - size, 4u) << "padded to 4";
    return bytes.substr(4, size);
  }
  template <class T>
  dds_entity_t reader_of(const std::string& topic) {
    const dds_entity_t made = dds_create_topic(
        participant.handle(), dds::message_type<T>.descriptor, topic.c_str(), nullptr, nullptr);
    return dds_create_reader(participant.handle(), made,
                             to_library(kExchange, dds::message_type<T>.hash).get(), nullptr);
  }
  std::uint64_t client() {
    std::uint64_t handle = 0;
    std::memcpy(&handle, first.data(), 8);
    return handle;
  }
  std::string first;
};

TEST_F(Wire, AGoalAndItsCancellationAreWhatRosReads) {
  const dds_entity_t goals = reader_of<dds::SendGoalRequest>("rq/arm/f/_action/send_goalRequest");
  const dds_entity_t cancels = reader_of<dds::CancelRequest>("rq/arm/f/_action/cancel_goalRequest");
  const auto action = must(TrajectoryAction::open(participant, "arm/f", {"j1"}, wakeup));
  ASSERT_TRUE(eventually([&] {
    dds_subscription_matched_status_t a{}, b{};
    dds_get_subscription_matched_status(goals, &a);
    dds_get_subscription_matched_status(cancels, &b);
    return a.current_count == 1 && b.current_count == 1;
  }));
  GoalId goal;
  for (int i = 0; i < 16; ++i) goal[i] = static_cast<std::uint8_t>(i + 1);
  must(action->send(goal, {{.time = 1.25, .q = {0.5}, .dq = {0.0}}}));
  must(action->cancel(goal));

  Bytes tail;  // what follows the client's 8 bytes, aligned as these are
  tail.add(std::int64_t{1});
  for (const std::uint8_t byte : goal) tail.add(byte);
  tail.add(0).add(0u).text("");                  // header: stamp, frame
  tail.add(1u).text("j1");                       // joint_names
  tail.add(1u);                                  // points
  tail.add(1u).add(0.5).add(1u).add(0.0);        // positions, velocities
  tail.add(0u).add(0u).add(1).add(250000000u);   // accelerations, effort, time_from_start
  tail.add(0).add(0u).text("").add(0u).add(0u);  // multi_dof_trajectory
  tail.add(0u).add(0u).add(0u).add(0u);          // tolerances
  tail.add(0).add(0u);                           // goal_time_tolerance
  first = next(goals, 8 + tail.all.size());
  EXPECT_NE(client(), 0u);
  EXPECT_EQ(first.substr(8), tail.all);

  Bytes cancel;
  cancel.add(client()).add(std::int64_t{2});
  for (const std::uint8_t byte : goal) cancel.add(byte);
  cancel.add(0).add(0u);
  EXPECT_EQ(next(cancels, cancel.all.size()), cancel.all);
}

TEST_F(Wire, TypesAndTopicsHaveTheNamesOfRos) {
  EXPECT_STREQ(dds::message_type<dds::SendGoalRequest>.descriptor->m_typename,
               "control_msgs::action::dds_::FollowJointTrajectory_SendGoal_Request_");
  EXPECT_STREQ(dds::message_type<dds::SendGoalReply>.descriptor->m_typename,
               "control_msgs::action::dds_::FollowJointTrajectory_SendGoal_Response_");
  EXPECT_STREQ(dds::message_type<dds::GetResultReply>.descriptor->m_typename,
               "control_msgs::action::dds_::FollowJointTrajectory_GetResult_Response_");
  EXPECT_STREQ(dds::message_type<dds::CancelRequest>.descriptor->m_typename,
               "action_msgs::srv::dds_::CancelGoal_Request_");
  EXPECT_STREQ(dds::message_type<dds::Bool>.descriptor->m_typename, "std_msgs::msg::dds_::Bool_");
  EXPECT_EQ(action_request_topic("/arm/f", "send_goal"), "rq/arm/f/_action/send_goalRequest");
  EXPECT_EQ(action_reply_topic("arm/f", "get_result"), "rr/arm/f/_action/get_resultReply");
}

// As rmw_cyclonedds answers: the header of the request first.
TEST_F(Wire, RepliesAreReadAsRosWritesThem) {
  const dds_entity_t results = reader_of<dds::GetResultReply>("rr/arm/f/_action/get_resultReply");
  auto writer = must(DdsWriter<dds::GetResultReply>::open(
      participant, "rr/arm/f/_action/get_resultReply", kExchange, &wakeup));
  ASSERT_TRUE(eventually([&] { return writer.matched() == 1; }));
  must(writer.write({.client_ = 7,
                     .number_ = 3,
                     .status_ = 6,
                     .error_code_ = -4,
                     .error_string_ = const_cast<char*>("late")}));
  Bytes bytes;
  bytes.add(std::uint64_t{7}).add(std::int64_t{3}).add(std::int8_t{6}).add(-4).text("late");
  EXPECT_EQ(next(results, bytes.all.size()), bytes.all);
}

}  // namespace
}  // namespace selfcal
