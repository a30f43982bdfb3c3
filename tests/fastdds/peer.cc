#include "tests/fastdds/peer.h"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <gtest/gtest.h>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

#include <cstring>
#include <memory>

namespace selfcal {
namespace {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

/// Bytes as they are on the wire; a sample is a std::string.
class RawType final : public fast::TopicDataType {
 public:
  explicit RawType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 1 << 16;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<std::string*>(data);
    if (bytes.size() > payload->max_size) return false;
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<std::string*>(data)->assign(reinterpret_cast<const char*>(payload->data),
                                            payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<std::string*>(data)->size()); };
  }
  void* createData() override { return new std::string; }
  void deleteData(void* data) override { delete static_cast<std::string*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

/// What rmw_fastrtps asks of writers and readers alike.
template <class Qos>
void set(Qos& qos, const FastTopic& topic) {
  qos.reliability().kind =
      topic.reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind =
      topic.transient_local ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = topic.transient_local ? 1 : 1000;
  qos.resource_limits().max_samples = 2000;
  qos.resource_limits().max_samples_per_instance = 2000;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.data_sharing().off();
}

/// Over the loopback interface alone, and only to the ports of `domain` there.
fast::DomainParticipantQos loopback(std::uint32_t domain) {
  fast::DomainParticipantQos qos = fast::PARTICIPANT_QOS_DEFAULT;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.emplace_back("127.0.0.1");
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  auto& builtin = qos.wire_protocol().builtin;
  for (std::uint32_t participant = 0; participant <= 30; ++participant) {
    rtps::Locator_t peer;
    rtps::IPLocator::setIPv4(peer, 127, 0, 0, 1);
    peer.port = 7400 + 250 * domain + 10 + 2 * participant;
    builtin.initialPeersList.push_back(peer);
  }
  builtin.discovery_config.leaseDuration = {5, 0};
  builtin.discovery_config.leaseDuration_announcementperiod = {0, 200'000'000};
  const std::string enclave = "enclave=/;";
  qos.user_data().assign(enclave.begin(), enclave.end());
  return qos;
}

}  // namespace

bool FastWriter::write(std::string bytes, std::int64_t stamp) {
  const eprosima::fastrtps::Time_t time(static_cast<std::int32_t>(stamp / 1'000'000'000),
                                        static_cast<std::uint32_t>(stamp % 1'000'000'000));
  return writer_->write_w_timestamp(&bytes, fast::HANDLE_NIL, time) == ReturnCode_t::RETCODE_OK;
}

bool FastWriter::reply(std::string bytes, const rtps::SampleIdentity& request) {
  rtps::WriteParams beside;
  beside.related_sample_identity(request);
  return writer_->write(&bytes, beside);
}

int FastReader::matched() const {
  fast::SubscriptionMatchedStatus status;
  reader_->get_subscription_matched_status(status);
  return status.current_count;
}

std::vector<FastReader::Message> FastReader::take() {
  std::vector<Message> all;
  std::string bytes;
  fast::SampleInfo info;
  while (reader_->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK)
    if (info.valid_data) all.push_back({bytes, info.sample_identity});
  return all;
}

FastPeer::FastPeer(std::uint32_t domain)
    : participant_(fast::DomainParticipantFactory::get_instance()->create_participant(
          domain, loopback(domain))) {
  if (!participant_) {
    ADD_FAILURE() << "Fast DDS opens no participant";
    std::abort();
  }
  publisher_ = participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT);
  subscriber_ = participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
}

FastPeer::~FastPeer() {
  participant_->delete_contained_entities();
  fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

fast::Topic* FastPeer::open(const FastTopic& topic) {
  const fast::TypeSupport type(new RawType(topic.type));
  type.register_type(participant_);
  fast::Topic* opened = participant_->create_topic(topic.name, topic.type, fast::TOPIC_QOS_DEFAULT);
  EXPECT_NE(opened, nullptr) << topic.name;
  return opened;
}

FastWriter FastPeer::writer(const FastTopic& topic) {
  fast::DataWriterQos qos = fast::DATAWRITER_QOS_DEFAULT;
  set(qos, topic);
  return FastWriter(publisher_->create_datawriter(open(topic), qos));
}

FastReader FastPeer::reader(const FastTopic& topic) {
  fast::DataReaderQos qos = fast::DATAREADER_QOS_DEFAULT;
  set(qos, topic);
  return FastReader(subscriber_->create_datareader(open(topic), qos));
}

}  // namespace selfcal
