// How a file that another program wrote is read as a data set's: the keys `columns`, `orientation`
// and `header` of dataset.yaml.
#pragma once

#include <Eigen/Dense>
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

/// Three columns that say how the tool is turned. `axes`: three letters of x, y and z, small ones
/// for turns about the fixed axes (extrinsic), capitals for turns about the axes that turn along
/// (intrinsic), the first turn first; empty for a rotation vector.
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

/// The rotation that three angles (rad) say in the order of `axes`, as TurnColumns has them: of
/// small letters R = R(axis 3) R(axis 2) R(axis 1), of capitals R = R(axis 1) R(axis 2) R(axis 3),
/// of none the exponential of the vector.
Eigen::Matrix3d rotation_of(const std::string& axes, const Eigen::Vector3d& angles);

}  // namespace selfcal
