// Gross means beyond kGross times what the maker's tolerances leave at the end of the arm,
//   expected² = sum of (tolerance of a length)² + sum of (tolerance of an angle · reach)²
// with the sum of the links' lengths for the reach. A slip is believed that leaves a kCollapse-th
// part: sound rows do not fit so much better when a joint turns the other way. Medians, so that
// false rows do not decide.
#include "constraints/slips/first_look.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "constraints/slips/misfit.h"
#include "constraints/slips/slips_of_rows.h"
#include "constraints/slips/two_planes.h"
#include "constraints/statistics.h"
#include "kinematics/readable.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr double kGross = 2;
constexpr double kSlipCollapse = 0.2;
constexpr double kWithin = 0.1;       // of what tolerances leave: less is not looked into
constexpr double kLeastGross = 2e-3;  // of the robot's size, or rad: less is no slip
constexpr double kLeastZero = 0.02;   // unit of readings: less is found by calibration
constexpr double kOfRows = 0.8;       // of the equations as given, that a slip must meet
constexpr double kPlainly = 0.99;  // of what a slip leaves, another one leaves that is told instead
constexpr int kFewestLookedAt = 30;  // of a set, at least, where many are
constexpr int kMostLookedAt = 2000;  // of a set: more tell no more of a slip

/// What the maker's tolerances leave at the end (m, or rad where `lengths` is false). What legs
/// carry they turn, by a length over that of a leg.
double expected_misfit(const Robot& robot, bool lengths) {
  double reach = 0, squares = 0;
  for (const Parameter& p : robot.parameters())
    if (p.quantity == Quantity::length && p.part == Part::link) reach += std::abs(p.nominal);
  for (const Parameter& p : robot.parameters()) {
    if (p.part != Part::link) continue;
    if (p.quantity == Quantity::angle) squares += std::pow(p.tolerance * (lengths ? reach : 1), 2);
    if (p.quantity != Quantity::length) continue;
    if (lengths || robot.leg_parameter(0) >= 0)
      squares += std::pow(p.tolerance / (lengths ? 1 : size_of(robot)), 2);
  }
  return std::sqrt(squares);
}

/// The data set without most rows of a large set: every so manieth one, or where rows belong to
/// groups, and each may be measured from the one before, the first ones.
DataSet part_of(const DataSet& data, int most) {
  std::vector<int> count(data.sets.size(), 0), seen = count, kept;
  for (const int set : data.rows.set) ++count[set];
  for (int row = 0; row < data.rows.rows(); ++row) {
    const int set = data.rows.set[row], place = seen[set]++;
    const int stride = (count[set] + most - 1) / most;
    if (data.rows.group[row] >= 0 ? place < most : place % stride == 0) kept.push_back(row);
  }
  return {data.sets,   taken(data.rows, kept), data.speeds, data.order_is_time,
          data.target, data.workspace};
}

/// What is left where the zero of one joint may be anywhere: of those that it then is elsewhere.
std::vector<TriedSlip> moved_zeros(const Robot& robot, const DataSet& data) {
  std::vector<TriedSlip> list;
  const Eigen::ArrayXd units = units_of_readings(robot);
  for (int j = 0; j < static_cast<int>(robot.joints().size()); ++j) {
    const Joint& joint = robot.joints()[static_cast<size_t>(j)];
    const Misfit left = misfit(robot, data, {.zero_of = j});
    if (!left.any || std::abs(left.zero_moved) < kLeastZero * units[j]) continue;
    const bool angle = joint.quantity == Quantity::angle;
    const double moved = angle ? left.zero_moved * 180 / std::numbers::pi : 1e3 * left.zero_moved;
    list.push_back({"the zero of " + joint.name + " is " + plain_figure(std::abs(moved)) +
                        (angle ? " degrees" : " mm") +
                        " from where the robot's file has it, so that its mastering is lost or the "
                        "readings count from elsewhere",
                    left.left});
  }
  return list;
}

