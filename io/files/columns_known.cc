// The columns that data sets have, whatever a file makes of them.
#include <charconv>

#include "io/files/columns.h"

namespace selfcal {
namespace {

struct Known {
  std::string_view name;
  CellKind kind;
  Dimension dimension = Dimension::none;
};

constexpr Known kKnown[] = {{"set", CellKind::text},
                            {"group", CellKind::text},
                            {"repeat", CellKind::text},
                            {"part", CellKind::text},
                            {"x", CellKind::metres, Dimension::length},
                            {"y", CellKind::metres, Dimension::length},
                            {"z", CellKind::metres, Dimension::length},
                            {"qw", CellKind::number},
                            {"qx", CellKind::number},
                            {"qy", CellKind::number},
                            {"qz", CellKind::number},
                            {"distance", CellKind::distance, Dimension::length},
                            {"alpha", CellKind::number, Dimension::angle},
                            {"beta", CellKind::number, Dimension::angle},
                            {"phi", CellKind::number, Dimension::angle},
                            {"fx", CellKind::number, Dimension::force},
                            {"fy", CellKind::number, Dimension::force},
                            {"fz", CellKind::number, Dimension::force},
                            {"tx", CellKind::number, Dimension::torque},
                            {"ty", CellKind::number, Dimension::torque},
                            {"tz", CellKind::number, Dimension::torque},
                            {"nx", CellKind::number},
                            {"ny", CellKind::number},
                            {"nz", CellKind::number},
                            {"temperature", CellKind::celsius, Dimension::temperature},
                            {"time", CellKind::number, Dimension::time},
                            {"noise_factor", CellKind::number}};

/// The whole of `text` as a count without leading zeros, else nothing.
std::optional<int> parse_count(std::string_view text) {
  int count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (text.starts_with('0') && text.size() > 1) return std::nullopt;
  return count;
}

/// m1x, m12z: a coordinate of a marker.
bool is_marker(std::string_view name) {
  if (name.size() < 3 || name.front() != 'm') return false;
  return std::string_view("xyz").find(name.back()) != std::string_view::npos &&
         parse_count(name.substr(1, name.size() - 2)).has_value();
}

}  // namespace

std::optional<int> joint_of(std::string_view name, std::string_view prefix) {
  if (!name.starts_with(prefix)) return std::nullopt;
  return parse_count(name.substr(prefix.size()));
}

CellKind kind_of(std::string_view name, const std::vector<MeasuredColumn>& measured) {
  for (const MeasuredColumn& column : measured) {
    if (column.name != name) continue;
    if (column.quantity == Quantity::angle) return CellKind::number;
    return column.never_negative ? CellKind::distance : CellKind::metres;
  }
  for (const Known& known : kKnown) {
    if (known.name == name) return known.kind;
  }
  if (joint_of(name, "q") || joint_of(name, "dq")) return CellKind::number;
  return is_marker(name) ? CellKind::metres : CellKind::ignored;
}

Dimension dimension_of(std::string_view name, const std::vector<Joint>& joints,
                       const std::vector<MeasuredColumn>& measured) {
  for (const MeasuredColumn& column : measured)
    if (column.name == name)
      return column.quantity == Quantity::angle ? Dimension::angle : Dimension::length;
  for (const Known& known : kKnown)
    if (known.name == name) return known.dimension;
  const std::optional<int> reading = joint_of(name, "q"), speed = joint_of(name, "dq");
  const int joint = reading.value_or(speed.value_or(0));
  if (joint < 1 || joint > static_cast<int>(joints.size()))
    return is_marker(name) ? Dimension::length : Dimension::none;
  const bool angle = joints[static_cast<std::size_t>(joint) - 1].quantity == Quantity::angle;
  if (reading) return angle ? Dimension::angle : Dimension::length;
  return angle ? Dimension::angular_speed : Dimension::speed;
}

}  // namespace selfcal
