#include "diagnosis/compare.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "constraints/adjustment.h"
#include "diagnosis/changeable.h"
#include "diagnosis/rows.h"
#include "diagnosis/structures.h"
#include "diagnosis/view.h"
#include "kinematics/corrected_robot.h"

namespace selfcal {
namespace {

constexpr double kListed = 0.02;
constexpr size_t kSearched = 3;  ///< candidates that the search puts together
constexpr size_t kMostDifferences = 60;

/// What is noise and what is false within each of the two: a change is neither.
struct Within {
  std::vector<Scale> noise;     ///< by set of both
  std::vector<char> put_aside;  ///< by row of both
};

Within within(const Robot& robot, const DataSet& before, const DataSet& after,
              const std::vector<Set>& sets, const Options& options, const Progress& progress) {
  Within of;
  of.noise.assign(sets.size(), {0, 0});
  std::vector<double> rows(sets.size(), 0);
  for (const DataSet* part : {&before, &after}) {
    const Equations equations(robot, *part, Use::fit);
    const Fit fit = adjust(equations, options, progress).fitted;
    of.put_aside.insert(of.put_aside.end(), fit.noise.put_aside.begin(), fit.noise.put_aside.end());
    const std::vector<Scale> noise = pooled_noise(*part, fit);
    for (const RowResidual& r : fit.at.residuals) {
      const auto s = static_cast<size_t>(same_set(sets, part->sets[r.set]));
      of.noise[s].length += std::pow(noise[r.set].length, 2);
      of.noise[s].angle += std::pow(noise[r.set].angle, 2);
      rows[s] += 1;
    }
  }
  for (size_t s = 0; s < rows.size(); ++s)
    of.noise[s] = rows[s] > 0 ? Scale{std::sqrt(of.noise[s].length / rows[s]),
                                      std::sqrt(of.noise[s].angle / rows[s])}
                              : Scale{};
  return of;
}

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

/// The candidate's values, as the hypothesis that holds it has them.
std::vector<NamedValue> values(const Bench& bench, const Changeable& changeable,
                               const Hypothesis& h, int candidate) {
  const Workbench::Estimate estimate = bench.workbench(h.structure).estimate(bench.terms(h));
  std::vector<NamedValue> list;
  Eigen::Index at = 0;
  for (const int c : h.candidates)
    for (const int k : changeable.candidates.list[static_cast<size_t>(c)].main) {
      const EffectParameter& p = changeable.parameters[static_cast<size_t>(k)];
      if (c == candidate)
        list.push_back({p.name, p.unit, estimate.mean[at],
                        std::sqrt(estimate.variance * estimate.covariance(at, at)), p.usual_least,
                        p.usual_most});
      ++at;
    }
  return list;
}

/// What the search found: at most three at a time.
void list_searched(const Bench& bench, const Changeable& changeable, const Posterior& posterior,
                   Comparison& result) {
  for (const Hypothesis& h : posterior.hypotheses)
    if (h.candidates.empty()) result.none += std::exp(h.log_weight);
  result.none = std::min(result.none, 1.0);
  result.unknown = std::min(posterior.unknown, 1.0);
  const std::vector<Candidate>& list = changeable.candidates.list;
  for (int c = 0; c < static_cast<int>(list.size()); ++c) {
    const auto found = posterior.cause.find({list[c].effect, list[c].at});
    if (found == posterior.cause.end() || found->second < kListed) continue;
    const auto h = std::ranges::find_if(posterior.hypotheses, [&](const Hypothesis& each) {
      return std::ranges::count(each.candidates, c) > 0;
    });
    result.changes.push_back({list[c].effect, list[c].at, std::min(found->second, 1.0),
                              values(bench, changeable, *h, c)});
  }
}

/// More than the search puts together: as much as the rows speak for. Each is as probable as the
/// whole with it is beside the whole without, structure as all of them are beside noise alone.
void list_grown(const Bench& bench, const Changeable& changeable, const Hypothesis& from,
                Comparison& result) {
  Hypothesis all = bench.grow({from.candidates, 0, 0, from.sizes}, kMostDifferences);
  const auto weight = [&](Hypothesis h, int structure) {
    h.structure = structure;
    return bench.log_weight(h);
  };
  const double plain = weight(all, 0);
  double noise = 0, structure = 0, best = plain;
  for (int s = 0; s < bench.structures(); ++s) {
    const double each = weight(all, s);
    (bench.structure(s).kind == 0 ? noise : structure) += std::exp(std::min(each - plain, 500.0));
    if (each > best) all.structure = s;
    best = std::max(best, each);
  }
  result.unknown = structure / (noise + structure);
  for (size_t i = 0; i < all.candidates.size(); ++i) {
    Hypothesis less = all;
    less.candidates.erase(less.candidates.begin() + static_cast<std::ptrdiff_t>(i));
    less.sizes.erase(less.sizes.begin() + static_cast<std::ptrdiff_t>(i));
    const Candidate& each = changeable.candidates.list[static_cast<size_t>(all.candidates[i])];
    const double probability = 1 / (1 + std::exp(weight(less, all.structure) - best));
    if (probability >= kListed)
      result.changes.push_back(
          {each.effect, each.at, probability, values(bench, changeable, all, all.candidates[i])});
  }
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
  const Within apart = within(*geometry, before, after, all.sets, free, progress);
  const Adjusted adjusted = adjust(equations, free, progress);
  if (progress) progress("weighing what changed", 0.5);
  const DenseEquations dense =
      weighed(equations.dense(adjusted.fitted.state, apart.noise, apart.put_aside), before.rows,
              after.rows);
  const Changeable changes = changeable(equations, dense.W, before, after, between);
  const Whitened rows = whitened(dense, adjusted, equations, changes, before.rows.rows());
  const auto bench = [&](bool noise_is_known) {
    SearchRule rule = options.search;
    rule.noise_is_known = noise_is_known;
    return Bench(rows,
                 structures(all.rows, dense, tips(*geometry, all.rows),
                            dense.W(Eigen::all, reading_columns(*geometry))),
                 changes.candidates, changes.parameters, rule);
  };
  Comparison result;
  Hypothesis best;
  {
    const Bench searched = bench(false);
    const Posterior posterior = searched.search();
    best = posterior.hypotheses.front();
    if (best.candidates.size() < kSearched) list_searched(searched, changes, posterior, result);
  }
  if (best.candidates.size() >= kSearched) list_grown(bench(true), changes, best, result);
  std::ranges::stable_sort(result.changes, std::greater(), &Change::probability);
  result.why = in_words(result);
  return result;
}

}  // namespace selfcal
