// Angles that are left. A robot whose links are within the maker's tolerances t points wrongly by
// sqrt(sum t^2 / 3) about each axis before anything is identified; three times as much behind it,
// or of the noise stated, is no geometry. An orientation read as another one is the usual cause:
// the positions are met all the same, for the noise of the angles is estimated, and they cease to
// weigh.
//
// A slip is found without a fit. Of four rows with orientations A, B, C, D the turn A^-1 B C^-1 D
// has an angle that no frame of device and tool changes: robot and instrument must agree in it. A
// quaternion whose parts are one place off is, up to such frames, that of the inverse orientation:
// an orthogonal map of its four parts with determinant -1 is q -> a q* b. The two are one slip
// here. Conventions of three angles are alike where one names the axes in turn as the other does
// (xyz, yzx, zxy): of those the one is told that needs the least turn of device and tool.
#include "constraints/estimation/angles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>

#include "constraints/statistics.h"
#include "kinematics/readable.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

constexpr double kTimes = 3;
constexpr double kLeast =
    10e-3;  ///< rad: less is no slip, where no noise is stated and links are exact
constexpr size_t kMostTurns = 200;
constexpr double kMostTurn = 2 * std::numbers::pi;  ///< rad: beyond it, written angles are degrees
constexpr double kAlike = 1.01;                     ///< readings that leave as much as the best
constexpr double kCollapse = 0.2;  ///< a slip explains the angles that it makes so much smaller

/// About one axis (rad), of a robot as its maker says.
double within_tolerance(const Robot& robot) {
  double squares = 0;
  for (const Parameter& p : robot.parameters())
    if (p.part == Part::link && p.quantity == Quantity::angle) squares += std::pow(p.tolerance, 2);
  return std::sqrt(squares / 3);
}

/// 1 sigma about one axis of the rows of `set`, false rows or not; 0 without rows.
double typical_angle(const std::vector<RowResidual>& rows, int set) {
  std::vector<double> norms;
  int count = 0;
  for (const RowResidual& r : rows)
    if (r.set == set && r.angles > 0) {
      norms.push_back(r.angle / r.factor);
      count = r.angles;
    }
  return norms.empty() ? 0 : median(std::move(norms)) / chi_quantile(count, 0.5);
}

/// A way to read the rows.
struct Reading {
  std::string what = {};
  bool inverse = false;  ///< the orientations are of the world, seen from the tool
  int turned = -1;       ///< joint whose sign is the other one
  /// Convention that the written angles are of; nothing: the given orientations are right.
  std::optional<std::string> axes = {};
  double unit = 1;  ///< of the written angles (rad)
};

/// Every convention of three angles but the one given, which may be of angles in degrees.
std::vector<Reading> conventions(const WrittenTurns& turns) {
  std::vector<Reading> list;
  if (turns.angles.rows() == 0) return list;
  const bool degrees = turns.angles.cwiseAbs().maxCoeff<Eigen::PropagateNumbers>() > kMostTurn;
  std::vector<std::string> all = {""};
  for (const std::string letters : {"xyz", "XYZ"})
    for (const char a : letters)
      for (const char b : letters)
        for (const char c : letters)
          if (a != b && b != c) all.push_back({a, b, c});
  for (const std::string& axes : all) {
    if (axes == turns.axes && !degrees) continue;
    const std::string of = axes.empty() ? "a rotation vector" : "angles of euler: " + axes;
    list.push_back({"the three columns are " + of + (degrees ? " in degrees" : "")});
    list.back().axes = axes;
    if (degrees) list.back().unit = std::numbers::pi / 180;
  }
  return list;
}

/// Rows of one set, four at a time, and how far the robot and the instrument (or nest) turn in
/// them.
class Turns {
 public:
  Turns(const Robot& robot, const Eigen::VectorXd& xi, const DataSet& data, int set)
      : robot_(robot), xi_(xi), data_(data), nest_(data.sets[set].method->group_freedom() > 0) {
    std::vector<int> rows;
    for (int row = 0; row < data.rows.rows(); ++row)
      if (data.rows.set[row] == set) rows.push_back(row);
    for (size_t i = 3; i < rows.size() && turns_.size() < kMostTurns; ++i) {
      const int a = rows[i - 3], b = rows[i - 2];
      if (!nest_)
        turns_.push_back({a, b, rows[i - 1], rows[i]});
      else if (data.rows.group[a] == data.rows.group[b])
        turns_.push_back({a, b, a, a});  // all orientations of a nest are one
    }
  }

  /// Every slip that is looked for.
  std::vector<Reading> slips() const {
    std::vector<Reading> list;
    const bool written = data_.rows.turns.angles.rows() > 0;
    if (!nest_ && !written)
      list.push_back(
          {"the quaternions are read in another order (qx qy qz qw in the columns qw qx qy "
           "qz?) or as inverse ones",
           true});
    if (!nest_) std::ranges::move(conventions(data_.rows.turns), std::back_inserter(list));
    for (size_t j = 0; j < robot_.joints().size(); ++j)
      list.push_back(
          {robot_.joints()[j].name + " is read with the other sign", false, static_cast<int>(j)});
    return list;
  }

