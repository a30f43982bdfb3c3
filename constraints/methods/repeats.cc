// A row is compared with the first rows of the configurations before it, of its set, group and
// part, whose readings are about as large along two directions: a grid of cells twice as wide as
// two such rows are apart at most, so that those about a place lie in four of them.
#include "constraints/methods/repeats.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr double kSamePlace = 1e-3;          ///< units of readings; 1e-4 to 3e-3 [physics]
constexpr std::size_t kFewestRevisits = 10;  ///< rows; 5 to 50 [habit]
constexpr double kSameLoad = 0.02;           ///< of the largest load; 0 to 0.1 [physics]
/// N and N m that a sensor without load reads; 0.1 to 5, 0.01 to 0.5 [physics]
constexpr double kLeastForce = 1, kLeastMoment = 0.1;
constexpr double kSameWarmth = 0.5;  ///< K; 0.1 to 2 [physics]

class Visited {
 public:
  Visited(const Robot& robot, const Observations& rows)
      : rows_(rows), readings_(rows.q * units_of_readings(robot).inverse().matrix().asDiagonal()) {
    const Eigen::Index joints = rows.q.cols();
    along_.resize(joints, 2);
    for (Eigen::Index j = 0; j < joints; ++j) {
      const double angle = static_cast<double>(j) * std::numbers::pi * std::numbers::phi;
      along_.row(j) << std::cos(angle), std::sin(angle);
    }
    width_ = kSamePlace * std::sqrt(static_cast<double>(joints)) *
             std::max(along_.col(0).norm(), along_.col(1).norm()) * 2;
    cells_.reserve(static_cast<size_t>(rows.rows()));
    if (rows.wrench.rows() == 0) return;
    const Eigen::MatrixXd loads = rows.wrench.array().isNaN().select(0, rows.wrench);
    least_load_ << std::max(kLeastForce, kSameLoad * loads.leftCols(3).rowwise().norm().maxCoeff()),
        std::max(kLeastMoment, kSameLoad * loads.rightCols(3).rowwise().norm().maxCoeff());
  }

  /// The first row of the configuration that `row` stands at; itself where it is the first.
  int first_there(int row) {
    const Eigen::RowVector2d at = readings_.row(row) * along_ / width_;
    // The cell that it lies in and those that it is nearest to.
    const auto x = static_cast<std::int64_t>(std::floor(at.x() - 0.5)),
               y = static_cast<std::int64_t>(std::floor(at.y() - 0.5));
    for (std::int64_t dx = 0; dx < 2; ++dx)
      for (std::int64_t dy = 0; dy < 2; ++dy) {
        const auto found = cells_.find(key(row, x + dx, y + dy));
        if (found == cells_.end()) continue;
        for (const int first : found->second)
          if (same(first, row)) return first;
      }
    cells_[key(row, static_cast<std::int64_t>(std::floor(at.x())),
               static_cast<std::int64_t>(std::floor(at.y())))]
        .push_back(row);
    return row;
  }

 private:
  std::uint64_t key(int row, std::int64_t x, std::int64_t y) const {
    std::uint64_t hash = 0;
    for (const std::int64_t part :
         {x, y, static_cast<std::int64_t>(rows_.set[row]),
          static_cast<std::int64_t>(rows_.group[row]), static_cast<std::int64_t>(rows_.check[row])})
      hash = (hash ^ static_cast<std::uint64_t>(part)) * 0x9E3779B97F4A7C15u;
    return hash;
  }

  bool same(int a, int b) const {
    return rows_.set[a] == rows_.set[b] && rows_.group[a] == rows_.group[b] &&
           rows_.check[a] == rows_.check[b] &&
           (readings_.row(a) - readings_.row(b)).cwiseAbs().maxCoeff() <= kSamePlace &&
           from_the_same_side(a, b) && as_much_loaded(a, b) && as_warm(a, b);
  }

  bool from_the_same_side(int a, int b) const {
    if (rows_.velocity.rows() == 0) return true;
    for (Eigen::Index j = 0; j < rows_.velocity.cols(); ++j) {
      const double u = rows_.velocity(a, j), v = rows_.velocity(b, j);
      if (std::isnan(u) != std::isnan(v) || u * v < 0 || (u == 0) != (v == 0)) return false;
    }
    return true;
  }

