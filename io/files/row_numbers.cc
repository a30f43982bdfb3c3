// Text to numbers, each column by its kind; the rules of plausibility are in plausible.cc.
#include "io/files/row_numbers.h"

#include <cmath>
#include <limits>

#include "io/files/plausible.h"
#include "kinematics/readable.h"
#include "kinematics/rotation.h"

namespace selfcal {

void NumberReader::begin(const Layout& layout) {
  layout_ = &layout;
  values_.resize(layout.columns.size());
  numbers_.begin(layout.separator);
}

std::optional<RowFault> NumberReader::read(Cells cells, int row) {
  if (auto fault = read_cells(cells)) return fault;
  if (auto fault = check_joints(row)) return fault;
  return read_vectors();
}

std::optional<RowFault> NumberReader::read_cells(Cells cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const CellKind kind = layout_->columns[i].kind;
    values_[i] = std::numeric_limits<double>::quiet_NaN();
    if (kind == CellKind::ignored || kind == CellKind::text || cells[i].empty()) continue;
    const auto number = numbers_.read(cells[i]);
    if (!number) return RowFault{number.error(), i};
    const Unit& unit = layout_->columns[i].unit;
    values_[i] = *number * unit.factor + unit.offset;
    if (kind == CellKind::number) continue;
    if (kind == CellKind::celsius) {
      if (auto fault = celsius_fault(values_[i])) return RowFault{std::move(*fault), i};
      continue;
    }
    if (auto fault = metres_fault(values_[i])) return RowFault{std::move(*fault), i};
    if (kind == CellKind::distance && values_[i] < 0)
      return RowFault{"a distance is never negative", i};
  }
  return std::nullopt;
}

std::optional<RowFault> NumberReader::check_joints(int row) {
  for (std::size_t i = 0; i < layout_->q.size(); ++i) {
    const std::size_t column = layout_->q[i];
    const Joint& joint = robot_.joints()[i];
    if (std::isnan(values_[column])) return RowFault{"expected a number, got nothing", column};
    if (auto fault = joint_fault(joint, values_[column], readings_)) {
      return RowFault{std::move(*fault), column};
    }
    if (!outside_limits(joint, values_[column])) continue;
    if (outside_++ > 0) continue;
    first_outside_ = joint.name + " at " + plain_figure(values_[column], 4) + " " +
                     std::string(unit(joint.quantity)) + " in row " + std::to_string(row);
  }
  return std::nullopt;
}

std::optional<RowFault> NumberReader::read_vectors() {
  if (auto fault = read_vector(layout_->position, position_)) return fault;
  if (auto fault = read_vector(layout_->normal, normal_)) return fault;
  if (auto fault = read_vector(layout_->orientation, orientation_)) return fault;
  if (auto fault = read_turn()) return fault;
  if (auto fault = read_vector(layout_->wrench, wrench_)) return fault;
  std::optional<std::string> fault;
  if (layout_->normal && !std::isnan(normal_[0])) {
    fault = make_unit(normal_, kNormalTolerance, "the normal nx ny nz");
  }
  if (!fault && layout_->orientation && !std::isnan(orientation_[0])) {
    fault = make_unit(orientation_, kQuaternionTolerance, "the quaternion qw qx qy qz");
  }
  if (fault) return RowFault{std::move(*fault)};
  return std::nullopt;
}

std::optional<RowFault> NumberReader::read_turn() {
  if (!layout_->turn) return std::nullopt;
  if (auto fault = read_vector(layout_->turn, turn_)) return fault;
  orientation_.fill(turn_[0]);
  if (std::isnan(turn_[0])) return std::nullopt;
  const Eigen::Quaterniond turn(
      rotation_of(layout_->turn_axes, Eigen::Vector3d(turn_[0], turn_[1], turn_[2])));
  orientation_ = {turn.w(), turn.x(), turn.y(), turn.z()};
  return std::nullopt;
}

/// Copies the values of columns that must be filled together or not at all.
template <std::size_t N>
std::optional<RowFault> NumberReader::read_vector(const Columns<N>& places,
                                                  std::array<double, N>& vector) {
  if (!places) return std::nullopt;
  std::size_t empty = 0, last_empty = 0;
  for (std::size_t k = 0; k < N; ++k) {
    vector[k] = values_[(*places)[k]];
    if (!std::isnan(vector[k])) continue;
    ++empty;
    last_empty = (*places)[k];
  }
  if (empty == 0 || empty == N) return std::nullopt;
  return RowFault{"is empty, while others of its vector are not", last_empty};
}

std::optional<std::string> NumberReader::outside_limits_notice() const {
  if (outside_ == 0) return std::nullopt;
  return std::to_string(outside_) +
         (outside_ == 1 ? " joint reading is outside its limits: "
                        : " joint readings are outside their limits, the first: ") +
         first_outside_;
}

}  // namespace selfcal
