// The cells of a row that are numbers, and the vectors that some of them form.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/cell_numbers.h"
#include "io/files/columns.h"
#include "io/files/csv.h"
#include "io/files/plausible.h"
#include "kinematics/robot.h"

namespace selfcal {

/// Reads and judges the numbers of one row after the other, over and over in the same memory.
class NumberReader {
 public:
  NumberReader(const Robot& robot, Readings readings) : robot_(robot), readings_(readings) {}

  /// `layout` must outlive the reader.
  void begin(const Layout& layout);
  std::optional<RowFault> read(Cells cells, int row);

  /// Of the row read last; NaN where a cell is empty or no number's.
  double value(std::size_t column) const { return values_[column]; }
  const std::array<double, 3>& position() const { return position_; }
  const std::array<double, 3>& normal() const { return normal_; }  ///< unit
  const std::array<double, 6>& wrench() const { return wrench_; }
  const std::array<double, 4>& orientation() const { return orientation_; }  ///< unit
  const std::array<double, 3>& turn() const { return turn_; }                ///< rad

  /// How many readings were a little outside their joint's limits and where the first one was.
  std::optional<std::string> outside_limits_notice() const;

 private:
  std::optional<RowFault> read_cells(Cells cells);
  std::optional<RowFault> check_joints(int row);
  std::optional<RowFault> read_vectors();
  std::optional<RowFault> read_turn();
  template <std::size_t N>
  std::optional<RowFault> read_vector(const Columns<N>& places, std::array<double, N>& vector);

  const Robot& robot_;
  Readings readings_;
  const Layout* layout_ = nullptr;
  CellNumbers numbers_;
  std::vector<double> values_;  // per column
  std::array<double, 3> position_{}, normal_{}, turn_{};
  std::array<double, 4> orientation_{};
  std::array<double, 6> wrench_{};
  int outside_ = 0;
  std::string first_outside_;
};

}  // namespace selfcal
