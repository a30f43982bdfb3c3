#include "constraints/slips/slips_of_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

namespace selfcal {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kGon = std::numbers::pi / 200;
constexpr double kProportional = 1e-6;  // 1 - correlation of readings that are one in truth

/// The columns of one number a row that the sets' methods read as such a quantity.
std::set<std::string> measured(const DataSet& data, Quantity quantity) {
  std::set<std::string> names;
  for (const Set& set : data.sets)
    for (const MeasuredColumn& column : set.method->measures())
      if (column.quantity == quantity && data.rows.measured.contains(column.name))
        names.insert(column.name);
  return names;
}

class SlipsOfRows {
 public:
  SlipsOfRows(const Robot& robot, const DataSet& data) : robot_(robot), data_(data) {}

  std::vector<Slip> take() {
    of_joints();
    of_mimicry();
    if (beyond_a_turn())
      add("the joint readings are degrees", [&](Observations& o) {
        for (Eigen::Index j = 0; j < o.q.cols(); ++j)
          if (joint(j).quantity == Quantity::angle) o.q.col(j) *= kDegree;
      });
    of_units();
    std::ranges::move(slips_of_angles(data_, -1), std::back_inserter(list_));
    if (rows().position.rows() > 0) of_axes();
    return std::move(list_);
  }

 private:
  const Observations& rows() const { return data_.rows; }
  const Joint& joint(Eigen::Index j) const { return robot_.joints()[static_cast<size_t>(j)]; }

  template <class Change>
  void add(std::string what, Change change) {
    Observations changed = rows();
    change(changed);
    list_.push_back({std::move(what), nullptr, std::move(changed)});
  }

  void of_joints() {
    const Eigen::Index n = rows().q.cols();
    for (Eigen::Index j = 0; j < n; ++j)
      add(joint(j).name + " is read with the other sign (or its gear turns the other way)",
          [j](Observations& o) { o.q.col(j) *= -1; });
    if (n > 1) add("all joints are read with the other sign", [](Observations& o) { o.q *= -1; });
    for (const double turns : {0.5, 2.0})
      for (Eigen::Index j = 0; j < n; ++j)
        add("the readings of " + joint(j).name + " are " + (turns < 1 ? "twice" : "half") +
                " what it moves (its gear ratio)",
            [j, turns](Observations& o) { o.q.col(j) *= turns; });
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index k = 0; k < j; ++k)
        if (joint(j).quantity == joint(k).quantity && !is_silent(rows(), j) &&
            !is_silent(rows(), k))
          add("the columns of " + joint(k).name + " and " + joint(j).name + " are exchanged",
              [j, k](Observations& o) { o.q.col(j).swap(o.q.col(k)); });
  }

  /// A joint that mimics another may be read as drivers publish it, though the coupling of the
  /// robot's file moves it already.
  void of_mimicry() {
    for (Eigen::Index j = 0; j < rows().q.cols(); ++j) {
      const Eigen::Index leader = followed(j);
      if (leader < 0) continue;
      add("the readings of " + joint(j).name + " follow those of " + joint(leader).name +
              ", as its coupling does already: they are 0 in every row",
          [j](Observations& o) { o.q.col(j).setZero(); });
    }
  }

  /// A joint whose readings those of joint j are in proportion to; -1 where there is none.
  Eigen::Index followed(Eigen::Index j) const {
    const Eigen::VectorXd follower = centred(j);
    for (Eigen::Index k = 0; k < rows().q.cols(); ++k) {
      const Eigen::VectorXd leader = centred(k);
      const double cross = follower.dot(leader);
      if (k != j && follower.norm() > 0 && leader.norm() > 0 &&
          std::abs(cross) > (1 - kProportional) * follower.norm() * leader.norm())
        return k;
    }
    return -1;
  }
  Eigen::VectorXd centred(Eigen::Index j) const {
    return rows().q.col(j).array() - rows().q.col(j).mean();
  }

  /// Some joint would turn by more than once: its readings may be degrees. Below, readings that are
  /// made 57 times smaller would fit touches ever better, for the robot would hardly move.
  bool beyond_a_turn() const {
    for (Eigen::Index j = 0; j < rows().q.cols(); ++j)
      if (joint(j).quantity == Quantity::angle &&
          rows().q.col(j).cwiseAbs().maxCoeff() > 2 * std::numbers::pi)
        return true;
    return false;
  }

