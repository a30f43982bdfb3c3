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
// here.
#include "constraints/estimation/angles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "constraints/statistics.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

constexpr double kTimes = 3;
constexpr double kLeast =
    10e-3;  ///< rad: less is no slip, where no noise is stated and links are exact
constexpr size_t kMostTurns = 200;
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
};

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
    if (!nest_)
      list.push_back(
          {"the quaternions are read in another order (qx qy qz qw in the columns qw qx qy "
           "qz?) or as inverse ones",
           true});
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

 private:
  static double angle(const Eigen::Quaterniond& q) {
    return 2 * std::atan2(q.vec().norm(), std::abs(q.w()));
  }
  Eigen::Quaterniond read(int row, const Reading& reading) const {
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
  double least = std::min(kTimes * limit, kCollapse * turns.misfit({}));
  std::string found;
  for (const Reading& slip : turns.slips()) {
    const double misfit = turns.misfit(slip);
    if (!(misfit < least)) continue;
    least = misfit;
    found = "they fit where " + slip.what;
  }
  if (!found.empty()) return found;
  return "check the order of the quaternion, the signs and zeros of the joints and how the tool is "
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
