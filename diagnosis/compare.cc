#include "diagnosis/compare.h"

#include <algorithm>
#include <cmath>

#include "constraints/adjustment.h"
#include "diagnosis/changeable.h"
#include "diagnosis/rows.h"
#include "diagnosis/structures.h"
#include "diagnosis/view.h"
#include "kinematics/corrected_robot.h"

namespace selfcal {
namespace {

constexpr double kListed = 0.02;

/// Of large sessions every so many configurations of each: the smaller one's are worth more.
DenseEquations weighed(const DenseEquations& dense, const Observations& before,
                       const Observations& after) {
  const auto later = [&](int row) { return row >= before.rows(); };
  const auto second = static_cast<double>(std::ranges::count_if(dense.row, later));
  const double first = static_cast<double>(dense.row.size()) - second;
  const auto part = [](double others) { return kMostWeighed - std::min(others, kMostWeighed / 2); };
  std::vector<char> take = weighed_rows(before, first, part(second));
  const std::vector<char> more = weighed_rows(after, second, part(first));
  take.insert(take.end(), more.begin(), more.end());
  return kept(dense, take);
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

std::string incomparable(const Robot& one, const Robot& other) {
  if (one.identity() == other.identity()) return {};
  if (one.name() != other.name())
    return "is of the robot '" + std::string(one.name()) + "', not of '" +
           std::string(other.name()) + "': only data sets of one robot can be compared";
  if (one.joints().size() != other.joints().size())
    return "is of a robot '" + std::string(one.name()) + "' with " +
           std::to_string(one.joints().size()) + " joints instead of " +
           std::to_string(other.joints().size()) + ": only data sets of one robot can be compared";
  return "is of a robot '" + std::string(one.name()) +
         "' with other frames or maker's figures: only data sets of one robot can be compared";
}

Comparison compare(const std::shared_ptr<const Robot>& robot, const DataSet& before,
                   const DataSet& after, Between between, const DiagnosisOptions& options,
                   const Progress& progress) {
  const auto geometry = geometry_of(robot);
  const DataSet all = merged(before, after);
  const Equations equations(*geometry, all, Use::fit);
  Options free;
  free.free = {"K*"};
  free.most_rejected = options.most_rejected;
  const Adjusted adjusted = adjust(equations, free, progress);
  if (progress) progress("weighing what changed", 0.5);
  const Fit& fitted = adjusted.fitted;
  const DenseEquations dense =
      weighed(equations.dense(fitted.state, pooled_noise(all, fitted), fitted.noise.put_aside),
              before.rows, after.rows);
  const Changeable changes = changeable(equations, dense.W, before, after, between);
  const Whitened rows = whitened(dense, adjusted, equations, changes, before.rows.rows());
  const Bench bench(rows,
                    structures(all.rows, dense, tips(*geometry, all.rows),
                               dense.W(Eigen::all, reading_columns(*geometry))),
                    changes.candidates, changes.parameters, options.search);
  const Posterior posterior = bench.search();
  Comparison result;
  for (const Hypothesis& h : posterior.hypotheses)
    if (h.candidates.empty()) result.none += std::exp(h.log_weight);
  result.none = std::min(result.none, 1.0);
  result.unknown = std::min(posterior.unknown, 1.0);
  list_changes(bench, changes, posterior, result);
  result.why = in_words(result);
  return result;
}

}  // namespace selfcal
