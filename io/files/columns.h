// Which column of an observations file means what.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "constraints/methods/method.h"
#include "io/files/column_map.h"
#include "io/files/csv.h"
#include "io/files/units.h"

namespace selfcal {

/// How the cells of a column are read.
enum class CellKind {
  ignored,
  text,
  number,    ///< finite, or empty
  metres,    ///< a number that is a place in a workshop
  distance,  ///< the same, never negative
  celsius,   ///< a number that is a temperature of a robot at work
};

/// K of a joint's column PREFIXk ("q3", "dq3").
std::optional<int> joint_of(std::string_view name, std::string_view prefix);
/// Of a column by its name in data sets; `measured` are those that methods bring along.
CellKind kind_of(std::string_view name, const std::vector<MeasuredColumn>& measured);
/// What its numbers measure.
Dimension dimension_of(std::string_view name, const std::vector<Joint>& joints,
                       const std::vector<MeasuredColumn>& measured);

struct Column {
  std::string name;  ///< as data sets have it
  CellKind kind = CellKind::ignored;
  Unit unit = {};
};

/// Places, from 0, of columns that belong together: all of them or none.
template <std::size_t N>
using Columns = std::optional<std::array<std::size_t, N>>;

/// The columns of one file. A column that the file lacks is nothing; `q` has one place a joint.
struct Layout {
  std::vector<Column> columns;
  std::optional<std::size_t> set;  ///< nothing: all rows are of the only one
  std::vector<std::size_t> q;
  std::vector<std::size_t> dq;  ///< one place a joint, or none at all
  std::optional<std::size_t> group, repeat, part, temperature, time;
  std::optional<std::size_t> noise_factor;
  Columns<3> position, normal;
  Columns<6> wrench;
  Columns<4> orientation;
  Columns<3> turn;                    ///< in place of the orientation
  std::string turn_axes;              ///< as TurnColumns has them
  char separator = ',';               ///< what parts the cells
  std::vector<std::size_t> measured;  ///< places of the columns that methods bring along

  std::optional<std::size_t> find(std::string_view name) const;
  /// The same, or the first of the columns that stand for a quaternion's.
  std::optional<std::size_t> filled_by(std::string_view name) const;
  /// Names of the columns that no format knows, in the order of the file.
  std::vector<std::string> ignored() const;
  /// What there is in place of a column that is missing, in words.
  std::string instead_of(std::string_view name) const;
};

/// Reads the header of a file for a robot's `joints`, which are found by their names, too.
/// `measured` are the columns that the methods of its sets bring along. Refuses what `map` names
/// and the file lacks or has twice, a file without `set` or a joint's reading, with
/// readings of more joints, or with part of a vector.
tl::expected<Layout, RowFault> read_header(Cells names, const std::vector<Joint>& joints,
                                           const std::vector<MeasuredColumn>& measured,
                                           const ColumnMap& map);

}  // namespace selfcal