  /// Median of the difference of the two.
  double misfit(const Reading& reading) const {
    std::vector<double> off;
    for (const auto& [a, b, c, d] : turns_) {
      const Eigen::Quaterniond robot(pose(a, reading).transpose() * pose(b, reading) *
                                     pose(c, reading).transpose() * pose(d, reading));
      const double seen = nest_ ? 0
                                : angle(read(a, reading).conjugate() * read(b, reading) *
                                        read(c, reading).conjugate() * read(d, reading));
      off.push_back(std::abs(angle(robot) - seen));
    }
    return median(std::move(off));
  }

  /// Median of how far the instrument has the tool turned from where the maker's robot does: the
  /// fitted one was turned to what the wrong reading says.
  double apart(const Reading& reading) const {
    const Eigen::VectorXd nominal = nominal_values(robot_);
    std::vector<double> off;
    for (const auto& [a, b, c, d] : turns_)
      off.push_back(
          angle(Eigen::Quaterniond(locate(robot_, nominal, data_.rows.q.row(d)).R).conjugate() *
                read(d, reading)));
    return median(std::move(off));
  }

 private:
  static double angle(const Eigen::Quaterniond& q) {
    return 2 * std::atan2(q.vec().norm(), std::abs(q.w()));
  }
  Eigen::Quaterniond read(int row, const Reading& reading) const {
    if (reading.axes)
      return Eigen::Quaterniond(
          rotation_of(*reading.axes, reading.unit * data_.rows.turns.angles.row(row).transpose()));
    const auto q = data_.rows.orientation.row(row);
    const Eigen::Quaterniond turn(q[0], q[1], q[2], q[3]);
    return reading.inverse ? turn.conjugate() : turn;
  }
  Eigen::Matrix3d pose(int row, const Reading& reading) const {
    Eigen::VectorXd q = data_.rows.q.row(row);
    if (reading.turned >= 0) q[reading.turned] *= -1;
    return locate(robot_, xi_, q).R;
  }

  const Robot& robot_;
  const Eigen::VectorXd& xi_;
  const DataSet& data_;
  bool nest_;
  std::vector<std::array<int, 4>> turns_;
};

/// Whether the method's angles are those of whole orientations: read as quaternions, or of a nest.
bool turns_whole(const Method& method) {
  return method.group_freedom() > 0 || std::ranges::count(method.columns(), "qw") > 0;
}

/// The slip that explains the angles of `set` best, if one does.
std::string slip_of(const Robot& robot, const DataSet& data, int set, const Eigen::VectorXd& xi,
                    double limit) {
  const Turns turns(robot, xi, data, set);
  const std::vector<Reading> slips = turns.slips();
  std::vector<double> misfits;
  for (const Reading& slip : slips) misfits.push_back(turns.misfit(slip));
  const double least = *std::ranges::min_element(misfits);
  if (least < std::min(kTimes * limit, kCollapse * turns.misfit({}))) {
    std::string found;
    double nearest = HUGE_VAL;
    for (size_t i = 0; i < slips.size(); ++i) {
      const double apart = misfits[i] < kAlike * least ? turns.apart(slips[i]) : HUGE_VAL;
      if (apart < nearest) found = slips[i].what;
      nearest = std::min(apart, nearest);
    }
    return "they fit where " + found;
  }
  return "check how the orientation is written, the signs and zeros of the joints and how the tool "
         "is "
         "turned; an instrument as coarse as "
         "this needs its noise_angle stated";
}

}  // namespace

std::vector<std::string> gross_angles(const Robot& robot, const DataSet& data, const Judged& before,
                                      const Judged& after) {
  std::vector<std::string> list;
  for (int s = 0; s < static_cast<int>(data.sets.size()); ++s) {
    const Set& set = data.sets[s];
    if (!set.method->has_angles()) continue;
    const double checked = typical_angle(after.check, s);
    const double left = checked > 0 ? checked : typical_angle(after.fit, s);
    const double limit =
        std::max(kLeast, kTimes * std::max(set.noise_angle, within_tolerance(robot)));
    if (!(left > limit)) continue;
    list.push_back(
        "the angles of set " + set.name +
        with_figures(" are left %.3g mrad off about each axis, where noise and tolerances leave "
                     "less than %.2g: ",
                     1e3 * left, 1e3 * limit) +
        (turns_whole(*set.method) ? slip_of(robot, data, s, before.state.xi, limit)
                                  : "check the signs and zeros of the readings"));
  }
  return list;
}

}  // namespace selfcal
