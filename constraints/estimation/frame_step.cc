// With p the body's place and r the way from it to where the row has it, rows in their order:
//   r_i = a + A x (p_i - c) + [i >= k] (b + B x (p_i - c))
// which is a rigid motion fitted to the rows before k and another to those after.
#include "constraints/estimation/frame_step.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kinematics/linear_algebra.h"
#include "kinematics/readable.h"
#include "kinematics/rotation.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Motion = Eigen::Matrix<double, 3, 6>;  ///< what a rigid motion moves a point by

constexpr double kShare = 0.4;     ///< of the squares that calibration leaves, explained by it
constexpr double kPlainly = 0.8;   ///< of the squares that another explanation leaves, at most left
constexpr double kSharp = 0.6;     ///< of the step, that comes from the rows before to those after
constexpr int kBeside = 10;        ///< rows on either side that must show it
constexpr int kMostSplits = 500;   ///< tried of a long set
constexpr int kMostPlaced = 1000;  ///< rows at which another explanation is tried
constexpr double kAsMuch = 0.97;   ///< of the squares explained: another explains as much
constexpr double kDifference = 1e-5;  ///< units of a reading, for derivatives
constexpr double kRegular = 1e-12;    ///< of its squares, that regularises a motion

/// Least squares of a rigid motion over some rows: normal equations that add up.
struct MotionSums {
  Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
  Vector6d b = Vector6d::Zero();
  double squares = 0;

  void add(const Motion& J, const Vector3d& way) {
    A += J.transpose() * J;
    b += J.transpose() * way;
    squares += way.squaredNorm();
  }
  MotionSums operator-(const MotionSums& other) const {
    return {A - other.A, b - other.b, squares - other.squares};
  }
  Vector6d motion() const {
    Eigen::Matrix<double, 6, 6> regular = A;
    regular.diagonal() *= 1 + kRegular;
    return regular.ldlt().solve(b);
  }
  double left() const { return std::max(0.0, squares - b.dot(motion())); }
};

bool gives_positions(const Set& set) {
  const std::vector<Quantity> equations = set.method->equations();
  return set.method->touches() == TouchedSurface::none && !set.method->paired() &&
         std::ranges::count(equations, Quantity::length) == 3;
}

/// Rows of a set in the order in which they were taken, without those put aside; `figures` are in
/// that of the file.
std::vector<const RowFigure*> rows_of_set(const DataSet& data,
                                          const std::vector<RowFigure>& figures, int set) {
  std::vector<const RowFigure*> rows;
  for (const RowFigure& each : figures)
    if (each.set == set && !each.outlier && each.way_after.allFinite() && each.at.allFinite())
      rows.push_back(&each);
  if (data.rows.time.rows() > 0)
    std::ranges::stable_sort(rows, {},
                             [&](const RowFigure* each) { return data.rows.time[each->row]; });
  return rows;
}

Motion motion_of(const Vector3d& from_middle) {
  Motion J;
  J << Matrix3d::Identity(), -skew(from_middle);
  return J;
}

struct Split {
  std::size_t at = 0;  ///< the first row after it
  double left = 0;     ///< squares
  Vector6d before, step;
};

class SetSteps {
 public:
  explicit SetSteps(std::vector<const RowFigure*> rows) : rows_(std::move(rows)) {
    for (const RowFigure* each : rows_) middle_ += each->at / static_cast<double>(rows_.size());
    for (const RowFigure* each : rows_) all_.add(motion_of(each->at - middle_), each->way_after);
  }

  double without() const { return all_.left(); }

  /// Of every so many splits, then of those beside the best of them.
  Split best() const {
    const std::size_t fewest = kFewestBesideStep, last = rows_.size() - fewest;
    const std::size_t stride = 1 + (last - fewest) / kMostSplits;
    const std::size_t near = best_of(fewest, last, stride).at;
    return best_of(std::max(fewest, near - std::min(near, stride)), std::min(last, near + stride),
                   1);
  }

  /// Share of the step that the rows right after it show and those right before it do not.
  double sharpness(const Split& split) const {
    return shown(split, split.at, split.at + kBeside) - shown(split, split.at - kBeside, split.at);
  }

