// The machine's temperature from a topic of sensor_msgs/Temperature.

#include "io/dds/thermometer.h"

#include <cmath>

#include "io/dds/names.h"

namespace selfcal {

Result<std::unique_ptr<DdsThermometer>> DdsThermometer::open(const DdsParticipant& participant,
                                                             DdsThermometerConfig config) {
  auto reader =
      DdsReader<dds::Temperature>::open(participant, ros_topic(config.topic), kSensorReader);
  if (!reader) return tl::make_unexpected(reader.error());
  return std::unique_ptr<DdsThermometer>(new DdsThermometer(std::move(config), *std::move(reader)));
}

std::optional<double> DdsThermometer::celsius() {
  const auto taken = reader_.take([&](const dds::Temperature& message) {
    celsius_ = message.temperature_;
    if (!std::isfinite(message.temperature_)) celsius_.reset();
  });
  if (!taken || monotonic_now() - reader_.newest_arrival() > config_.oldest) celsius_.reset();
  return celsius_;
}

}  // namespace selfcal
