#include "tests/support/stop_watch.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "io/dds/names.h"
#include "tests/support/domain.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kSettled = kSecond / 2;  // what is older has come from both writers

}  // namespace

StopWatch::StopWatch(const DdsParticipant& participant, const std::string& robot)
    : trigger_(must(DdsReader<dds::StampedBool>::open(participant, robot_topic(robot, "trigger"),
                                                      kSensorReader))),
      requests_(must(DdsReader<dds::MotionRequest>::open(
          participant, robot_topic(robot, "motion_request"), kExchange))) {}

void StopWatch::listen() {
  using What = Moment::What;
  must(trigger_.take([&](const dds::StampedBool& message, const dds_sample_info_t& info) {
    if (level_ && *level_ == message.data_) return;  // the level repeated
    level_ = message.data_;
    moments_.push_back({info.source_timestamp, message.data_ ? What::closed : What::opened});
  }));
  must(requests_.take([&](const dds::MotionRequest& message, const dds_sample_info_t& info) {
    if (std::string(message.kind_) != "stop") return;
    stops_.push_back(info.source_timestamp);
    moments_.push_back({info.source_timestamp, What::stop});
  }));
  std::ranges::sort(moments_, {}, &Moment::time);
  const dds_time_t settled = dds_time() - kSettled;
  const Moment* contact = nullptr;
  std::size_t done = 0;
  for (std::size_t i = 0; i < moments_.size() && moments_[i].time < settled; ++i) {
    const Moment& moment = moments_[i];
    if (moment.what == What::closed) contact = &moment;
    if (moment.what == What::stop && contact) {
      took_.push_back(1e-9 * static_cast<double>(moment.time - contact->time));
      contact = nullptr;
    }
    if (moment.what == What::opened) contact = nullptr;
    if (!contact) done = i + 1;
  }
  moments_.erase(moments_.begin(), moments_.begin() + static_cast<std::ptrdiff_t>(done));
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  return values[std::min(at, values.size() - 1)];
}

}  // namespace selfcal
