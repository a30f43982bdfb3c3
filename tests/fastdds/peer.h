// A participant of eProsima's Fast DDS, as rmw_fastrtps opens one: raw bytes under the names that
// ROS 2 gives to topics and types, no type information.
#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace selfcal {

/// A topic with its type, and how surely its messages are kept.
struct FastTopic {
  std::string name;  ///< "rt/joint_states"
  std::string type;  ///< "sensor_msgs::msg::dds_::JointState_"
  bool reliable = true, transient_local = false;
};

class FastWriter {
 public:
  explicit FastWriter(eprosima::fastdds::dds::DataWriter* writer) : writer_(writer) {}
  bool write(std::string bytes) { return writer_->write(&bytes); }
  /// As written at `stamp` (ns of the wall clock).
  bool write(std::string bytes, std::int64_t stamp);
  /// As a service's reply to a request.
  bool reply(std::string bytes, const eprosima::fastrtps::rtps::SampleIdentity& request);

 private:
  eprosima::fastdds::dds::DataWriter* writer_;
};

class FastReader {
 public:
  struct Message {
    std::string bytes;
    eprosima::fastrtps::rtps::SampleIdentity identity;
  };
  explicit FastReader(eprosima::fastdds::dds::DataReader* reader) : reader_(reader) {}
  std::vector<Message> take();
  int matched() const;

 private:
  eprosima::fastdds::dds::DataReader* reader_;
};

class FastPeer {
 public:
  explicit FastPeer(std::uint32_t domain);
  FastPeer(const FastPeer&) = delete;
  FastPeer& operator=(const FastPeer&) = delete;
  ~FastPeer();
  FastWriter writer(const FastTopic& topic);
  FastReader reader(const FastTopic& topic);

 private:
  eprosima::fastdds::dds::Topic* open(const FastTopic& topic);
  eprosima::fastdds::dds::DomainParticipant* participant_;
  eprosima::fastdds::dds::Publisher* publisher_;
  eprosima::fastdds::dds::Subscriber* subscriber_;
};

}  // namespace selfcal
