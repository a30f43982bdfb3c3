// Rows of a data set, column by column. Row i here is row i + 1 of the file (the header not
// counted).
#pragma once

#include <Eigen/Dense>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "kinematics/robot.h"

namespace selfcal {

/// s, between immediate repeats at most; 10 to 600 [physics]
inline constexpr double kAtOnce = 60;

/// Of Observations::check: the row says what another one says in every digit.
inline constexpr char kCopy = 2;

/// How a file wrote the orientations, where it did by three angles. `axes`: three letters of x, y
/// and z, small ones for turns about the fixed axes (extrinsic), capitals for turns about the axes
/// that turn along (intrinsic), the first turn first; empty for a rotation vector.
struct WrittenTurns {
  std::string axes = {};
  Eigen::MatrixXd angles = {};  ///< rows x 3 (rad); no rows: by quaternions
};

/// A measurement's columns. A column that the file lacks has no rows; an empty cell is NaN, and the
/// reader has made sure that the cells a row's method needs are there and finite.
struct Observations {
  Eigen::MatrixXd q;             ///< rows x joints, readings (rad or m)
  Eigen::MatrixXd position;      ///< rows x 3, x y z (m)
  Eigen::MatrixXd orientation;   ///< rows x 4, qw qx qy qz, unit
  WrittenTurns turns;            ///< what the orientations were made of
  Eigen::MatrixXd normal;        ///< rows x 3, outward normal of the touched surface, world, unit
  Eigen::MatrixXd wrench;        ///< rows x 6, on the tool at the last frame's origin, in its axes
  Eigen::MatrixXd velocity;      ///< rows x joints, just before the reading (rad/s, m/s)
  Eigen::VectorXd temperature;   ///< rows (C)
  Eigen::VectorXd time;          ///< rows (s)
  Eigen::VectorXd noise_factor;  ///< rows, a row's noise over its set's, at least 1
  std::vector<int> set;          ///< rows, index into the data set's sets
  std::vector<int> group;        ///< rows, index into its set's group names; -1 without a group
  std::vector<int> repeat;  ///< rows, equal for immediate repeats; -1 without; empty when no column
  std::vector<char> check;  ///< rows, 1 for rows kept aside to judge; kCopy: takes no part at all
  /// By their names, the columns of one number a row that methods bring along (Method::measures).
  std::map<std::string, Eigen::VectorXd, std::less<>> measured;

  int rows() const { return static_cast<int>(q.rows()); }
  double factor(int row) const { return noise_factor.rows() > 0 ? noise_factor[row] : 1; }
  /// A column of `measured`: to write into, it must be there; to read from, it is empty otherwise.
  Eigen::VectorXd& column(std::string_view name) { return measured.find(name)->second; }
  const Eigen::VectorXd& column(std::string_view name) const;
};

/// The given rows, in their order; one may come several times.
Observations taken(const Observations& data, const std::vector<int>& rows);

/// The rows of `a`, then those of `b`, of as many joints. In a column that one of them lacks its
/// cells are NaN, -1 of a repeat, 1 of a noise factor; what both lack is lacking.
Observations joined(const Observations& a, const Observations& b);

/// Times, and temperatures, that few rows next to each other lack are those between their
/// neighbours'. Where more lack their times none of the rows has one, and where more lack their
/// temperatures they stay without (NaN). What a thermometer says that is not read is none.
/// What was done, in words.
std::vector<std::string> fill_gaps(Observations& rows);

/// The rows, the first taken first: by their times where all have one, by their order otherwise.
std::vector<int> in_time(const Observations& rows);

/// By row, the number of its configuration, the first taken first: rows of one set and `repeat` are
/// of one, any other row is alone.
std::vector<int> configurations(const Observations& rows);

/// What else held when `rows` were taken, a lane each.
MeasurementConditions conditions(const Observations& data, const std::vector<int>& rows);

}  // namespace selfcal