/// A set of touches of two planes, by what is left of its rows with the two as one and parted: in
/// a small set they are too few to show among all rows. Nothing where there is none.
std::optional<TriedSlip> two_planes_as_one(const Robot& robot, const DataSet& data,
                                           const Misfit& given, double& left) {
  for (size_t s = 0; s < data.sets.size(); ++s) {
    left = given.by_set[s];
    if (left < kLeastGross * size_of(robot)) continue;
    const auto parted = parted_planes(robot, data, static_cast<int>(s));
    if (!parted) continue;
    const Misfit two = misfit(robot, *parted, {});
    const double worse = std::max(two.by_set[s], two.by_set.back());
    if (worse < kSlipCollapse * left)
      return TriedSlip{"the touches of set " + data.sets[s].name + " are of two planes", worse};
  }
  return std::nullopt;
}

/// What is told of sets whose angles do not fit: the way to read those that instruments measured
/// by which all do best, of all sets or of one. By what they spread, too: angles that are made
/// small fit as much better. Of few rows: a fit of rows that are wrong takes its time.
std::string of_angles(const Robot& robot, const DataSet& whole, std::string otherwise) {
  const auto sets = static_cast<int>(whole.sets.size());
  const DataSet data = part_of(whole, std::max(kFewestLookedAt, kMostLookedAt / sets));
  const Misfit given = misfit(robot, data, {});
  double best = kSlipCollapse * given.angle / spread_of_angles(data, data.rows) / kPlainly;
  const auto look_at = [&](int set) {
    const std::vector<Slip> slips = slips_of_angles(data, set);
    for (const Slip& slip : slips) {
      DataSet changed = data;
      changed.rows = *slip.rows;
      const Misfit left = misfit(robot, changed, {});
      const double share = left.angle / spread_of_angles(data, changed.rows);
      if (!left.any || !left.angles.empty() || !(share < kPlainly * best)) continue;
      best = share;
      otherwise = slip.what;
    }
    return !slips.empty();
  };
  if (!look_at(-1)) return otherwise;
  for (int set = 0; set < sets; ++set) look_at(set);
  return otherwise;
}

/// How far half the measured positions are from their middle (m); infinite where none is measured.
double spread_of(const Observations& rows) {
  std::vector<double> away;
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  std::vector<Eigen::Index> measured;
  for (Eigen::Index row = 0; row < rows.position.rows(); ++row)
    if (rows.position.row(row).allFinite()) measured.push_back(row);
  for (const Eigen::Index row : measured) sum += rows.position.row(row);
  for (const Eigen::Index row : measured)
    away.push_back((rows.position.row(row) - sum / static_cast<double>(measured.size())).norm());
  return away.empty() ? HUGE_VAL : median(std::move(away));
}

/// The joints that read the same in every row; empty where all move.
std::string silent_joints(const Robot& robot, const Observations& rows) {
  std::string names;
  for (Eigen::Index j = 0; j < rows.q.cols(); ++j)
    if (is_silent(rows, j))
      names += (names.empty() ? "" : ", ") + robot.joints()[static_cast<size_t>(j)].name;
  return names;
}

/// What each slip leaves, best first. One that makes all positions nearly one leaves little of any
/// rows, and is none.
///
/// Nor is one with which few of the rows have a place: of at least so many equations, and of more
/// than there are unknowns.
std::vector<TriedSlip> tried(const Robot& robot, const DataSet& data,
                             const std::vector<Slip>& others, double least_equations) {
  std::vector<Slip> slips = others;
  std::ranges::move(slips_of_rows(robot, data), std::back_inserter(slips));
  std::vector<TriedSlip> list;
  for (const Slip& slip : slips) {
    DataSet changed = data;
    if (slip.rows) changed.rows = *slip.rows;
    const Misfit left = misfit(slip.robot ? *slip.robot : robot, changed, {});
    if (left.any && left.left < kSlipCollapse * spread_of(changed.rows) &&
        left.equations > left.unknowns && left.equations >= least_equations)
      list.push_back({slip.what, left.left});
  }
  std::ranges::move(moved_zeros(robot, data), std::back_inserter(list));
  std::ranges::stable_sort(list, {}, &TriedSlip::left);
  std::set<std::string> said;
  std::erase_if(list, [&](const TriedSlip& each) { return !said.insert(each.what).second; });
  return list;
}