  bool as_much_loaded(int a, int b) const {
    if (rows_.wrench.rows() == 0) return true;
    if (!rows_.wrench.row(a).allFinite() || !rows_.wrench.row(b).allFinite())
      return !rows_.wrench.row(a).allFinite() && !rows_.wrench.row(b).allFinite();
    const Eigen::RowVectorXd apart = rows_.wrench.row(a) - rows_.wrench.row(b);
    return apart.head(3).norm() <= least_load_[0] && apart.tail(3).norm() <= least_load_[1];
  }

  bool as_warm(int a, int b) const {
    return rows_.temperature.size() == 0 ||
           !(std::abs(rows_.temperature[a] - rows_.temperature[b]) > kSameWarmth);
  }

  const Observations& rows_;
  const Eigen::MatrixXd readings_;  ///< rows x joints, in their units
  Eigen::MatrixX2d along_;          ///< joints x 2 directions
  double width_ = 1;
  Eigen::Array2d least_load_ = {0, 0};  ///< N, N m, of loads that differ
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

/// A row of a method that measures from one row to the next, or a copy, is none's repeat.
bool may_repeat(const DataSet& data, int row) {
  return !data.sets[data.rows.set[row]].method->paired() && data.rows.check[row] != kCopy;
}

/// By row, the number of its configuration; -1 where no other row stands there.
std::vector<int> revisits(const Robot& robot, const DataSet& data) {
  std::vector<int> configuration(static_cast<size_t>(data.rows.rows()), -1);
  Visited visited(robot, data.rows);
  int count = 0;
  for (const int row : in_time(data.rows)) {
    if (!may_repeat(data, row)) continue;
    const int first = visited.first_there(row);
    if (first == row) continue;
    if (configuration[first] < 0) configuration[first] = count++;
    configuration[row] = configuration[first];
  }
  return configuration;
}

/// It has the readings and the load of the row before in every digit.
bool repeats_row_before(const Observations& rows, int row) {
  if (row == 0) return false;
  const int before = row - 1;
  const auto alike = [](const auto& a, const auto& b) {
    return ((a == b) || (a.isNaN() && b.isNaN())).all();
  };
  const auto same = [&](const Eigen::MatrixXd& column) {
    return column.rows() == 0 || alike(column.row(row).array(), column.row(before).array());
  };
  const bool later = rows.time.size() > 0 && std::abs(rows.time[row] - rows.time[before]) > kAtOnce;
  return !later && rows.set[row] == rows.set[before] && rows.group[row] == rows.group[before] &&
         rows.check[row] == rows.check[before] && same(rows.q) && same(rows.wrench) &&
         (rows.velocity.rows() == 0 ||
          alike(rows.velocity.row(row).array().sign(), rows.velocity.row(before).array().sign()));
}

/// By row, the number of its configuration; -1 where neither neighbour repeats it.
std::vector<int> at_readings_before(const DataSet& data) {
  std::vector<int> repeat(static_cast<std::size_t>(data.rows.rows()), -1);
  int labels = 0;
  for (int row = 1; row < data.rows.rows(); ++row) {
    if (!may_repeat(data, row) || !repeats_row_before(data.rows, row)) continue;
    if (repeat[row - 1] < 0) repeat[row - 1] = labels++;
    repeat[row] = repeat[row - 1];
  }
  return repeat;
}

/// The rows that are not the first of their configuration, in their order.
std::vector<int> later_ones(const std::vector<int>& repeat) {
  std::unordered_set<int> seen;
  std::vector<int> rows;
  for (std::size_t row = 0; row < repeat.size(); ++row)
    if (repeat[row] >= 0 && !seen.insert(repeat[row]).second) rows.push_back(static_cast<int>(row));
  return rows;
}

}  // namespace

std::optional<std::string> label_repeats(const Robot& robot, DataSet& data) {
  Observations& rows = data.rows;
  if (!rows.repeat.empty()) return std::nullopt;
  std::vector<int> repeat = revisits(robot, data);
  std::vector<int> later = later_ones(repeat);
  const bool again = later.size() >= kFewestRevisits;
  if (!again) {
    repeat = at_readings_before(data);
    later = later_ones(repeat);
  }
  if (later.empty()) return std::nullopt;
  rows.repeat = std::move(repeat);
  const std::string which = ", first row " + std::to_string(later.front() + 1);
  if (again)
    return std::to_string(later.size()) +
           " rows stand within a thousandth of a radian (of half its way, of a joint that slides) "
           "of an earlier one" +
           which + ": taken as its repeats";
  return std::to_string(later.size()) +
         (later.size() > 1 ? " rows have the readings of the row before"
                           : " row has the readings of the row before") +
         which + ": taken as its immediate repeats";
}

}  // namespace selfcal
