#include "diagnosis/comparison/compare.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "diagnosis/comparison/pair.h"
#include "diagnosis/constants.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

/// The candidate's values, as the hypothesis that holds it has them.
std::vector<NamedValue> values_held(const EvidenceEvaluator& evaluator,
                                    const Changeable& changeable, const Hypothesis& h,
                                    int candidate) {
  const MarginalLikelihood::Estimate estimate =
      evaluator.marginal_likelihood(h.structure).estimate(evaluator.terms(h));
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
void list_searched(const EvidenceEvaluator& evaluator, const Changeable& changeable,
                   const Posterior& posterior, Comparison& result) {
  for (const Hypothesis& h : posterior.hypotheses)
    if (h.candidates.empty()) result.none += std::exp(h.log_weight);
  result.none = std::min(result.none, 1.0);
  result.unknown = std::min(posterior.unknown, 1.0);
  const std::vector<Candidate>& list = changeable.candidates.list;
  for (int c = 0; c < static_cast<int>(list.size()); ++c) {
    const auto found = posterior.cause.find({list[c].effect, list[c].at});
    if (found == posterior.cause.end() || found->second < kDiagnosis.comparison.listed) continue;
    const auto h = std::ranges::find_if(posterior.hypotheses, [&](const Hypothesis& each) {
      return std::ranges::count(each.candidates, c) > 0;
    });
    result.changes.push_back({list[c].effect, list[c].at, std::min(found->second, 1.0),
                              values_held(evaluator, changeable, *h, c)});
  }
}

/// More than the search puts together. Each is as probable as the
/// whole with it is beside the whole without, structure as all of them are beside noise alone.
void list_grown(const EvidenceEvaluator& evaluator, const Changeable& changeable, Hypothesis all,
                Comparison& result) {
  const auto weight = [&](Hypothesis h, int structure) {
    h.structure = structure;
    return evaluator.log_weight(h);
  };
  const double plain = weight(all, 0);
  double noise = 0, structure = 0, best = plain;
  for (int s = 0; s < evaluator.structures(); ++s) {
    const double each = weight(all, s);
    (evaluator.structure(s).kind == 0 ? noise : structure) +=
        std::exp(std::min(each - plain, 500.0));
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
    if (probability >= kDiagnosis.comparison.listed)
      result.changes.push_back({each.effect, each.at, probability,
                                values_held(evaluator, changeable, all, all.candidates[i])});
  }
}

/// The most probable set of changes; what is probable of them goes into `result`.
Hypothesis weigh(const Pair& pair, const DenseEquations& rows, SearchRule rule,
                 Comparison& result) {
  Hypothesis best;
  {
    const EvidenceEvaluator evaluator = pair.evaluator(rows, rule);
    const Posterior posterior = evaluator.search();
    best = posterior.hypotheses.front();
    if (best.candidates.size() < kDiagnosis.comparison.most_together) {
      list_searched(evaluator, pair.changes(), posterior, result);
      return best;
    }
  }
  rule.noise_is_known = true;
  const EvidenceEvaluator evaluator = pair.evaluator(rows, rule);
  best =
      evaluator.grow({best.candidates, 0, 0, best.sizes}, kDiagnosis.comparison.most_differences);
  list_grown(evaluator, pair.changes(), best, result);
  return best;
}

/// What changed while the sets of `after` that stand elsewhere have been parted from those of
/// `before`.
Comparison compared(const std::shared_ptr<const Robot>& geometry, const FittedSession& before,
                    const FittedSession& after, Between between, const DiagnosisOptions& options,
                    const Progress& progress) {
  const Pair pair(geometry, before, after, between, options, progress);
  Comparison result;
  std::vector<char> outlier = pair.outlier();
  for (int pass = 0; pass < kDiagnosis.comparison.passes; ++pass) {
    const DenseEquations rows = pair.weighed(outlier);
    result = {};
    const Hypothesis best = weigh(pair, rows, options.search, result);
    std::vector<char> far = pair.outliers_among(rows, best);
    if (far == outlier) break;
    outlier = std::move(far);
  }
  return result;
}

/// How far the rows of each set of `after` are off where that set stands where `before` has it
/// (rms; m, or rad of sets without lengths); 0 where it is not in both or has no place of its own.
std::vector<double> moved(const Robot& geometry, const FittedSession& before,
                          const FittedSession& after) {
  const std::vector<Set>& sets = after.data.sets;
  const Equations equations(geometry, after.data, Use::fit);
  State state = after.fit.state;
  std::vector<char> in_both(sets.size(), 0);
  for (size_t s = 0; s < sets.size(); ++s) {
    const int same = same_set(before.data.sets, sets[s]);
    in_both[s] = same >= 0 && equations.tangent_dimension(static_cast<int>(s)) > 0 &&
                 before.fit.rows[same] > 0 && after.fit.rows[s] > 0;
    if (in_both[s]) state.nuisance[s] = before.fit.state.nuisance[same];
  }
  std::vector<double> squares(sets.size(), 0), count(sets.size(), 0), rms(sets.size(), 0);
  for (const RowResidual& row : equations.residuals(state)) {
    if (!in_both[row.set] || after.fit.noise.outlier[row.row]) continue;
    squares[row.set] += std::pow(sets[row.set].method->has_lengths() ? row.length : row.angle, 2);
    count[row.set] += 1;
  }
  for (size_t s = 0; s < rms.size(); ++s)
    if (count[s] > 0) rms[s] = std::sqrt(squares[s] / count[s]);
  return rms;
}

/// Surfaces and instruments that stand elsewhere, by so much that nothing else explains it.
std::vector<Change> stand_elsewhere(const Robot& geometry, const FittedSession& before,
                                    const FittedSession& after, Between between) {
  std::vector<Change> list;
  const std::vector<double> by = moved(geometry, before, after);
  for (size_t s = 0; s < by.size(); ++s) {
    const Set& set = after.data.sets[s];
    const bool lengths = set.method->has_lengths();
    const double size = lengths ? size_of(geometry) : 1;
    const double limit = kDiagnosis.comparison.elsewhere * size;
    if (by[s] <= limit) continue;
    const Scale& noise = after.fit.noise.estimated[s];
    const double sigma = (lengths ? noise.length : noise.angle) / std::sqrt(after.fit.rows[s]);
    list.push_back(
        {fixture_moved(between),
         set.name,
         1,
         {{"rows off by", lengths ? "m" : "rad", by[s], sigma,
           size * kDiagnosis.comparison.usual_least, size * kDiagnosis.comparison.usual_most}}});
  }
  return list;
}

/// Adds the changes that say so of a set; the values of base and tool are the robot's parameters.
/// False where there is none.
bool add_moved(const Robot& geometry, const Comparison& result, Between between,
               std::vector<Change>& elsewhere) {
  const size_t had = elsewhere.size();
  for (const Change& each : result.changes)
    if (each.effect == fixture_moved(between) && each.probability > kDiagnosis.naming.probable &&
        find_parameter(geometry, each.values.front().name) < 0)
      elsewhere.push_back(each);
  return elsewhere.size() > had;
}

/// Beside a change that no parameter stands for, those that are listed may stand in for it.
std::string changes_in_words(const Comparison& result) {
  const bool more = result.unknown > kDiagnosis.naming.probable;
  std::string text;
  for (const Change& each : result.changes)
    if (each.probability > kDiagnosis.naming.probable)
      text += (text.empty() ? "" : ", ") + each.effect + " at " + each.where;
  if (!text.empty() && more)
    return "something changed that no known change explains: compare what causes the gap in each. "
           "Nearest to it are, perhaps in its place: " +
           text;
  if (!text.empty()) return "changed: " + text;
  return result.none > kDiagnosis.naming.probable
             ? "nothing changed that these rows would show"
             : "something changed, but not one known thing alone";
}

}  // namespace

