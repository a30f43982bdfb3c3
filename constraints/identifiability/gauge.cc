// The gauge, found from the rows: a direction is unseen when what is left of its column, after the
// unknowns that could mimic it are projected out, is lost in the noise.
#include "constraints/identifiability/gauge.h"

#include <algorithm>
#include <cmath>

#include "kinematics/linear_algebra.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

/// A motion of the world that the rows place no better than this (of the robot's size, or rad) is
/// unseen.
constexpr double kPlaced = 50e-3;

template <class Predicate>
bool every_set(const Equations& equations, Predicate holds) {
  bool any = false;
  for (int s = 0; s < static_cast<int>(equations.data().sets.size()); ++s) {
    if (equations.plan(s).items.empty()) continue;
    any = true;
    if (!holds(*equations.data().sets[s].method)) return false;
  }
  return any;
}

/// A set gives a length that is compared with its nuisance parameters, not with every row.
bool length_beside_the_rows(const Equations& equations) {
  return std::ranges::any_of(equations.data().sets, [](const Set& set) {
    return std::ranges::any_of(set.method->known_lengths(),
                               [](const KnownLength& length) { return !length.by_row; });
  });
}

}  // namespace

std::vector<Note> held_base(const Robot& robot, const Equations& equations) {
  if (!every_set(equations, [](const Method& m) { return m.frame_unknown(); })) return {};
  std::vector<Note> notes;
  for (const Parameter& p : robot.parameters())
    if (p.part == Part::base)
      notes.push_back(
          {p.name, "every device's own frame is unknown: the base cannot be told from it"});
  return notes;
}

bool orientation_is_seen(const Equations& equations) {
  return !every_set(equations, [](const Method& m) { return !m.sees_orientation(); });
}

std::vector<Note> held_orientation(const Robot& robot, const Equations& equations) {
  if (orientation_is_seen(equations)) return {};
  std::vector<Note> notes;
  for (const Parameter& p : robot.parameters())
    if (p.part == Part::tool && p.of_whole_pose && p.quantity == Quantity::angle)
      notes.push_back(
          {p.name, "no row sees how the tool is turned: it is held as the file has it"});
  return notes;
}

std::optional<int> held_scale(const Equations& equations, const Eigen::MatrixXd& R,
                              const Eigen::VectorXd& xi, const std::vector<char>& free) {
  if (!every_set(equations, [](const Method& m) { return m.may_leave_scale_free(); }))
    return std::nullopt;
  const Robot& robot = equations.robot();
  std::vector<int> others;
  for (int c = equations.robot_columns(); c < equations.columns(); ++c) others.push_back(c);
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(R.rows());
  int last = -1;
  for (const int i : robot.preference()) {
    const Parameter& p = robot.parameters()[i];
    if (p.link_length && !free[i]) return std::nullopt;  // a length that is known gives the scale
    if (p.quantity == Quantity::length) scale += xi[i] * R.col(i);
    if (p.link_length)
      last = i;
    else if (free[i])
      others.push_back(i);
  }
  if (last < 0) return std::nullopt;
  const Parameter& p = robot.parameters()[last];
  // What could mimic the scale is bounded by its own prior, or an ill-seen tool would always do.
  const Eigen::Index K = R.rows(), n = static_cast<Eigen::Index>(others.size());
  Eigen::MatrixXd bounded = Eigen::MatrixXd::Zero(K + n, n);
  bounded.topRows(K) = R(Eigen::all, others);
  for (Eigen::Index i = 0; i < n; ++i)
    if (others[i] < equations.robot_columns())
      bounded(K + i, i) = 1 / robot.parameters()[others[i]].tolerance;
  // Of a robot made smaller with all that it touches, the misfit shrinks, too: what a column owes
  // to it says nothing of the scale. Row by row it is taken off where a length is given beside the
  // rows, which does not shrink (R's last column is the misfit turned round); without one, where
  // the nominal robot is far off and the column is its alone, as if all of it were against the
  // scale.
  const bool beside = length_beside_the_rows(equations);
  Eigen::VectorXd told = Eigen::VectorXd::Zero(K + n);
  told.head(K) = scale;
  if (beside) told.head(K) += R.rightCols(1);
  const double misfit = beside ? 0 : R.rightCols(1).squaredNorm();
  const double seen = beyond(bounded, told).squaredNorm() - misfit;
  if (seen * std::pow(p.tolerance, 2) > std::pow(p.nominal, 2)) return std::nullopt;
  return last;
}

bool has_slides(const Robot& robot) {
  return std::ranges::any_of(robot.joints(),
                             [](const Joint& joint) { return joint.quantity == Quantity::length; });
}

std::string why_scale_is_held(const Robot& robot) {
  return has_slides(robot)
             ? "the touches tell the robot's scale less well than the maker's lengths do, though "
               "its slides read lengths: this one is held where the maker's together have the "
               "scale"
             : "the touches leave the robot's scale free: this length is held where the maker's "
               "lengths together have the scale";
}

Eigen::MatrixXd unseen_motions(const Equations& equations, const Eigen::MatrixXd& R) {
  const int at = equations.columns();
  const Eigen::MatrixXd nuisance =
      R.middleCols(equations.robot_columns(), equations.nuisance_columns());
  Eigen::Matrix<double, 6, 1> unit = Eigen::Matrix<double, 6, 1>::Ones();
  unit.head<3>().setConstant(size_of(equations.robot()));
  const SingularValues svd =
      singular_values(beyond(nuisance, R.middleCols(at, 6) * unit.asDiagonal()));
  std::vector<int> unseen;
  for (int i = 0; i < 6; ++i)
    if (svd.values[i] * kPlaced < 1) unseen.push_back(i);
  return unit.asDiagonal() * svd.directions(Eigen::all, unseen);
}

bool point_is_unknown(const Equations& equations) {
  return every_set(equations, [](const Method& m) { return !m.sees_point(); });
}

}  // namespace selfcal
