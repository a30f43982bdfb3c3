// How a file that another program wrote is read as a data set's: the keys `columns`, `orientation`
// and `header` of dataset.yaml.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kinematics/description.h"

namespace selfcal {

/// HEADER [UNIT] as a person writes it.
struct NamedHeader {
  std::string whole;   ///< as written: the file's header may have its unit in its name
  std::string header;  ///< without the unit
  std::string unit;    ///< empty where none is given
  Place place;
};

/// A column of a data set and where the file has it.
struct MappedColumn {
  std::string column;
  NamedHeader from;
};

/// Three columns that say how the tool is turned; `axes` as WrittenTurns has them.
struct TurnColumns {
  std::string axes;
  std::array<NamedHeader, 3> from;
};

struct ColumnMap {
  std::vector<MappedColumn> columns;
  std::optional<TurnColumns> turn;
  int header = 1;         ///< line of the file, from 1, that holds the names of its columns
  bool sole_set = false;  ///< a file without the column `set` has rows of the only one

  /// dataset.yaml says anything of the file's form.
  bool any() const { return !columns.empty() || turn || header > 1; }
};

/// Reads the three keys. Refuses a header that two columns are taken from, and axes that are none.
ColumnMap read_column_map(Fields& data_set, Problems& problems);

}  // namespace selfcal
