// What others see of us: topics, types, hashes, qualities and the encoding on the wire.

#include <dds/ddsi/ddsi_serdata.h>
#include <gmock/gmock.h>

#include <map>

#include "io/dds/convert.h"
#include "io/dds/messenger.h"
#include "io/dds/names.h"
#include "io/dds/robot_side.h"
#include "io/dds/senders.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

using ::testing::ElementsAreArray;

struct Seen {
  std::string type, user_data;
  bool reliable = false, transient_local = false;
};

// All endpoints of `builtin` (DCPSPublication or DCPSSubscription), by topic.
std::map<std::string, Seen> endpoints(const DdsParticipant& participant, dds_entity_t builtin) {
  const DdsEntity reader(dds_create_reader(participant.handle(), builtin, nullptr, nullptr));
  std::map<std::string, Seen> seen;
  void* samples[64] = {};
  dds_sample_info_t infos[64];
  const int count = dds_take(reader.handle(), samples, infos, 64, 64);
  for (int i = 0; i < count; ++i) {
    const auto& endpoint = *static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
    void* data = nullptr;
    std::size_t size = 0;
    dds_qget_userdata(endpoint.qos, &data, &size);
    dds_reliability_kind_t reliability{};
    dds_qget_reliability(endpoint.qos, &reliability, nullptr);
    dds_durability_kind_t durability{};
    dds_qget_durability(endpoint.qos, &durability);
    seen[endpoint.topic_name] = {
        endpoint.type_name, data ? std::string(static_cast<const char*>(data), size) : "",
        reliability == DDS_RELIABILITY_RELIABLE, durability == DDS_DURABILITY_TRANSIENT_LOCAL};
    dds_free(data);
  }
  if (count > 0) dds_return_loan(reader.handle(), samples, count);
  return seen;
}

class DdsDiscovery : public DdsTest {};

TEST_F(DdsDiscovery, ShowsWhatRosLooksFor) {
  const auto service = must(DdsMessenger::open(participant, "RX-90", wakeup));

  const auto writers = endpoints(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION);
  const auto readers = endpoints(participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION);

  ASSERT_EQ(writers.size(), 5);
  const auto& status = writers.at("rt/selfcal/rx_90/status");
  EXPECT_EQ(status.type, "selfcal_msgs::msg::dds_::Status_");
  EXPECT_EQ(status.user_data, std::string("typehash=") + dds::message_type<dds::Status>.hash + ";");
  EXPECT_TRUE(status.reliable);
  EXPECT_TRUE(status.transient_local);
  const auto& result = writers.at("rt/selfcal/rx_90/result");
  EXPECT_EQ(result.type, "selfcal_msgs::msg::dds_::Result_");
  EXPECT_TRUE(result.reliable);
  EXPECT_TRUE(result.transient_local);
  const auto& progress = writers.at("rt/selfcal/rx_90/progress");
  EXPECT_EQ(progress.type, "selfcal_msgs::msg::dds_::Progress_");
  EXPECT_TRUE(progress.reliable);
  EXPECT_FALSE(progress.transient_local);
  const auto& diagnostics = writers.at("rt/diagnostics");
  EXPECT_EQ(diagnostics.type, "diagnostic_msgs::msg::dds_::DiagnosticArray_");
  EXPECT_EQ(diagnostics.user_data,
            "typehash=RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e;");
  EXPECT_FALSE(diagnostics.transient_local);
  EXPECT_EQ(writers.at("rt/selfcal/rx_90/command_reply").type,
            "selfcal_msgs::msg::dds_::CommandReply_");
  ASSERT_EQ(readers.count("rt/selfcal/rx_90/command"), 1);
  EXPECT_EQ(readers.at("rt/selfcal/rx_90/command").type, "selfcal_msgs::msg::dds_::Command_");
  EXPECT_EQ(readers.at("rt/selfcal/rx_90/command").user_data,
            std::string("typehash=") + dds::message_type<dds::Command>.hash + ";");
}

TEST_F(DdsDiscovery, ShowsARobotsSide) {
  const auto robot = must(DdsRobotSide::open(participant, {.robot = "r"}, wakeup));
  const auto joints = must(DdsJointSender::open(participant, "/cell/joint_states", {}, wakeup));
  const auto trigger = must(DdsTriggerSender::open(participant, "touch_trigger", wakeup));

  const auto writers = endpoints(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION);
  const auto readers = endpoints(participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION);

  EXPECT_EQ(writers.at("rt/cell/joint_states").type, "sensor_msgs::msg::dds_::JointState_");
  EXPECT_EQ(writers.at("rt/touch_trigger").type, "selfcal_msgs::msg::dds_::StampedBool_");
  EXPECT_EQ(writers.at("rt/temperature").type, "sensor_msgs::msg::dds_::Temperature_");
  EXPECT_EQ(writers.at("rt/selfcal/r/motion_reply").type, "selfcal_msgs::msg::dds_::MotionReply_");
  EXPECT_EQ(readers.at("rt/selfcal/r/motion_request").type,
            "selfcal_msgs::msg::dds_::MotionRequest_");
}

