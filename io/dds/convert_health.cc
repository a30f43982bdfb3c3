// Health as a DiagnosticArray, the form that ROS's tools show.
//
// All robots of a domain share the topic, and the tools tell lines apart by their names alone: so a
// line's name starts with its robot, "rx_90/selfcal: encoders".

#include "io/dds/convert.h"
#include "io/dds/names.h"

namespace selfcal {
namespace {

using borrowed::text;

std::vector<dds::KeyValue> borrow_values(const HealthMessage& line) {
  std::vector<dds::KeyValue> values;
  for (const auto& [key, value] : line.values)
    values.push_back({.key_ = text(key), .value_ = text(value)});
  return values;
}

HealthMessage plain_line(const dds::DiagnosticStatus& line, std::size_t prefix) {
  HealthMessage plain{.name = std::string(line.name_).substr(prefix),
                      .level = static_cast<Health>(std::min<std::uint8_t>(line.level_, 3)),
                      .message = line.message_,
                      .values = {}};
  for (std::uint32_t i = 0; i < line.values_._length; ++i)
    plain.values.emplace_back(line.values_._buffer[i].key_, line.values_._buffer[i].value_);
  return plain;
}

}  // namespace

DiagnosticsToSend::DiagnosticsToSend(const std::vector<HealthMessage>& health,
                                     const std::string& robot, const std::string& hardware_id,
                                     std::int64_t unix_ms) {
  for (const auto& line : health) {
    names_.push_back(ros_name(robot) + "/" + line.name);
    values_.push_back(borrow_values(line));
  }
  for (std::size_t i = 0; i < health.size(); ++i) {
    const auto size = static_cast<std::uint32_t>(values_[i].size());
    lines_.push_back({.level_ = static_cast<std::uint8_t>(health[i].level),
                      .name_ = text(names_[i]),
                      .message_ = text(health[i].message),
                      .hardware_id_ = text(hardware_id),
                      .values_ = {size, size, values_[i].data(), false}});
  }
  const auto size = static_cast<std::uint32_t>(lines_.size());
  message_ = {.header_ = header_of(unix_ms * kMillisecond),
              .status_ = {size, size, lines_.data(), false}};
}

HealthReport to_plain(const dds::DiagnosticArray& array, const std::string& robot) {
  HealthReport report;
  report.unix_ms = nanoseconds(array.header_.stamp_) / kMillisecond;
  const std::string prefix = ros_name(robot) + "/";
  for (std::uint32_t i = 0; i < array.status_._length; ++i) {
    const auto& line = array.status_._buffer[i];
    if (!std::string_view(line.name_).starts_with(prefix)) continue;
    report.hardware_id = line.hardware_id_;
    report.lines.push_back(plain_line(line, prefix.size()));
  }
  return report;
}

}  // namespace selfcal
