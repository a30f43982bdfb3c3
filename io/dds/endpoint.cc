// Typed writers and readers of topics.

#include "io/dds/endpoint.h"

namespace selfcal {
namespace {

using Listener = std::unique_ptr<dds_listener_t, decltype(&dds_delete_listener)>;

Listener new_listener(void* argument) {
  return {dds_create_listener(argument), dds_delete_listener};
}

void note_arrival(dds_entity_t, void* argument) {
  auto& arrivals = *static_cast<DdsArrivals*>(argument);
  arrivals.last.store(monotonic_now(), std::memory_order_release);
  arrivals.count.fetch_add(1, std::memory_order_release);
  if (arrivals.wakeup) arrivals.wakeup->notify();
}

void note_writer(dds_entity_t, const dds_subscription_matched_status_t, void* argument) {
  auto& arrivals = *static_cast<DdsArrivals*>(argument);
  if (arrivals.wakeup) arrivals.wakeup->notify();
}

void note_reader(dds_entity_t, const dds_publication_matched_status_t, void* argument) {
  static_cast<Wakeup*>(argument)->notify();
}

// The library keeps a topic for as long as an endpoint uses it, so ours may go at once.
Result<DdsEntity> open_topic(const DdsParticipant& participant, const std::string& name,
                             const dds::MessageType& type) {
  const dds_entity_t topic =
      dds_create_topic(participant.handle(), type.descriptor, name.c_str(), nullptr, nullptr);
  if (topic < 0) return dds_failed("cannot open topic " + name, topic);
  return DdsEntity(topic);
}

}  // namespace

DdsQosHandle to_library(const DdsQos& qos, const char* type_hash) {
  DdsQosHandle handle(dds_create_qos(), dds_delete_qos);
  dds_qset_reliability(handle.get(),
                       qos.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       kLongestBlocking);
  dds_qset_durability(
      handle.get(), qos.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  if (qos.depth > 0) {
    dds_qset_history(handle.get(), DDS_HISTORY_KEEP_LAST, qos.depth);
  } else {
    dds_qset_history(handle.get(), DDS_HISTORY_KEEP_ALL, 0);
    dds_qset_resource_limits(handle.get(), kMostKept, DDS_LENGTH_UNLIMITED, kMostKept);
  }
  const std::string data = std::string("typehash=") + type_hash + ";";
  if (*type_hash) dds_qset_userdata(handle.get(), data.data(), data.size());
  return handle;
}

Result<DdsEntity> open_writer(const DdsParticipant& participant, const std::string& topic,
                              const dds::MessageType& type, const DdsQos& qos, Wakeup* wakeup) {
  const auto opened = open_topic(participant, topic, type);
  if (!opened) return tl::make_unexpected(opened.error());
  const auto listener = new_listener(wakeup);
  if (wakeup) dds_lset_publication_matched(listener.get(), note_reader);
  const dds_entity_t writer = dds_create_writer(participant.handle(), opened->handle(),
                                                to_library(qos, type.hash).get(), listener.get());
  if (writer < 0) return dds_failed("cannot write to topic " + topic, writer);
  return DdsEntity(writer);
}

Result<std::unique_ptr<DdsListening>> open_reader(const DdsParticipant& participant,
                                                  const std::string& topic,
                                                  const dds::MessageType& type, const DdsQos& qos,
                                                  Wakeup* wakeup) {
  const auto opened = open_topic(participant, topic, type);
  if (!opened) return tl::make_unexpected(opened.error());
  auto reader = std::make_unique<DdsListening>();
  reader->arrivals.wakeup = wakeup;
  const auto listener = new_listener(&reader->arrivals);
  dds_lset_data_available(listener.get(), note_arrival);
  dds_lset_subscription_matched(listener.get(), note_writer);
  const dds_entity_t handle = dds_create_reader(participant.handle(), opened->handle(),
                                                to_library(qos, type.hash).get(), listener.get());
  if (handle < 0) return dds_failed("cannot read topic " + topic, handle);
  reader->entity = DdsEntity(handle);
  return reader;
}

Result<void> write(dds_entity_t writer, const void* message) {
  const dds_return_t code = dds_write(writer, message);
  if (code == DDS_RETCODE_TIMEOUT)
    return device_failed("DDS: a message was not sent: its readers have not taken earlier ones");
  if (code < 0) return dds_failed("a message was not sent", code);
  return {};
}

std::uint64_t lost_on_the_way(dds_entity_t reader) {
  dds_sample_lost_status_t status{};
  dds_get_sample_lost_status(reader, &status);
  return status.total_count;
}

std::vector<dds_instance_handle_t> writers_heard(dds_entity_t reader) {
  std::vector<dds_instance_handle_t> writers(kMostWriters);
  const dds_return_t heard = dds_get_matched_publications(reader, writers.data(), writers.size());
  writers.resize(std::clamp<std::size_t>(heard < 0 ? 0 : heard, 0, kMostWriters));
  return writers;
}

}  // namespace selfcal