/// The message on the wire, without the library's padding at the end and its count of it.
template <class Message>
std::vector<std::uint8_t> on_the_wire(const DdsParticipant& participant, const std::string& topic,
                                      const Message& message, std::size_t size) {
  auto writer = must(DdsWriter<Message>::open(participant, topic, kExchange));
  const DdsEntity named(dds_create_topic(participant.handle(),
                                         dds::message_type<Message>.descriptor, topic.c_str(),
                                         nullptr, nullptr));
  const DdsEntity reader(dds_create_reader(participant.handle(), named.handle(),
                                           to_library(kExchange, "").get(), nullptr));
  must(writer.write(message));
  ddsi_serdata* data = nullptr;
  dds_sample_info_t info;
  EXPECT_EQ(dds_takecdr(reader.handle(), &data, 1, &info, DDS_ANY_STATE), 1);
  if (!data) return {};
  std::vector<std::uint8_t> bytes(ddsi_serdata_size(data));
  ddsi_serdata_to_ser(data, 0, bytes.size(), bytes.data());
  ddsi_serdata_unref(data);
  EXPECT_GE(bytes.size(), size);
  EXPECT_LT(bytes.size(), size + 4);
  bytes[3] = 0;
  bytes.resize(size);
  return bytes;
}

// Bytes worked by hand after the CDR rules: little endian, numbers at multiples of their size
// counted after the four bytes of the encapsulation, strings with length and closing zero.
TEST_F(DdsDiscovery, EncodesAsRosReads) {
  const MotionReply reply{.id = 0x0102, .outcome = MotionReply::Outcome::done, .why = "ab"};
  const std::vector<std::uint8_t> expected = {0, 1, 0, 0,  // classic CDR, little endian
                                              2, 1, 0, 0, 0,   0,   0,   0,  // id
                                              5, 0, 0, 0, 'd', 'o', 'n', 'e',
                                              0, 0, 0, 0,  // outcome, and up to a multiple of 4
                                              3, 0, 0, 0, 'a', 'b', 0};  // why
  EXPECT_THAT(on_the_wire<dds::MotionReply>(participant, robot_topic("r", "motion_reply"),
                                            borrow(reply), expected.size()),
              ElementsAreArray(expected));
}

TEST_F(DdsDiscovery, EncodesJointStatesAndTouchesAsRosReads) {
  std::string frame, joint = "a";
  char* names[] = {joint.data()};
  double position[] = {1.5};
  dds::JointState joints{};
  joints.header_.stamp_ = {.sec_ = 1, .nanosec_ = 2};
  joints.header_.frame_id_ = frame.data();
  joints.name_ = {._maximum = 1, ._length = 1, ._buffer = names, ._release = false};
  joints.position_ = {._maximum = 1, ._length = 1, ._buffer = position, ._release = false};
  const std::vector<std::uint8_t> states = {0, 1, 0, 0,                      //
                                            1, 0, 0, 0, 2,   0, 0,    0,     // stamp
                                            1, 0, 0, 0, 0,   0, 0,    0,     // frame, up to 4
                                            1, 0, 0, 0,                      // one name
                                            2, 0, 0, 0, 'a', 0, 0,    0,     // up to 4
                                            1, 0, 0, 0,                      // one position, at 32
                                            0, 0, 0, 0, 0,   0, 0xF8, 0x3F,  // 1.5
                                            0, 0, 0, 0,                      // no velocity
                                            0, 0, 0, 0};                     // no effort
  EXPECT_THAT(on_the_wire(participant, "rt/joint_states", joints, states.size()),
              ElementsAreArray(states));

  dds::StampedBool touch{};
  touch.header_.stamp_ = {.sec_ = 1, .nanosec_ = 2};
  touch.header_.frame_id_ = frame.data();
  touch.data_ = true;
  const std::vector<std::uint8_t> touched = {0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0,  // stamp
                                             1, 0, 0, 0, 0,                       // frame
                                             1};                                  // the level
  EXPECT_THAT(on_the_wire(participant, "rt/touch", touch, touched.size()),
              ElementsAreArray(touched));
}

}  // namespace
}  // namespace selfcal
