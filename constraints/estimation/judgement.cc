// Residual figures and the answer: the end position must be known to the target, and a paired test
// on the check rows (Wilcoxon's signed ranks of |before| - |after|) must say that they improved, at
// 95 %; their squares must fall, and those of their angles must not rise. Where the end position is
// not known to the target, but the check rows are no better and the fitted rows do not contradict
// the maker's figures either, there is nothing to improve: that is an answer too.
#include "constraints/estimation/judgement.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "constraints/statistics.h"
#include "kinematics/expects.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

constexpr double kSignificance = 0.05;
/// Normal quantile of the same, and how much the squares of angles that say little may rise.
constexpr double kRise = 1.645, kLittle = 0.1;
/// The far quantile of NoiseRule: what would have been put aside among the rows that identify.
const double kFar = NoiseRule{}.outlier_quantile;

RowNorm norm_of_row(const RowResidual& r) { return {r.length, r.angle}; }

/// As RowResidual::size, of the same row under the other model.
double size_before(const RowNorm& norm, const RowResidual& same) {
  return same.lengths > 0 ? norm.length : norm.angle;
}

/// Figures of rows that come one by one.
class Tally {
 public:
  void add(const RowNorm& before, const RowResidual& after, bool left_out) {
    add_angle(before, after);
    const double b = size_before(before, after), a = after.size();
    ++f_.rows;
    f_.rms_before += b * b;
    f_.rms_after += a * a;
    f_.mean_after += a;
    f_.max_after = std::max(f_.max_after, a);
    angle_alone_ = angle_alone_ && after.lengths == 0;
    if (left_out) return;
    kept_ += a * a;
    ++kept_rows_;
  }

  Figures figures() const {
    Figures f = f_;
    if (f.rows == 0) return f;
    f.angle_alone = angle_alone_;
    f.rms_before = std::sqrt(f.rms_before / f.rows);
    f.rms_after = std::sqrt(f.rms_after / f.rows);
    f.mean_after /= f.rows;
    f.rms_without_outliers = kept_rows_ > 0 ? std::sqrt(kept_ / kept_rows_) : 0;
    if (f.angle.rows == 0) return f;
    f.angle.rms_before = std::sqrt(f.angle.rms_before / f.angle.rows);
    f.angle.rms_after = std::sqrt(f.angle.rms_after / f.angle.rows);
    f.angle.mean_after /= f.angle.rows;
    return f;
  }

 private:
  void add_angle(const RowNorm& before, const RowResidual& after) {
    if (after.angles == 0) return;
    AngleFigures& f = f_.angle;
    ++f.rows;
    f.rms_before += before.angle * before.angle;
    f.rms_after += after.angle * after.angle;
    f.mean_after += after.angle;
    f.max_after = std::max(f.max_after, after.angle);
  }

  Figures f_;  ///< sums
  bool angle_alone_ = true;
  double kept_ = 0, kept_rows_ = 0;
};

/// Of so many rows every one is shown; of more of them every second, third …
constexpr int kMostFigures = 100000;
int shown_every(const DataSet& data) { return 1 + (data.rows.rows() - 1) / kMostFigures; }

/// Adds those rows of `after` that are shown; `was` says the norms of its i-th row before,
/// `outlier` is by row of the data set.
template <class Was>
void add_figures(const std::vector<RowResidual>& after, const Was& was,
                 const std::vector<RowPlace>& places_before,
                 const std::vector<RowPlace>& places_after, bool check,
                 const std::vector<char>& outlier, int every, std::vector<RowFigure>& rows) {
  size_t shown = 0;
  for (size_t i = 0; i < after.size(); ++i) {
    const RowResidual& a = after[i];
    if (a.row % every != 0) continue;
    const RowNorm b = was(i);
    const bool both = a.lengths > 0 && a.angles > 0;
    rows.push_back({a.row, a.set, check, outlier[a.row] != 0, size_before(b, a), a.size(),
                    both ? b.angle : 0, both ? a.angle : 0, places_after[shown].at,
                    places_before[shown].way, places_after[shown].way});
    ++shown;
  }
}

