// The header of an observations file against the list of known columns.
#include "io/files/columns.h"

#include <algorithm>
#include <charconv>

namespace selfcal {
namespace {

struct Known {
  std::string_view name;
  CellKind kind;
};

constexpr Known kKnown[] = {{"set", CellKind::text},           {"group", CellKind::text},
                            {"repeat", CellKind::text},        {"part", CellKind::text},
                            {"x", CellKind::metres},           {"y", CellKind::metres},
                            {"z", CellKind::metres},           {"qw", CellKind::number},
                            {"qx", CellKind::number},          {"qy", CellKind::number},
                            {"qz", CellKind::number},          {"distance", CellKind::distance},
                            {"alpha", CellKind::number},       {"beta", CellKind::number},
                            {"phi", CellKind::number},         {"fx", CellKind::number},
                            {"fy", CellKind::number},          {"fz", CellKind::number},
                            {"tx", CellKind::number},          {"ty", CellKind::number},
                            {"tz", CellKind::number},          {"nx", CellKind::number},
                            {"ny", CellKind::number},          {"nz", CellKind::number},
                            {"temperature", CellKind::number}, {"time", CellKind::number},
                            {"noise_factor", CellKind::number}};

/// The whole of `text` as a count without leading zeros, else nothing.
std::optional<int> parse_count(std::string_view text) {
  int count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (text.starts_with('0') && text.size() > 1) return std::nullopt;
  return count;
}

/// K of a joint's column PREFIXk.
std::optional<int> joint_of(std::string_view name, std::string_view prefix) {
  if (!name.starts_with(prefix)) return std::nullopt;
  return parse_count(name.substr(prefix.size()));
}

/// m1x, m12z: a coordinate of a marker.
bool is_marker(std::string_view name) {
  if (name.size() < 3 || name.front() != 'm') return false;
  return std::string_view("xyz").find(name.back()) != std::string_view::npos &&
         parse_count(name.substr(1, name.size() - 2)).has_value();
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

std::optional<RowFault> check_joint_columns(const Layout& layout, int joints) {
  const std::string robot_has = "the robot has " + std::to_string(joints) + " joints";
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const std::string& name = layout.columns[i].name;
    const std::optional<int> reading = joint_of(name, "q");
    const std::optional<int> joint = reading ? reading : joint_of(name, "dq");
    if (joint && (*joint < 1 || *joint > joints)) return RowFault{robot_has, i};
  }
  for (int joint = 1; joint <= joints; ++joint) {
    const std::string name = "q" + std::to_string(joint);
    if (!layout.find(name)) return RowFault{"column '" + name + "' is missing: " + robot_has};
  }
  return std::nullopt;
}

/// Finds columns that belong together, or names the one that is missing.
template <std::size_t N>
tl::expected<Columns<N>, RowFault> find_all(const Layout& layout,
                                            const std::array<std::string_view, N>& names) {
  std::array<std::size_t, N> places{};
  std::string_view missing;
  std::size_t present = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const std::optional<std::size_t> place = layout.find(names[i]);
    if (place) places[present++] = *place;
    if (!place && missing.empty()) missing = names[i];
  }
  if (present == 0) return Columns<N>();
  if (present == N) return Columns<N>(places);
  return tl::unexpected(RowFault{"column '" + std::string(missing) + "' is missing: '" +
                                 layout.columns[places[0]].name + "' needs it"});
}

}  // namespace

std::optional<std::size_t> Layout::find(std::string_view name) const {
  const auto found = std::ranges::find(columns, name, &Column::name);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

std::vector<std::string> Layout::ignored() const {
  std::vector<std::string> names;
  for (const Column& column : columns) {
    if (column.kind == CellKind::ignored) names.push_back(column.name);
  }
  return names;
}

tl::expected<Layout, RowFault> read_header(Cells names, int joints,
                                           const std::vector<MeasuredColumn>& measured) {
  Layout layout;
  for (const std::string_view name : names) {
    layout.columns.push_back({std::string(name), kind_of(name, measured)});
  }
  const std::optional<std::size_t> set = layout.find("set");
  if (!set) return tl::unexpected(RowFault{"column 'set' is missing"});
  if (auto fault = check_joint_columns(layout, joints)) return tl::unexpected(std::move(*fault));
  layout.set = *set;
  for (int joint = 1; joint <= joints; ++joint) {
    layout.q.push_back(*layout.find("q" + std::to_string(joint)));
  }
  layout.group = layout.find("group");
  layout.repeat = layout.find("repeat");
  layout.part = layout.find("part");
  layout.temperature = layout.find("temperature");
  layout.noise_factor = layout.find("noise_factor");
  layout.time = layout.find("time");
  for (int joint = 1; joint <= joints; ++joint)
    if (const auto place = layout.find("dq" + std::to_string(joint))) layout.dq.push_back(*place);
  if (!layout.dq.empty() && static_cast<int>(layout.dq.size()) != joints)
    return tl::unexpected(RowFault{"dq is given for some joints and not for all", layout.dq[0]});
  const auto position = find_all<3>(layout, {"x", "y", "z"});
  if (!position) return tl::unexpected(position.error());
  const auto normal = find_all<3>(layout, {"nx", "ny", "nz"});
  if (!normal) return tl::unexpected(normal.error());
  const auto orientation = find_all<4>(layout, {"qw", "qx", "qy", "qz"});
  if (!orientation) return tl::unexpected(orientation.error());
  const auto wrench = find_all<6>(layout, {"fx", "fy", "fz", "tx", "ty", "tz"});
  if (!wrench) return tl::unexpected(wrench.error());
  layout.wrench = *wrench;
  layout.position = *position;
  layout.normal = *normal;
  layout.orientation = *orientation;
  for (const MeasuredColumn& column : measured)
    if (const auto place = layout.find(column.name)) layout.measured.push_back(*place);
  return layout;
}

}  // namespace selfcal
