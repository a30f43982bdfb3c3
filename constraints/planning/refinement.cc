#include "constraints/planning/refinement.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constraints/sampling/configurations.h"
#include "constraints/sampling/newton.h"

namespace selfcal {
namespace {

constexpr double kFirstStep = 0.1;   // of a joint's range
constexpr double kLastStep = 0.004;  // of the same
constexpr int kPolls = 12;           // of one unit in a sweep
constexpr int kSweeps = 4;
constexpr double kWorth =
    2e-3;  // a sweep that gains less, of the variance or of a log, is the last

class Compass {
 public:
  Compass(const Robot& robot, const PlanEquations& equations, const Objective& objective,
          Refined plan)
      : robot_(robot),
        equations_(equations),
        plan_(plan),
        design_(chosen_rows(), objective),
        step_(plan.units.size(), kFirstStep) {
    std::vector<int> all;
    for (int u = 0; u < design_.candidates(); ++u) all.push_back(u);
    design_.choose(all);
  }

  int run(const Progress& progress) {
    int moves = 0;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      const double before = design_.merit();
      for (int u = 0; u < design_.candidates(); ++u) {
        if (progress)
          progress("moving configurations",
                   (sweep + u / static_cast<double>(design_.candidates())) / kSweeps);
        moves += improve(u);
      }
      if (design_.merit() - before < kWorth * std::min(1.0, std::abs(before))) break;
    }
    return moves;
  }

 private:
  /// Proposals side by side: readings of each row of the unit, and whether it can be taken.
  struct Proposals {
    std::vector<Eigen::MatrixXd> q;  ///< by row of the unit: lanes x joints
    std::vector<char> possible;
  };

  std::vector<Eigen::MatrixXd> chosen_rows() const {
    std::vector<Eigen::MatrixXd> list;
    for (const Eigen::MatrixXd& W : equations_.of_units(plan_.data, plan_.units))
      list.push_back(W(Eigen::all, plan_.columns));
    return list;
  }

  int improve(int u) {
    int moves = 0;
    double merit = design_.merit();
    design_.change(u, -1);
    double& step = step_[static_cast<std::size_t>(u)];
    for (int poll = 0; poll < kPolls && step >= kLastStep; ++poll) {
      if (take_best(u, step, merit))
        ++moves;
      else
        step /= 2;
    }
    design_.change(u, +1);
    design_.refresh();
    return moves;
  }

  /// Moves unit u, which is taken out of the design, where that raises `merit`.
  bool take_best(int u, double step, double& merit) {
    const Unit& unit = plan_.units[static_cast<std::size_t>(u)];
    const Eigen::Index joints = plan_.data.rows.q.cols(),
                       directions = 2 * joints * static_cast<Eigen::Index>(unit.size());
    const double most = plan_.most[plan_.data.rows.set[unit.front()]];
    bool better = false;
    Eigen::MatrixXd best_q, best_w;
    for (Eigen::Index first = 0; first < directions; first += kLanes) {
      const Proposals proposals =
          propose(unit, first, std::min<Eigen::Index>(kLanes, directions - first), step);
      const DataSet trial = rows_of(unit, proposals);
      const std::vector<Eigen::MatrixXd> W = equations_.of_units(trial, units_of(unit, proposals));
      for (std::size_t lane = 0; lane < W.size(); ++lane) {
        if (!proposals.possible[lane]) continue;
        if (W[lane].rows() != design_.rows(u) || W[lane].norm() > most) continue;
        const Eigen::MatrixXd w = W[lane](Eigen::all, plan_.columns);
        const double with = design_.merit_with(w);
        if (!(with > merit + 1e-9 * std::abs(merit))) continue;
        merit = with;
        better = true;
        best_w = w;
        best_q.resize(static_cast<Eigen::Index>(unit.size()), joints);
        for (std::size_t r = 0; r < unit.size(); ++r)
          best_q.row(static_cast<Eigen::Index>(r)) =
              proposals.q[r].row(static_cast<Eigen::Index>(lane));
      }
    }
    if (!better) return false;
    design_.replace(u, best_w);
    put(unit, best_q);
    return true;
  }

  /// Row r of direction k is row k / (2 joints) of the unit.
  Proposals propose(const Unit& unit, Eigen::Index first, Eigen::Index count, double step) const {
    const Eigen::MatrixXd& now = plan_.data.rows.q;
    Proposals all;
    all.possible.assign(static_cast<std::size_t>(count), 1);
    Locations before;
    for (std::size_t r = 0; r < unit.size(); ++r) {
      ConfigurationBlock block{now.row(unit[r]).replicate(kLanes, 1).array(),
                               static_cast<int>(count)};
      for (Eigen::Index lane = 0; lane < count; ++lane) {
        const Eigen::Index k = first + lane, j = k / 2 % now.cols();
        if (k / (2 * now.cols()) != static_cast<Eigen::Index>(r)) continue;
        if (std::ranges::count(plan_.held, static_cast<int>(j)) > 0) {
          all.possible[static_cast<std::size_t>(lane)] = 0;
          continue;
        }
        const double by = step * robot_.joints()[static_cast<std::size_t>(j)].range();
        block.q(lane, j) += k % 2 == 0 ? by : -by;
      }
      before = bring(unit[r], r == 0, before, block, all.possible);
      all.q.push_back(block.q.topRows(count).matrix());
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
      NewtonStep newton(robot_, data, equations_.state(), row, before, plan_.held);
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

  void put(const Unit& unit, const Eigen::MatrixXd& q) {
    for (std::size_t r = 0; r < unit.size(); ++r)
      plan_.data.rows.q.row(unit[r]) = q.row(static_cast<Eigen::Index>(r));
    measure_rows(robot_, equations_.state(), unit, plan_.data);
  }

  const Robot& robot_;
  const PlanEquations& equations_;
  Refined plan_;
  Design design_;
  std::vector<double> step_;  ///< by unit, of the joints' ranges
};

}  // namespace

int refine(const Robot& robot, const PlanEquations& equations, const Objective& objective,
           Refined plan, const Progress& progress) {
  return Compass(robot, equations, objective, plan).run(progress);
}

}  // namespace selfcal
