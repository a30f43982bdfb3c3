// The machine's temperature from a topic of sensor_msgs/Temperature.
#pragma once

#include <memory>
#include <string>

#include "io/dds/endpoint.h"
#include "io/ports.h"

namespace selfcal {

struct DdsThermometerConfig {
  std::string topic = "temperature";  ///< name in ROS
  Nanoseconds oldest = 60 * kSecond;  ///< a value is not known any more after this long without one
};

class DdsThermometer : public Thermometer {
 public:
  static Result<std::unique_ptr<DdsThermometer>> open(const DdsParticipant& participant,
                                                      DdsThermometerConfig config);
  std::optional<double> celsius() override;

 private:
  DdsThermometer(DdsThermometerConfig config, DdsReader<dds::Temperature> reader)
      : config_(std::move(config)), reader_(std::move(reader)) {}

  DdsThermometerConfig config_;
  DdsReader<dds::Temperature> reader_;
  std::optional<double> celsius_;
};

}  // namespace selfcal
