// Which column of an observations file means what.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "constraints/methods/method.h"
#include "io/files/csv.h"

namespace selfcal {

/// How the cells of a column are read.
enum class CellKind {
  ignored,
  text,
  number,    ///< finite, or empty
  metres,    ///< a number that is a place in a workshop
  distance,  ///< the same, never negative
};

struct Column {
  std::string name;
  CellKind kind = CellKind::ignored;
};

/// Places, from 0, of columns that belong together: all of them or none.
template <std::size_t N>
using Columns = std::optional<std::array<std::size_t, N>>;

/// The columns of one file. A column that the file lacks is nothing; `q` has one place a joint.
struct Layout {
  std::vector<Column> columns;
  std::size_t set = 0;
  std::vector<std::size_t> q;
  std::vector<std::size_t> dq;  ///< one place a joint, or none at all
  std::optional<std::size_t> group, repeat, part, temperature, time;
  std::optional<std::size_t> noise_factor;
  Columns<3> position, normal;
  Columns<6> wrench;
  Columns<4> orientation;
  std::vector<std::size_t> measured;  ///< places of the columns that methods bring along

  std::optional<std::size_t> find(std::string_view name) const;
  /// Names of the columns that no format knows, in the order of the file.
  std::vector<std::string> ignored() const;
};

/// Reads the header of a file for a robot of `joints` joints. `measured` are the columns that the
/// methods of its sets bring along. Refuses a file without `set` or a joint's reading, with
/// readings of more joints, or with part of a vector.
tl::expected<Layout, RowFault> read_header(Cells names, int joints,
                                           const std::vector<MeasuredColumn>& measured);

}  // namespace selfcal
