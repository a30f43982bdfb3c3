// The header of an observations file against the list of known columns.
#include "io/files/columns.h"

#include <algorithm>

#include "io/files/near_names.h"

namespace selfcal {
namespace {

/// Gives the columns of a file the names and units that dataset.yaml says.
class Naming {
 public:
  Naming(Cells names, const std::vector<Joint>& joints, const std::vector<MeasuredColumn>& measured)
      : names_(names), joints_(joints), measured_(measured), taken_(names.size(), 0) {
    for (const std::string_view name : names) columns_.push_back({std::string(name)});
  }

  /// The place of a mapped header, now called `column`.
  tl::expected<std::size_t, RowFault> take(const NamedHeader& from, const std::string& column,
                                           Dimension dimension) {
    const auto fault = [&](const std::string& what) {
      return tl::unexpected(RowFault{to_string(from.place) + ": " + what});
    };
    const auto whole = std::ranges::find(names_, std::string_view(from.whole));
    const auto plain = std::ranges::find(names_, std::string_view(from.header));
    if (whole == names_.end() && plain == names_.end())
      return fault("no column is called '" + from.header + "'");
    if (whole != names_.end() && plain != names_.end() && whole != plain)
      return fault("both '" + from.whole + "' and '" + from.header + "' are columns");
    const auto place =
        static_cast<std::size_t>((whole != names_.end() ? whole : plain) - names_.begin());
    if (taken_[place]) return fault("'" + from.header + "' is taken twice");
    taken_[place] = 1;
    columns_[place].name = column;
    if (from.unit.empty()) return place;
    const auto unit = unit_of(from.unit, dimension);
    if (!unit)
      return fault(dimension == Dimension::none
                       ? "'" + column + "' has no unit, got [" + from.unit + "]"
                       : "expected a unit of " + units_in_words(dimension) + ", got [" + from.unit +
                             "]");
    columns_[place].unit = *unit;
    return place;
  }

  std::optional<RowFault> apply(const ColumnMap& map) {
    for (const MappedColumn& each : map.columns) {
      if (kind_of(each.column, measured_) == CellKind::ignored)
        return RowFault{to_string(each.from.place) + ": data sets have no column '" + each.column +
                        "'"};
      const auto place =
          take(each.from, each.column, dimension_of(each.column, joints_, measured_));
      if (!place) return place.error();
    }
    for (std::size_t i = 0; map.turn && i < turn_.size(); ++i) {
      const auto place =
          take(map.turn->from[i], "orientation " + std::to_string(i + 1), Dimension::angle);
      if (!place) return place.error();
      turn_[i] = *place;
    }
    for (const MappedColumn& each : map.columns)
      for (std::size_t i = 0; i < names_.size(); ++i)
        if (!taken_[i] && names_[i] == each.column)
          return RowFault{to_string(each.from.place) + ": the file has a column '" + each.column +
                          "' of its own"};
    name_joints();
    for (Column& column : columns_) column.kind = kind_of(column.name, measured_);
    for (std::size_t i = 0; map.turn && i < turn_.size(); ++i)
      columns_[turn_[i]].kind = CellKind::number;
    return std::nullopt;
  }

  std::vector<Column>& columns() { return columns_; }
  const std::array<std::size_t, 3>& turn() const { return turn_; }

 private:
  /// A column with a joint's name holds its readings, unless another one does.
  void name_joints() {
    for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
      const std::string reading = "q" + std::to_string(joint + 1);
      if (std::ranges::find(columns_, reading, &Column::name) != columns_.end()) continue;
      if (kind_of(joints_[joint].name, measured_) != CellKind::ignored) continue;
      for (std::size_t i = 0; i < columns_.size(); ++i)
        if (!taken_[i] && columns_[i].name == joints_[joint].name) columns_[i].name = reading;
    }
  }

  Cells names_;
  const std::vector<Joint>& joints_;
  const std::vector<MeasuredColumn>& measured_;
  std::vector<char> taken_;  // by the map
  std::vector<Column> columns_;
  std::array<std::size_t, 3> turn_{};
};

/// How a file is read that has column `name` under another one.
std::string renamed(const std::string& name, const std::string& unit = "") {
  return "; where it has it under another name, dataset.yaml says which: columns: {" + name +
         ": NAME" + unit + "}";
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
    if (!layout.find(name))
      return RowFault{"column '" + name + "' is missing: " + robot_has + "; " +
                      layout.instead_of(name) + renamed(name, " [deg]")};
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
                                 layout.columns[places[0]].name + "' needs it; " +
                                 layout.instead_of(missing)});
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

std::string Layout::instead_of(std::string_view name) const {
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);
  return columns_instead(name, names, ignored());
}

std::optional<std::size_t> Layout::filled_by(std::string_view name) const {
  const bool of_turn = turn && (name == "qw" || name == "qx" || name == "qy" || name == "qz");
  return of_turn ? turn->front() : find(name);
}

tl::expected<Layout, RowFault> read_header(Cells names, const std::vector<Joint>& all_joints,
                                           const std::vector<MeasuredColumn>& measured,
                                           const ColumnMap& map) {
  const auto joints = static_cast<int>(all_joints.size());
  Naming naming(names, all_joints, measured);
  if (auto fault = naming.apply(map)) return tl::unexpected(std::move(*fault));
  Layout layout;
  layout.columns = std::move(naming.columns());
  if (map.turn) {
    layout.turn = naming.turn();
    layout.turn_axes = map.turn->axes;
  }
  const std::optional<std::size_t> set = layout.find("set");
  if (!set && !map.sole_set)
    return tl::unexpected(
        RowFault{"column 'set' is missing, which says of each row what dataset.yaml's `sets` has "
                 "of it; " +
                 layout.instead_of("set") + renamed("set")});
  if (auto fault = check_joint_columns(layout, joints)) return tl::unexpected(std::move(*fault));
  layout.set = set;
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
  if (*orientation && layout.turn)
    return tl::unexpected(RowFault{
        "is a quaternion, and dataset.yaml gives the orientation otherwise", (**orientation)[0]});
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