/// The look at rows none of which the robot can take: the slip with which it is near all of them.
FirstLook where_no_row_has_a_place(const Robot& robot, const DataSet& data,
                                   const std::vector<Slip>& others) {
  FirstLook look;
  look.lengths =
      std::ranges::any_of(data.sets, [](const Set& s) { return s.method->has_lengths(); });
  look.left = HUGE_VAL;
  look.expected = expected_misfit(robot, look.lengths);
  look.tried = tried(robot, data, others, 0);
  look.explained = !look.tried.empty() && look.tried.front().left < kGross * look.expected;
  if (look.explained) look.found = look.tried.front().what;
  return look;
}

/// How far the file lets its tool be off (m), 1 sigma of each of its lengths.
double tool_tolerance(const Robot& robot) {
  double squares = 0;
  for (const Parameter& p : robot.parameters())
    if (p.part == Part::tool && p.quantity == Quantity::length)
      squares += p.tolerance * p.tolerance;
  return std::sqrt(squares);
}

}  // namespace

double gross_misfit(const Robot& robot, bool lengths) {
  return kGross * expected_misfit(robot, lengths);
}

FirstLook first_look(const std::shared_ptr<const Robot>& robot, const DataSet& whole,
                     const std::vector<Slip>& others) {
  FirstLook look;
  const DataSet data = part_of(whole, kMostLookedAt);
  const Misfit given = misfit(*robot, data, {});
  if (!given.any) return where_no_row_has_a_place(*robot, data, others);
  look.lengths = given.lengths;
  look.left = given.left;
  look.equations = given.equations;
  look.taken = given.unknowns;
  look.tool_moved = given.tool_moved;
  look.expected = expected_misfit(*robot, given.lengths);
  look.tool_held = misfit(*robot, data, {.tool = false}).left;
  if (!given.angles.empty()) look.found = of_angles(*robot, data, given.angles.front());
  const std::string angles = look.found;
  look.angles = !angles.empty();
  double of_set = 0;
  if (const auto planes = two_planes_as_one(*robot, data, given, of_set)) {
    look.left = of_set;
    look.tried = {*planes};
    look.explained = true;
    look.found = planes->what;
    look.angles = false;
    return look;
  }
  const double least =
      std::max(kLeastGross * (given.lengths ? size_of(*robot) : 1), kWithin * look.expected);
  const double gross = gross_misfit(*robot, given.lengths);
  if (look.left < least && look.tool_held < gross) return look;
  look.tried = tried(*robot, data, others, kOfRows * given.equations);
  const double best = look.tried.empty() ? look.left : look.tried.front().left;
  look.explained = look.left > least && best < kSlipCollapse * look.left;
  const std::string silent = silent_joints(*robot, data.rows);
  look.tool = !look.explained && silent.empty() && look.left < kSlipCollapse * look.tool_held &&
              look.tool_held > gross && look.tool_moved > tool_tolerance(*robot);
  if (look.explained)
    look.found =
        look.tried.front().what +
        (silent.empty() ? "" : "; or " + silent + " moved: what is read of it never changes");
  else if (!silent.empty())
    look.found = "the rows do not fit, and what is read of " + silent +
                 " is the same in all of them: a column that is not its encoder's, or an encoder "
                 "that is silent";
  else if (look.tool)
    look.found = "the tool's frame is missing or another one";
  else if (look.left > gross && look.found.empty())
    look.found =
        "none of the usual slips explains the rows: they are of another robot, or a file "
        "is wrong elsewhere";
  look.angles = look.angles && look.found == angles;
  return look;
}

}  // namespace selfcal