std::string incomparable(const Robot& one, const Robot& other) {
  if (one.text().identity() == other.text().identity()) return {};
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

std::string incomparable(const DataSet& data) {
  size_t equations = 0;
  for (size_t row = 0; row < data.rows.check.size(); ++row)
    if (!data.rows.check[row])
      equations += data.sets[data.rows.set[row]].method->equations().size();
  if (static_cast<double>(equations) >= kDiagnosis.rows.fewest_freedoms) return {};
  return "has " + std::to_string(equations) +
         " equations in rows that are not `part: check`: at least " +
         format_number(kDiagnosis.rows.fewest_freedoms) + " are needed to compare with";
}

Comparison compare(const std::shared_ptr<const Robot>& robot, const DataSet& before,
                   const DataSet& after, Between between, const DiagnosisOptions& options,
                   const Progress& progress) {
  const std::shared_ptr<const Robot> geometry = geometry_of(robot);
  const FittedSession first(*geometry, before, options, progress);
  const FittedSession second(*geometry, after, options, progress);
  if (progress) progress("weighing what changed", 0.5);
  std::vector<Change> elsewhere = stand_elsewhere(*geometry, first, second, between);
  Comparison result;
  for (bool again = true; again;) {
    std::vector<std::string> sets;
    for (const Change& each : elsewhere) sets.push_back(each.where);
    result = compared(geometry, first, parted(second, sets), between, options, progress);
    again = add_moved(*geometry, result, between, elsewhere);
  }
  if (!elsewhere.empty()) result.none = 0;
  result.changes.insert(result.changes.end(), elsewhere.begin(), elsewhere.end());
  std::ranges::stable_sort(result.changes, std::greater(), &Change::probability);
  result.why = changes_in_words(result);
  return result;
}

}  // namespace selfcal
