#include "io/files/column_map.h"

#include <limits>

namespace selfcal {
namespace {

NamedHeader named_header(const std::string& whole, const std::string& unit, const Place& place) {
  NamedHeader named{whole, whole, unit, place};
  const std::size_t open = whole.rfind('[');
  if (open == std::string::npos || !whole.ends_with(']')) return named;
  named.unit = whole.substr(open + 1, whole.size() - open - 2);
  const std::size_t last = whole.substr(0, open).find_last_not_of(' ');
  named.header = last == std::string::npos ? "" : whole.substr(0, last + 1);
  return named;
}

void read_columns(const Node& node, ColumnMap& map, Problems& problems) {
  if (node.kind != Node::Kind::map) {
    problems.add(node.place, "columns: expected COLUMN: HEADER [UNIT], one a line");
    return;
  }
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const Node& each = node.items[i];
    const NamedHeader from = named_header(each.text, "", each.place);
    if (each.kind != Node::Kind::text || from.header.empty())
      problems.add(each.place,
                   "columns: " + node.keys[i] + ": expected HEADER or \"HEADER [UNIT]\"");
    map.columns.push_back({node.keys[i], from});
  }
}

bool are_axes(const std::string& axes) {
  const bool small = axes.find_first_not_of("xyz") == std::string::npos;
  const bool capital = axes.find_first_not_of("XYZ") == std::string::npos;
  return axes.size() == 3 && (small || capital) && axes[0] != axes[1] && axes[1] != axes[2];
}

void read_turn(const Node& node, ColumnMap& map, Problems& problems) {
  Fields fields(node, "orientation", problems);
  TurnColumns turn;
  const bool vector = fields.has("rotation_vector");
  if (!vector) turn.axes = fields.text("euler");
  const char* key = vector ? "rotation_vector" : "columns";
  const std::vector<std::string> names = fields.texts(key);
  const std::string unit = fields.text("unit", "rad");
  fields.refuse_unknown();
  if (!vector && !are_axes(turn.axes))
    fields.fail("euler",
                "three axes such as zyx (about fixed axes) or ZYX (about axes that turn along)");
  if (names.size() != 3) return fields.fail(key, "three headers");
  for (std::size_t i = 0; i < 3; ++i) turn.from[i] = named_header(names[i], unit, node.place);
  map.turn = turn;
}

/// Two columns of a data set cannot be one column of the file.
void refuse_doubled(const ColumnMap& map, Problems& problems) {
  std::vector<NamedHeader> all;
  for (const MappedColumn& each : map.columns) all.push_back(each.from);
  if (map.turn) all.insert(all.end(), map.turn->from.begin(), map.turn->from.end());
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (all[i].header == all[k].header)
        problems.add(all[i].place, "'" + all[i].header + "' is taken twice, first in line " +
                                       std::to_string(all[k].place.line));
}

}  // namespace

ColumnMap read_column_map(Fields& data_set, Problems& problems) {
  ColumnMap map;
  if (const Node* node = data_set.node("columns")) read_columns(*node, map, problems);
  if (const Node* node = data_set.node("orientation")) read_turn(*node, map, problems);
  map.header = data_set.integer("header", 1, 1, std::numeric_limits<int>::max());
  refuse_doubled(map, problems);
  return map;
}

}  // namespace selfcal