  /// Least squares that are left when, in place of the frame, the tool shifts at the same row, or
  /// the zero of one joint does.
  double left_otherwise(const Split& split, const Robot& robot, const Eigen::VectorXd& xi,
                        const DataSet& data, int set) const {
    const auto joints = static_cast<Eigen::Index>(robot.joints().size());
    const std::size_t stride = 1 + rows_.size() / kMostPlaced;
    std::vector<std::size_t> some;
    for (std::size_t i = 0; i < rows_.size(); i += stride) some.push_back(i);
    // Columns: the rigid motion of all, then what each alternative moves the rows by. The point
    // that is seen may lie anywhere in the body.
    const Body body = data.sets[static_cast<std::size_t>(set)].method->body();
    const Eigen::ArrayXd units = units_of_readings(robot);
    Eigen::MatrixXd rigid(3 * some.size(), 6), turn(3 * some.size(), 3),
        readings(3 * some.size(), 4 * joints);
    Eigen::VectorXd ways(3 * some.size());
    Eigen::VectorXd after(3 * some.size());
    for (std::size_t s = 0; s < some.size(); ++s) {
      const RowFigure& row = *rows_[some[s]];
      const auto at = static_cast<Eigen::Index>(3 * s);
      const Eigen::VectorXd q = data.rows.q.row(row.row).transpose();
      rigid.middleRows<3>(at) = motion_of(row.at - middle_);
      turn.middleRows<3>(at) = locate(robot, xi, q, body).R;
      for (Eigen::Index j = 0; j < joints; ++j) {
        Eigen::VectorXd more = q, less = q;
        const double h = kDifference * units[j];
        more[j] += h;
        less[j] -= h;
        const Location up = locate(robot, xi, more, body), down = locate(robot, xi, less, body);
        readings.block<3, 4>(at, 4 * j) << (up.p - down.p) / (2 * h), (up.R - down.R) / (2 * h);
      }
      ways.segment<3>(at) = row.way_after;
      after.segment<3>(at).setConstant(some[s] >= split.at ? 1 : 0);
    }
    const auto left = [&](const Eigen::MatrixXd& columns) {
      Eigen::MatrixXd all(ways.size(), 6 + 2 * columns.cols());
      all << rigid, columns, after.asDiagonal() * columns;
      const Eigen::VectorXd by = least_squares(all, ways);
      return (ways - all * by).squaredNorm();
    };
    double least = left(turn);
    for (Eigen::Index j = 0; j < joints; ++j)
      least = std::min(least, left(readings.middleCols(4 * j, 4)));
    return least * static_cast<double>(stride);
  }

  int row(std::size_t i) const { return rows_[i]->row; }

 private:
  Split best_of(std::size_t first, std::size_t last, std::size_t stride) const {
    Split best{0, HUGE_VAL, {}, {}};
    MotionSums before;
    for (std::size_t at = 0; at <= last; ++at) {
      if (at >= first && (at - first) % stride == 0) {
        const MotionSums after = all_ - before;
        if (const double left = before.left() + after.left(); left < best.left)
          best = {at, left, before.motion(), after.motion() - before.motion()};
      }
      before.add(motion_of(rows_[at]->at - middle_), rows_[at]->way_after);
    }
    return best;
  }

  double shown(const Split& split, std::size_t from, std::size_t to) const {
    double along = 0, squares = 0;
    for (std::size_t i = from; i < to; ++i) {
      const Motion J = motion_of(rows_[i]->at - middle_);
      const Vector3d step = J * split.step;
      along += step.dot(rows_[i]->way_after - J * split.before);
      squares += step.squaredNorm();
    }
    return squares > 0 ? along / squares : 0;
  }

  std::vector<const RowFigure*> rows_;
  Vector3d middle_ = Vector3d::Zero();
  MotionSums all_;
};

std::optional<FrameStep> step_of_set(const Robot& robot, const Eigen::VectorXd& xi,
                                     const DataSet& data, const std::vector<RowFigure>& figures,
                                     int set) {
  std::vector<const RowFigure*> rows = rows_of_set(data, figures, set);
  if (rows.size() < 2 * kFewestBesideStep) return std::nullopt;
  const SetSteps steps(std::move(rows));
  const double without = steps.without();
  const Split split = steps.best();
  if (!(split.left < (1 - kShare) * without) || steps.sharpness(split) < kSharp)
    return std::nullopt;
  const double otherwise = steps.left_otherwise(split, robot, xi, data, set);
  if (split.left > kPlainly * otherwise || without - otherwise > kAsMuch * (without - split.left))
    return std::nullopt;
  return FrameStep{data.sets[static_cast<std::size_t>(set)].name,
                   steps.row(split.at - 1),
                   steps.row(split.at),
                   split.step.head<3>().norm(),
                   split.step.tail<3>().norm(),
                   1 - split.left / without};
}

}  // namespace

std::vector<FrameStep> frame_steps(const Robot& robot, const Eigen::VectorXd& xi,
                                   const DataSet& data, const std::vector<RowFigure>& rows) {
  std::vector<FrameStep> steps;
  for (int s = 0; s < static_cast<int>(data.sets.size()); ++s)
    if (gives_positions(data.sets[static_cast<std::size_t>(s)]))
      if (auto step = step_of_set(robot, xi, data, rows, s)) steps.push_back(*std::move(step));
  return steps;
}

std::string step_words(const FrameStep& step) {
  return "between rows " + std::to_string(step.before + 1) + " and " +
         std::to_string(step.after + 1) + " the instrument of set " + step.set +
         " or the robot's base was moved, by " + in_readable_unit(step.shift, "m") + " and " +
         in_readable_unit(step.turn, "rad") + " (that alone explains " +
         with_figures("%.0f %%", 100 * step.share) +
         " of the squares that calibration leaves): give the rows before and after it as two sets";
}

}  // namespace selfcal