/// `outlier` and `check_outlier` by row of the data set, of those that identify and of those that
/// judge.
std::vector<RowFigure> row_figures(const DataSet& data, const Judged& before, const Judged& after,
                                   const std::vector<char>& outlier,
                                   const std::vector<char>& check_outlier) {
  const int every = shown_every(data);
  std::vector<RowFigure> rows;
  rows.reserve(1 + (after.fit.size() + after.check.size()) / static_cast<size_t>(every));
  add_figures(
      after.fit, [&](size_t i) { return before.fit_norms[i]; }, before.fit_places, after.fit_places,
      false, outlier, every, rows);
  add_figures(
      after.check, [&](size_t i) { return norm_of_row(before.check[i]); }, before.check_places,
      after.check_places, true, check_outlier, every, rows);
  std::ranges::stable_sort(rows, {}, &RowFigure::row);
  return rows;
}

bool is_outlier(const RowResidual& r, const Judged& judged) {
  return r.sigmas(judged.check_scale[r.set]) > chi_quantile(r.lengths + r.angles, kFar);
}

/// Numbers of the configurations that the rows are of.
std::vector<int> configurations_of(const DataSet& data, const std::vector<RowResidual>& rows) {
  std::vector<int> list;
  list.reserve(rows.size());
  std::map<std::pair<int, int>, int> known;  // by set and repeat
  int count = 0;
  for (const RowResidual& row : rows) {
    const int repeat = data.rows.repeat.empty() ? -1 : data.rows.repeat[row.row];
    const bool added = repeat < 0 || known.try_emplace({row.set, repeat}, count).second;
    list.push_back(added ? count++ : known.at({row.set, repeat}));
  }
  return list;
}

}  // namespace

Judged judge(const Robot& robot, const DataSet& data, const Equations& fit_equations,
             const Fit& fitted, bool norms_alone) {
  Judged judged;
  judged.state = fitted.state;
  if (norms_alone)
    judged.fit_norms = fit_equations.norms(fitted.state);
  else
    judged.fit = fit_equations.residuals(fitted.state);
  judged.fit_places = fit_equations.places(fitted.state, shown_every(data));
  judged.check_scale = fitted.noise.used;
  judged.aligned.assign(data.sets.size(), 0);
  const Equations align(robot, data, Use::align);
  align.start(judged.state);
  Prior held;
  held.free.assign(robot.parameters().size(), 0);
  FitRule rule;
  rule.most_outliers = 0;  // all rows of a placement left out count
  const Fit aligned = fit(align, judged.state, held, rule);
  judged.state = aligned.state;
  judged.align_noise = aligned.noise;
  for (size_t s = 0; s < data.sets.size(); ++s) {
    if (align.plan(static_cast<int>(s)).items.empty()) continue;
    const Method& method = *data.sets[s].method;
    judged.aligned[s] = method.tangent_dimension() + method.group_freedom() > 0;
    if (fit_equations.plan(static_cast<int>(s)).items.empty())
      judged.check_scale[s] = aligned.noise.used[s];
  }
  const Equations check(robot, data, Use::check);
  judged.check = check.residuals(judged.state);
  judged.check_places = check.places(judged.state, shown_every(data));
  judged.open = fit_equations.open_rows();
  judged.open_check = check.open_rows();
  return judged;
}

