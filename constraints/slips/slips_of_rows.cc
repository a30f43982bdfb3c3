#include "constraints/slips/slips_of_rows.h"

#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace selfcal {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kProportional = 1e-6;  // 1 - correlation of readings that are one in truth

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

  /// The columns of one number a row that the sets' methods read as such a quantity.
  std::set<std::string> measured(Quantity quantity) const {
    std::set<std::string> names;
    for (const Set& set : data_.sets)
      for (const MeasuredColumn& column : set.method->measures())
        if (column.quantity == quantity && rows().measured.contains(column.name))
          names.insert(column.name);
    return names;
  }

  void of_units() {
    const std::set<std::string> lengths = measured(Quantity::length),
                                angles = measured(Quantity::angle);
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
    if (angles.empty()) return;
    add("the measured angles are degrees", [&](Observations& o) {
      for (const std::string& name : angles) o.column(name) *= kDegree;
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

bool is_silent(const Observations& rows, Eigen::Index j) {
  const auto read = rows.q.col(j).array();
  return read.size() == 0 || (read == read[0]).all();
}

}  // namespace selfcal