  void of_units() {
    const std::set<std::string> lengths = measured(data_, Quantity::length);
    const bool places = rows().position.rows() > 0;
    const std::string what = !places                        ? "distances"
                             : lengths.contains("distance") ? "positions and distances"
                                                            : "positions";
    static constexpr std::pair<const char*, double> kUnits[] = {
        {"micrometres", 1e-6}, {"millimetres", 1e-3}, {"centimetres", 1e-2}, {"inches", 0.0254}};
    if (places || !lengths.empty())
      for (const auto& [unit, metres] : kUnits)
        add("the measured " + what + " are " + unit, [&, scale = metres](Observations& o) {
          if (places) o.position *= scale;
          for (const std::string& name : lengths) o.column(name) *= scale;
        });
  }

  void of_axes() {
    // Without orientations a turn of the base tells these apart, which may move: all are tried, for
    // a fit hardly finds a base that is turned round.
    const bool alike = rows().orientation.rows() == 0;
    const std::string either =
        "two of the columns x, y and z are exchanged, or one has the other sign";
    const std::array<std::string, 3> axes = {"x", "y", "z"};
    for (Eigen::Index a = 0; a < 3; ++a) {
      add(alike ? either : "the column " + axes[a] + " has the other sign",
          [a](Observations& o) { o.position.col(a) *= -1; });
      for (Eigen::Index b = 0; b < a; ++b)
        add(alike ? either : "the columns " + axes[b] + " and " + axes[a] + " are exchanged",
            [a, b](Observations& o) { o.position.col(a).swap(o.position.col(b)); });
    }
  }

  const Robot& robot_;
  const DataSet& data_;
  std::vector<Slip> list_;
};

}  // namespace

std::vector<Slip> slips_of_rows(const Robot& robot, const DataSet& data) {
  return SlipsOfRows(robot, data).take();
}

std::vector<Slip> slips_of_angles(const DataSet& data, int set) {
  std::set<std::string> names = measured(data, Quantity::angle);
  if (set >= 0)
    std::erase_if(names, [&](const std::string& name) {
      return std::ranges::none_of(
          data.sets[static_cast<std::size_t>(set)].method->measures(),
          [&](const MeasuredColumn& column) { return column.name == name; });
    });
  const std::string of = set < 0 ? "" : " of set " + data.sets[static_cast<std::size_t>(set)].name;
  std::vector<Slip> list;
  const auto add = [&](std::string what, auto change) {
    Observations changed = data.rows;
    for (int row = 0; row < changed.rows(); ++row)
      if (set < 0 || changed.set[static_cast<std::size_t>(row)] == set) change(changed, row);
    list.push_back({std::move(what), nullptr, std::move(changed)});
  };
  if (names.empty()) return list;
  for (const auto& [unit, radians] : {std::pair{"degrees", kDegree}, std::pair{"gons", kGon}})
    add("the measured angles" + of + " are " + unit,
        [&, scale = radians](Observations& o, int row) {
          for (const std::string& name : names) o.column(name)[row] *= scale;
        });
  for (const std::string& name : names) {
    add("the column " + name + of + " has the other sign",
        [&](Observations& o, int row) { o.column(name)[row] *= -1; });
    add("the column " + name + of +
            " counts from a right angle away, the other way round (a zenith angle)",
        [&](Observations& o, int row) {
          o.column(name)[row] = std::numbers::pi / 2 - o.column(name)[row];
        });
  }
  for (const std::string& name : names)
    for (const std::string& other : names)
      if (other < name)
        add("the columns " + other + " and " + name + of + " are exchanged",
            [&](Observations& o, int row) {
              std::swap(o.column(name)[row], o.column(other)[row]);
            });
  return list;
}

double spread_of_angles(const DataSet& data, const Observations& rows) {
  double squares = 0, count = 0;
  for (const std::string& name : measured(data, Quantity::angle)) {
    std::vector<std::vector<double>> of_set(data.sets.size());
    for (int row = 0; row < rows.rows(); ++row)
      if (const double read = rows.column(name)[row]; std::isfinite(read))
        of_set[static_cast<std::size_t>(rows.set[static_cast<std::size_t>(row)])].push_back(read);
    for (const std::vector<double>& read : of_set) {
      const auto n = static_cast<double>(read.size());
      const double mean = std::accumulate(read.begin(), read.end(), 0.0) / std::max(n, 1.0);
      for (const double each : read) squares += std::pow(each - mean, 2);
      count += n;
    }
  }
  return std::sqrt(squares / std::max(count, 1.0));
}

bool is_silent(const Observations& rows, Eigen::Index j) {
  const auto read = rows.q.col(j).array();
  return read.size() == 0 || (read == read[0]).all();
}

}  // namespace selfcal
