#include "constraints/planning/refinement.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constraints/planning/better_places.h"
#include "constraints/sampling/configurations.h"
#include "constraints/sampling/newton.h"

namespace selfcal {
namespace {

/// The units of a plan, moved along what they satisfy.
class PlanMoves {
 public:
  PlanMoves(const Robot& robot, const PlanEquations& equations, Refined plan)
      : robot_(robot), equations_(equations), plan_(plan) {}

  Moves moves() {
    return {[this](int unit) { return range(unit); },
            [this](int unit, const Eigen::MatrixXd& by) { return look(unit, by); },
            [this](int unit, int column) { return take(unit, column); }};
  }

  std::vector<Eigen::MatrixXd> rows() const {
    std::vector<Eigen::MatrixXd> list;
    for (const Eigen::MatrixXd& W : equations_.of_units(plan_.data, plan_.units))
      list.push_back(W(Eigen::all, plan_.columns));
    return list;
  }

 private:
  /// Proposals side by side: readings of each row of the unit, and whether it can be taken.
  struct Proposals {
    std::vector<Eigen::MatrixXd> q;  ///< by row of the unit: lanes x joints
    std::vector<char> possible;
  };

  const Unit& unit_of(int unit) const { return plan_.units[static_cast<std::size_t>(unit)]; }

  Eigen::VectorXd range(int unit) const {
    const Eigen::Index joints = plan_.data.rows.q.cols();
    Eigen::VectorXd range(joints * static_cast<Eigen::Index>(unit_of(unit).size()));
    for (Eigen::Index c = 0; c < range.size(); ++c) {
      const auto j = static_cast<std::size_t>(c % joints);
      range[c] =
          std::ranges::count(plan_.held, static_cast<int>(j)) > 0 ? 0 : robot_.joints()[j].range();
    }
    return range;
  }

  std::vector<Eigen::MatrixXd> look(int u, const Eigen::MatrixXd& by) {
    const Unit& unit = unit_of(u);
    const double most = plan_.most[plan_.data.rows.set[unit.front()]];
    looked_ = propose(unit, by);
    const DataSet trial = rows_of(unit, looked_);
    std::vector<Eigen::MatrixXd> W = equations_.of_units(trial, units_of(unit, looked_));
    for (std::size_t lane = 0; lane < W.size(); ++lane) {
      const bool takes = looked_.possible[lane] && W[lane].norm() <= most && spaced(u, lane);
      W[lane] = takes ? Eigen::MatrixXd(W[lane](Eigen::all, plan_.columns)) : Eigen::MatrixXd();
    }
    return W;
  }

  /// Far enough from the other units of its set, and from what is taken already.
  bool spaced(int u, std::size_t lane) const {
    if (plan_.spacing <= 0) return true;
    const Observations& rows = plan_.data.rows;
    const int set = rows.set[unit_of(u).front()];
    std::vector<Eigen::Vector3d> others;
    if (static_cast<std::size_t>(set) < plan_.taken.size())
      others = plan_.taken[static_cast<std::size_t>(set)];
    for (std::size_t other = 0; other < plan_.units.size(); ++other)
      for (const int row : plan_.units[other])
        if (static_cast<int>(other) != u && rows.set[row] == set)
          others.push_back(place(rows.q.row(row).transpose()));
    return std::ranges::none_of(looked_.q, [&](const Eigen::MatrixXd& q) {
      return nearer_than(plan_.spacing, place(q.row(static_cast<Eigen::Index>(lane)).transpose()),
                         others);
    });
  }

  Eigen::Vector3d place(const Eigen::VectorXd& q) const {
    return locate(robot_, equations_.state().xi, q).p;
  }

  bool take(int u, int column) {
    const Unit& unit = unit_of(u);
    for (std::size_t r = 0; r < unit.size(); ++r)
      plan_.data.rows.q.row(unit[r]) = looked_.q[r].row(column);
    measure_rows(robot_, equations_.state(), unit, plan_.data);
    return true;
  }

