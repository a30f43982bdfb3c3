#include "diagnosis/compare.h"

#include <algorithm>
#include <cmath>

#include "constraints/adjustment.h"
#include "diagnosis/structures.h"
#include "diagnosis/view.h"
#include "kinematics/corrected_robot.h"

namespace selfcal {
namespace {

constexpr double kListed = 0.02;

/// The set among `sets` that `set` is one surface or instrument with; -1 without.
int same_set(const std::vector<Set>& sets, const Set& set) {
  const auto same = std::find_if(sets.begin(), sets.end(), [&](const Set& other) {
    return other.name == set.name && other.method->name() == set.method->name();
  });
  return same == sets.end() ? -1 : static_cast<int>(same - sets.begin());
}

/// Puts what the second has of sets and groups behind the first's, and its rows into these terms.
void adopt(DataSet& first, const std::vector<Set>& sets, Observations& rows) {
  const std::vector<Set> own = first.sets;
  std::vector<int> set_of, first_group;
  for (const Set& set : sets) {
    const int same = same_set(own, set);
    set_of.push_back(same >= 0 ? same : static_cast<int>(first.sets.size()));
    first_group.push_back(same >= 0 ? static_cast<int>(first.sets[same].groups.size()) : 0);
    if (same < 0) first.sets.push_back(set);
    if (same < 0) continue;
    for (const std::string& group : set.groups) first.sets[same].groups.push_back(group + "'");
  }
  for (size_t s = own.size(); s < first.sets.size(); ++s)
    if (first.sets[s].reference >= 0) first.sets[s].reference = set_of[first.sets[s].reference];
  for (size_t row = 0; row < rows.set.size(); ++row) {
    if (rows.group[row] >= 0) rows.group[row] += first_group[rows.set[row]];
    rows.set[row] = set_of[rows.set[row]];
  }
}

/// Rows of both, the first ones first. Sets of one name become one; groups and repeats stay apart,
/// and the second begins when the first ends.
DataSet merged(const DataSet& before, const DataSet& after) {
  DataSet all = before;
  Observations later = after.rows;
  adopt(all, after.sets, later);
  int most_repeat = 0;
  for (const int repeat : before.rows.repeat) most_repeat = std::max(most_repeat, repeat + 1);
  for (int& repeat : later.repeat)
    if (repeat >= 0) repeat += most_repeat;
  if (before.rows.time.size() > 0 && later.time.size() > 0)
    later.time.array() += before.rows.time.maxCoeff() - later.time.minCoeff();
  all.rows = joined(before.rows, later);
  return all;
}

/// Everything that may have changed, as columns of the merged rows that only the second has.
struct Changeable {
  Candidates candidates;
  std::vector<int> columns;  ///< of the dense equations, by parameter
  std::vector<EffectParameter> parameters;

