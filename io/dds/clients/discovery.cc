// Which services are there. The library tells of every writer in the domain through a builtin
// topic (DCPSPublication of the DDS specification, 2.2.5).
#include "io/dds/clients/discovery.h"

#include <algorithm>

#include "io/dds/qos.h"

namespace selfcal {
namespace {

void note_news(dds_entity_t, void* argument) { static_cast<Wakeup*>(argument)->notify(); }

}  // namespace

std::string robot_of_status(std::string_view topic) {
  constexpr std::string_view kBefore = "rt/selfcal/", kAfter = "/status";
  if (!topic.starts_with(kBefore) || !topic.ends_with(kAfter)) return {};
  if (topic.size() <= kBefore.size() + kAfter.size()) return {};
  topic.remove_prefix(kBefore.size());
  topic.remove_suffix(kAfter.size());
  return topic.find('/') == std::string_view::npos ? std::string(topic) : std::string();
}

Result<std::unique_ptr<DdsRobots>> DdsRobots::open(const DdsParticipant& participant,
                                                   Wakeup& wakeup) {
  const std::unique_ptr<dds_listener_t, decltype(&dds_delete_listener)> listener(
      dds_create_listener(&wakeup), dds_delete_listener);
  dds_lset_data_available(listener.get(), note_news);
  const dds_entity_t reader = dds_create_reader(
      participant.handle(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, listener.get());
  if (reader < 0) return dds_failed("writers cannot be listed", reader);
  return std::unique_ptr<DdsRobots>(new DdsRobots(DdsEntity(reader)));
}

Result<std::vector<std::string>> DdsRobots::heard() {
  constexpr std::size_t kBatch = 64;
  dds_return_t count = kBatch;
  while (count == static_cast<dds_return_t>(kBatch)) {
    void* samples[kBatch] = {};
    dds_sample_info_t infos[kBatch];
    count = dds_take(reader_.handle(), samples, infos, kBatch, kBatch);
    if (count < 0) return dds_failed("writers cannot be listed", count);
    for (dds_return_t i = 0; i < count; ++i) {
      writers_.erase(infos[i].instance_handle);
      if (!infos[i].valid_data || infos[i].instance_state != DDS_IST_ALIVE) continue;
      const auto& writer = *static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
      if (std::string robot = robot_of_status(writer.topic_name); !robot.empty())
        writers_[infos[i].instance_handle] = std::move(robot);
    }
    if (count > 0) dds_return_loan(reader_.handle(), samples, count);
  }
  std::vector<std::string> robots;
  for (const auto& [handle, robot] : writers_) robots.push_back(robot);
  std::ranges::sort(robots);
  robots.erase(std::unique(robots.begin(), robots.end()), robots.end());
  return robots;
}

}  // namespace selfcal