  Proposals propose(const Unit& unit, const Eigen::MatrixXd& by) const {
    const Eigen::MatrixXd& now = plan_.data.rows.q;
    const Eigen::Index joints = now.cols();
    Proposals all;
    all.possible.assign(static_cast<std::size_t>(by.cols()), 1);
    Locations before;
    for (std::size_t r = 0; r < unit.size(); ++r) {
      ConfigurationBlock block{now.row(unit[r]).replicate(kLanes, 1).array(),
                               static_cast<int>(by.cols())};
      block.q.topRows(by.cols()) +=
          by.middleRows(static_cast<Eigen::Index>(r) * joints, joints).transpose().array();
      before = bring(unit[r], r == 0, before, block, all.possible);
      all.q.push_back(block.q.topRows(by.cols()).matrix());
    }
    return all;
  }

  /// Brings the lanes to where the method holds; says which cannot be taken, and where they are.
  Locations bring(int row, bool first, const Locations& before, ConfigurationBlock& block,
                  std::vector<char>& possible) const {
    const DataSet& data = plan_.data;
    const Method& method = *data.sets[static_cast<std::size_t>(data.rows.set[row])].method;
    std::vector<char> there(kLanes, 0);
    Locations X;
    if (method.constrains() && !(method.paired() && first)) {
      NewtonStep newton(robot_, data, equations_.state(), {row}, before, plan_.held);
      const auto wanted =
          Eigen::VectorXd::Zero(static_cast<Eigen::Index>(method.equations().size()));
      for (const int lane : newton.reach(wanted, std::max(1, block.count * 3 / 4), block))
        there[static_cast<std::size_t>(lane)] = 1;
      X = newton.X();
    } else {
      const Closure closure =
          robot_.locate(block, equations_.state().xi, method.body(), X, nullptr);
      for (int lane = 0; lane < kLanes; ++lane)
        there[static_cast<std::size_t>(lane)] = closure.closes(lane);
    }
    for (std::size_t lane = 0; lane < possible.size(); ++lane)
      if (!there[lane] ||
          !within_limits(robot_, block.q.row(static_cast<Eigen::Index>(lane)).transpose()))
        possible[lane] = 0;
    return X;
  }

  std::vector<Unit> units_of(const Unit& unit, const Proposals& proposals) const {
    std::vector<Unit> units(proposals.possible.size());
    int row = 0;
    for (Unit& each : units)
      for (std::size_t r = 0; r < unit.size(); ++r) each.push_back(row++);
    return units;
  }

  /// The rows of every proposal, one after another, as a perfect instrument would read them.
  DataSet rows_of(const Unit& unit, const Proposals& proposals) const {
    DataSet trial;
    trial.sets = plan_.data.sets;
    std::vector<int> from;
    for (std::size_t lane = 0; lane < proposals.possible.size(); ++lane)
      from.insert(from.end(), unit.begin(), unit.end());
    trial.rows = taken(plan_.data.rows, from);
    const auto set = static_cast<std::size_t>(plan_.data.rows.set[unit.front()]);
    const bool paired = trial.sets[set].method->paired();
    if (paired) trial.sets[set].groups.assign(proposals.possible.size(), "");
    int row = 0;
    for (std::size_t lane = 0; lane < proposals.possible.size(); ++lane)
      for (std::size_t r = 0; r < unit.size(); ++r, ++row) {
        if (paired) trial.rows.group[row] = static_cast<int>(lane);
        if (proposals.possible[lane])
          trial.rows.q.row(row) = proposals.q[r].row(static_cast<Eigen::Index>(lane));
      }
    std::vector<int> rows(from.size());
    std::iota(rows.begin(), rows.end(), 0);
    measure_rows(robot_, equations_.state(), rows, trial);
    return trial;
  }

  const Robot& robot_;
  const PlanEquations& equations_;
  Refined plan_;
  Proposals looked_;
};

}  // namespace

int refine(const Robot& robot, const PlanEquations& equations, const Objective& objective,
           Refined plan, const Progress& progress) {
  PlanMoves plan_moves(robot, equations, plan);
  Design design(plan_moves.rows(), objective);
  std::vector<int> all(plan.units.size());
  std::iota(all.begin(), all.end(), 0);
  design.choose(all);
  return move_to_better_places(design, plan_moves.moves(), progress);
}

}  // namespace selfcal