  void add(const std::string& effect, const std::string& at, const std::vector<int>& of,
           const std::vector<EffectParameter>& named) {
    Candidate candidate{effect, at, {}, {}, {}, 0};
    for (size_t i = 0; i < of.size(); ++i) {
      candidate.main.push_back(static_cast<int>(columns.size()));
      columns.push_back(of[i]);
      parameters.push_back(named[i]);
    }
    candidates.list.push_back(std::move(candidate));
  }
};

EffectParameter named(const Parameter& p) { return {p.name, std::string(p.unit()), 5e-6, 5e-3, 0}; }

Changeable changeable(const Robot& robot, const Equations& equations, const DataSet& before,
                      const DataSet& after) {
  Changeable all;
  std::vector<int> base, probe;
  std::vector<EffectParameter> base_names, probe_names;
  for (size_t j = 0; j < robot.joints().size(); ++j) {
    const int p = robot.variable_parameter(static_cast<int>(j));
    all.add("zero_shift", robot.joints()[j].name, {p}, {named(robot.parameters()[p])});
  }
  for (size_t p = 0; p < robot.parameters().size(); ++p) {
    const Parameter& each = robot.parameters()[p];
    if (each.part != Part::base && each.part != Part::tool) continue;
    (each.part == Part::base ? base : probe).push_back(static_cast<int>(p));
    (each.part == Part::base ? base_names : probe_names).push_back(named(each));
  }
  if (!base.empty()) all.add("base_moved", "base", base, base_names);
  if (!probe.empty()) all.add("probe_changed", "probe", probe, probe_names);
  for (size_t s = 0; s < before.sets.size(); ++s) {
    const bool both = same_set(after.sets, before.sets[s]) >= 0;
    const int freedom = equations.own_freedom(static_cast<int>(s));
    if (!both || freedom == 0) continue;
    std::vector<int> columns;
    std::vector<EffectParameter> names;
    for (int k = 0; k < freedom; ++k) {
      columns.push_back(equations.own_at(static_cast<int>(s)) + k);
      names.push_back({"own" + std::to_string(k + 1), "m or rad", 5e-6, 5e-3, 0});
    }
    all.add("fixture_shift", before.sets[s].name, columns, names);
  }
  for (Candidate& each : all.candidates.list)
    each.log_prior = -std::log(static_cast<double>(
        std::count_if(all.candidates.list.begin(), all.candidates.list.end(),
                      [&](const Candidate& other) { return other.effect == each.effect; })));
  return all;
}

Whitened whitened(const DenseEquations& dense, const Adjusted& adjusted, const Equations& equations,
                  const Changeable& changeable, int first_rows) {
  std::vector<int> columns;
  for (int c = 0; c < equations.robot_columns(); ++c)
    if (adjusted.prior.free[c]) columns.push_back(c);
  const auto free = static_cast<Eigen::Index>(columns.size());
  for (Eigen::Index c = equations.robot_columns(); c < dense.W.cols(); ++c)
    columns.push_back(static_cast<int>(c));
  Whitened rows;
  rows.A = dense.W(Eigen::all, columns);
  rows.C = dense.W(Eigen::all, changeable.columns);
  for (Eigen::Index i = 0; i < rows.C.rows(); ++i)
    if (dense.row[static_cast<size_t>(i)] < first_rows) rows.C.row(i).setZero();
  rows.y = dense.y;
  rows.weight = rows.pull = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index i = 0; i < free; ++i) {
    const int c = columns[static_cast<size_t>(i)];
    rows.weight[i] = 1 / adjusted.prior.sigma[c];
    rows.pull[i] = rows.weight[i] * (adjusted.prior.centre[c] - adjusted.fitted.state.xi[c]);
  }
  return rows;
}

void list_changes(const Bench& bench, const Changeable& changeable, const Posterior& posterior,
                  Comparison& result) {
  for (const auto& [cause, probability] : posterior.cause) {
    if (probability < kListed) continue;
    Change change{cause.first, cause.second, std::min(probability, 1.0), {}};
    for (const Hypothesis& h : posterior.hypotheses) {
      const Workbench::Estimate estimate = bench.workbench(h.structure).estimate(bench.terms(h));
      Eigen::Index at = 0;
      bool found = false;
      for (const int c : h.candidates) {
        const Candidate& each = changeable.candidates.list[static_cast<size_t>(c)];
        for (const int k : each.main) {
          const EffectParameter& p = changeable.parameters[static_cast<size_t>(k)];
          if (each.effect == cause.first && each.at == cause.second) {
            found = true;
            change.values.push_back({p.name, p.unit, estimate.mean[at],
                                     std::sqrt(estimate.variance * estimate.covariance(at, at)),
                                     p.usual_least, p.usual_most});
          }
          ++at;
        }
      }
      if (found) break;
    }
    result.changes.push_back(std::move(change));
  }
  std::sort(result.changes.begin(), result.changes.end(),
            [](const Change& a, const Change& b) { return a.probability > b.probability; });
}

std::string in_words(const Comparison& result) {
  std::string text;
  for (const Change& each : result.changes)
    if (each.probability > 0.5)
      text += (text.empty() ? "changed: " : ", ") + each.effect + " at " + each.where;
  if (!text.empty()) return text;
  return result.none > 0.5 ? "nothing changed that these rows would show"
                           : "something changed, but not one known thing alone";
}

}  // namespace

Comparison compare(const std::shared_ptr<const Robot>& robot, const DataSet& before,
                   const DataSet& after, const DiagnosisOptions& options) {
  Comparison result;
  if (before.rows.q.cols() != after.rows.q.cols()) {
    result.problem = "the two data sets are of robots with different joints";
    return result;
  }
  const auto geometry = geometry_of(robot);
  const DataSet all = merged(before, after);
  const Equations equations(*geometry, all, Use::fit);
  Options free;
  free.free = {"K*"};
  free.most_rejected = options.most_rejected;
  const Adjusted adjusted = adjust(equations, free, {});
  std::vector<Scale> noise = adjusted.fitted.noise.estimated;
  const DenseEquations dense =
      equations.dense(adjusted.fitted.state, noise, adjusted.fitted.noise.put_aside);
  const Changeable changes = changeable(*geometry, equations, before, after);
  const Whitened rows = whitened(dense, adjusted, equations, changes, before.rows.rows());
  Eigen::MatrixXd tips(all.rows.rows(), 3);
  for (int row = 0; row < all.rows.rows(); ++row)
    tips.row(row) =
        geometry->link_poses(all.rows.q.row(row).transpose()).back().translation().transpose();
  const Bench bench(
      rows, structures(all.rows, dense, tips, dense.W(Eigen::all, reading_columns(*geometry))),
      changes.candidates, changes.parameters, options.search);
  const Posterior posterior = bench.search();
  result.none = posterior.none;
  result.unknown = posterior.unknown;
  list_changes(bench, changes, posterior, result);
  result.why = in_words(result);
  return result;
}

}  // namespace selfcal