Residuals residual_figures(const DataSet& data, const Judged& before, const Judged& after,
                           const std::vector<char>& outlier) {
  expects(before.fit_norms.size() == after.fit.size() && before.check.size() == after.check.size(),
          "both models are judged by the same rows");
  Residuals result;
  result.check_rows.reserve(after.check.size());
  Tally fit, check;
  for (size_t i = 0; i < after.fit.size(); ++i)
    if (!outlier[after.fit[i].row]) fit.add(before.fit_norms[i], after.fit[i], false);
  std::vector<char> check_outlier(outlier.size(), 0);
  std::vector<Tally> of_set(data.sets.size());
  const std::vector<int> configuration = configurations_of(data, after.check);
  for (size_t i = 0; i < after.check.size(); ++i) {
    const RowResidual& row = after.check[i];
    const bool is_far = is_outlier(row, after);
    check_outlier[row.row] = is_far;
    result.check_rows.push_back({row.size(), is_far, configuration[i]});
    check.add(norm_of_row(before.check[i]), row, is_far);
    of_set[row.set].add(norm_of_row(before.check[i]), row, is_far);
  }
  result.rows = row_figures(data, before, after, outlier, check_outlier);
  result.fit = fit.figures();
  result.check = check.figures();
  for (const CheckRow& each : result.check_rows)
    result.check.configurations = std::max(result.check.configurations, each.configuration + 1);
  for (size_t s = 0; s < data.sets.size(); ++s)
    if (const Figures figures = of_set[s].figures(); figures.rows > 0)
      result.check_by_set.push_back({data.sets[s].name, after.aligned[s] != 0, figures});
  return result;
}

std::vector<Outlier> outlier_rows(const DataSet& data, const Judged& after,
                                  const std::vector<char>& outlier) {
  std::vector<Outlier> list;
  const auto add = [&](const RowResidual& r, bool check) {
    list.push_back({r.row + 1, data.sets[r.set].name, r.size(), check,
                    check ? "outlier among the check rows: counted all the same" : "outlier",
                    r.lengths == 0});
  };
  for (const RowResidual& r : after.fit)
    if (outlier[r.row]) add(r, false);
  for (const RowResidual& r : after.check)
    if (is_outlier(r, after)) add(r, true);
  for (const std::vector<OpenRow>* rows : {&after.open, &after.open_check})
    for (const OpenRow& open : *rows)
      list.push_back(
          {open.row + 1, data.sets[open.set].name, HUGE_VAL, rows == &after.open_check, open.why});
  std::sort(list.begin(), list.end(),
            [](const Outlier& a, const Outlier& b) { return a.row < b.row; });
  return list;
}

namespace {

/// A false reading: far under both models, each by its own noise, and no farther under the new one
/// than the old one's noise explains. What the new model alone makes far counts, however far it is.
bool is_false(size_t i, const Judged& before, const Judged& after) {
  const RowResidual &b = before.check[i], &a = after.check[i];
  return is_outlier(b, before) && is_outlier(a, after) &&
         a.size() - b.size() <
             (b.lengths > 0 ? chi_quantile(b.lengths, kFar) * before.check_scale[b.set].length
                            : chi_quantile(b.angles, kFar) * before.check_scale[b.set].angle) *
                 b.factor;
}

/// The rows' squares fall, of all and of each set that only judges: many small gains must not
/// outvote one great loss. False readings say nothing of either model.
bool lengths_fall(const Judged& before, const Judged& after) {
  double all = 0;
  std::vector<double> of_set(after.aligned.size(), 0);
  for (size_t i = 0; i < after.check.size(); ++i) {
    if (is_false(i, before, after)) continue;
    const double gain = std::pow(before.check[i].size(), 2) - std::pow(after.check[i].size(), 2);
    all += gain;
    if (after.aligned[after.check[i].set]) of_set[after.check[i].set] += gain;
  }
  return all > 0 && std::ranges::none_of(of_set, [](double gain) { return gain < 0; });
}

/// The squares of a set's angles rise by more than a tenth, and by more than chance explains:
/// angles in which noise outweighs the robot may say nothing, but must not contradict.
bool angles_rise(const Judged& before, const Judged& after) {
  struct Sum {
    double before = 0, loss = 0, squares = 0;
  };
  std::vector<Sum> of_set(after.aligned.size());
  for (size_t i = 0; i < after.check.size(); ++i) {
    if (is_false(i, before, after)) continue;
    const double b = std::pow(before.check[i].angle, 2), a = std::pow(after.check[i].angle, 2);
    Sum& sum = of_set[after.check[i].set];
    sum.before += b;
    sum.loss += a - b;
    sum.squares += std::pow(a - b, 2);
  }
  return std::ranges::any_of(of_set, [](const Sum& sum) {
    return sum.loss > kLittle * sum.before && sum.loss > kRise * std::sqrt(sum.squares);
  });
}

/// How well the end position is known: where it counts, and all over.
std::string certainty(const Grounds& grounds) {
  if (grounds.workspace.poses == 0)
    return "no configuration within the joint limits reaches the workspace";
  if (grounds.workspace.poses < kFewestPoses)
    return "only " + std::to_string(grounds.workspace.poses) +
           " of the configurations tried reach the workspace within the joint limits, " +
           std::to_string(kFewestPoses) + " are needed to say how well the end position is known";
  std::string text =
      with_figures("end position in the workspace known to %.3g mm", 1e3 * grounds.workspace.rms);
  if (grounds.orientation_seen)
    text += with_figures(" and %.3g mrad", 1e3 * grounds.workspace.angle);
  return text +
         with_figures(" (over the whole range of the joints %.3g mm)", 1e3 * grounds.endpoint.rms);
}

/// Of each configuration that judges, on average over its repeats: these share more than their
/// noise, so that one of them says as much as many.
std::vector<double> gains(const Judged& before, const Judged& after, const Residuals& residual) {
  std::vector<double> gain(static_cast<size_t>(residual.check.configurations), 0), count = gain;
  for (size_t i = 0; i < after.check.size(); ++i) {
    const auto at = static_cast<size_t>(residual.check_rows[i].configuration);
    gain[at] += before.check[i].size() - after.check[i].size();
    ++count[at];
  }
  for (size_t at = 0; at < gain.size(); ++at) gain[at] /= count[at];
  return gain;
}

/// What became of the check rows.
std::string change(const Figures& check, double p_value) {
  std::string text = with_figures(
      check.angle_alone ? "check residual %.4g to %.4g mrad" : "check residual %.4g to %.4g mm",
      1e3 * check.rms_before, 1e3 * check.rms_after);
  if (check.angle.rows > 0 && !check.angle_alone)
    text += with_figures(", angles %.3g to %.3g mrad", 1e3 * check.angle.rms_before,
                         1e3 * check.angle.rms_after);
  return text + " (p " + (p_value < 1e-9 ? "< 1e-9" : with_figures("= %.2g", p_value)) + ")";
}

}  // namespace

Verdict verdict(const Judged& before, const Judged& after, const Residuals& residual,
                const Grounds& grounds) {
  Verdict v;
  if (residual.check.rows == 0) {
    v.why = "no check rows to judge by";
    return v;
  }
  v.p_value = signed_rank_p(gains(before, after, residual));
  v.why = change(residual.check, v.p_value) + "; " + certainty(grounds);
  const bool worse_turned = angles_rise(before, after);
  const bool better = v.p_value < kSignificance && lengths_fall(before, after) && !worse_turned;
  if (!grounds.converged) {
    v.why = "the identification did not converge; " + v.why;
  } else if (!grounds.contradictions.empty()) {
    for (const std::string& each : grounds.contradictions) v.why += "; " + each;
  } else if (known_to(grounds.workspace, grounds.target)) {
    v.answer = better ? Answer::improved : Answer::not_improved;
    if (worse_turned) v.why += "; the angles are met worse than before";
  } else {
    if (grounds.workspace.poses >= kFewestPoses)
      v.why += with_figures(", %.3g mm wanted", 1e3 * grounds.target);
    if (better || !grounds.nominal_explains) return v;
    v.answer = Answer::not_improved;
    v.why += "; the rows ask for no other robot than the maker's";
  }
  return v;
}

}  // namespace selfcal
