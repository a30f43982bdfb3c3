// Residual figures: of the rows that identify, and of those that judge, before and after, all of
// them and by set; rows beyond the noise.
#include "constraints/estimation/judgement.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "constraints/statistics.h"
#include "kinematics/expects.h"

namespace selfcal {
namespace {

RowNorm norm_of_row(const RowResidual& r) { return {r.length, r.angle}; }

/// As RowResidual::size, of the same row under the other model.
double size_before(const RowNorm& norm, const RowResidual& same) {
  return same.lengths > 0 ? norm.length : norm.angle;
}

/// Residuals of one unit that come one by one.
struct Sums {
  int rows = 0, kept_rows = 0;
  double before = 0, after = 0, kept_before = 0, kept = 0;  ///< squares
  double mean = 0, max = 0;                                 ///< after; mean is a sum

  void add(double b, double a, bool left_out) {
    ++rows;
    before += b * b;
    after += a * a;
    mean += a;
    max = std::max(max, a);
    if (left_out) return;
    kept_before += b * b;
    kept += a * a;
    ++kept_rows;
  }
  /// Into what has rms_before, rms_after, mean_after and max_after.
  void put(auto& figures) const {
    if (rows == 0) return;
    figures.rms_before = std::sqrt(before / rows);
    figures.rms_after = std::sqrt(after / rows);
    figures.mean_after = mean / rows;
    figures.max_after = max;
  }
};

/// Figures of rows that come one by one.
class Tally {
 public:
  void add(const RowNorm& before, const RowResidual& after, bool left_out) {
    if (after.lengths > 0) lengths_.add(before.length, after.length, left_out);
    if (after.angles > 0) angles_.add(before.angle, after.angle, left_out);
    ++rows_;
    kept_rows_ += !left_out;
  }

  Figures figures() const {
    Figures f;
    if (rows_ == 0) return f;
    f.rows = rows_;
    f.angle_alone = lengths_.rows == 0;
    const Sums& of = f.angle_alone ? angles_ : lengths_;
    of.put(f);
    f.rows_without_outliers = kept_rows_;
    if (of.kept_rows > 0) {
      f.rms_without_outliers = std::sqrt(of.kept / of.kept_rows);
      f.rms_before_without_outliers = std::sqrt(of.kept_before / of.kept_rows);
    }
    f.angle.rows = angles_.rows;
    angles_.put(f.angle);
    return f;
  }

 private:
  int rows_ = 0, kept_rows_ = 0;
  Sums lengths_, angles_;
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

/// Beyond the noise, and not for what predicts it being in doubt.
bool is_to_look_at(const Judged& judged, size_t check_row) {
  return is_outlier(judged.check[check_row], judged) &&
         (judged.foreseen.empty() || judged.foreseen[check_row] == 0);
}

/// Rows kept aside that are no more than what they place themselves, repeats of a configuration
/// counted once, are met exactly by any robot, and judge nothing.
void leave_out_met_exactly(const DataSet& data, const Equations& align, Judged& judged) {
  const std::vector<int> configuration = configurations(data.rows);
  const auto met_exactly = [&](int set) {
    std::set<int> distinct;
    for (const SetPlan::Item& item : align.plan(set).items)
      distinct.insert(configuration[item.row]);
    const auto equations = distinct.size() * data.sets[set].method->equations().size();
    return equations > 0 &&
           static_cast<int>(equations) <= align.tangent_dimension(set) + align.group_freedoms(set);
  };
  std::vector<char> left_out(data.sets.size(), 0);
  for (int set = 0; set < static_cast<int>(data.sets.size()); ++set)
    left_out[set] = judged.aligned[set] && met_exactly(set);
  const int every = shown_every(data);
  std::vector<RowResidual> check;
  std::vector<RowPlace> places;
  std::size_t shown = 0;
  for (const RowResidual& row : judged.check) {
    const bool shows = row.row % every == 0;
    if (!left_out[row.set]) {
      check.push_back(row);
      if (shows) places.push_back(judged.check_places[shown]);
    }
    shown += shows;
  }
  judged.check = std::move(check);
  judged.check_places = std::move(places);
}

}  // namespace

bool is_outlier(const RowResidual& r, const Judged& judged) {
  return r.sigmas(judged.check_scale[r.set]) > chi_quantile(r.lengths + r.angles, kOutlierQuantile);
}

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
    // Too few rows to place a set leave hardly any noise.
    if (fit_equations.plan(static_cast<int>(s)).items.empty() || method.group_freedom() == 0)
      judged.check_scale[s] = aligned.noise.used[s];
  }
  const Equations check(robot, data, Use::check);
  judged.check = check.residuals(judged.state);
  judged.check_places = check.places(judged.state, shown_every(data));
  leave_out_met_exactly(data, align, judged);
  judged.open = fit_equations.open_rows();
  judged.open_check = check.open_rows();
  return judged;
}

std::vector<CheckRow> check_rows(const Judged& judged) {
  std::vector<CheckRow> rows;
  rows.reserve(judged.check.size());
  for (const RowResidual& r : judged.check) {
    const Scale& scale = judged.check_scale[r.set];
    const double sigma = r.lengths > 0 ? scale.length : scale.angle;
    const int scalars = r.lengths > 0 ? r.lengths : r.angles;
    rows.push_back({r.size(), is_outlier(r, judged), 0, r.set, judged.aligned[r.set] != 0, r.angle,
                    chi_quantile(scalars, kOutlierQuantile) * sigma * r.factor, r.row,
                    r.lengths == 0});
  }
  return rows;
}

Residuals residual_figures(const DataSet& data, const Judged& before, const Judged& after,
                           const std::vector<char>& outlier) {
  expects(before.fit_norms.size() == after.fit.size() && before.check.size() == after.check.size(),
          "both models are judged by the same rows");
  Residuals result;
  result.check_rows = check_rows(after);
  Tally fit, check;
  for (size_t i = 0; i < after.fit.size(); ++i)
    if (!outlier[after.fit[i].row]) fit.add(before.fit_norms[i], after.fit[i], false);
  std::vector<char> check_outlier(outlier.size(), 0);
  std::vector<Tally> of_set(data.sets.size());
  const std::vector<int> configuration = configurations(data.rows);
  for (size_t i = 0; i < after.check.size(); ++i) {
    const RowResidual& row = after.check[i];
    result.check_rows[i].configuration = configuration[row.row];
    const bool is_far = is_to_look_at(after, i);
    check_outlier[row.row] = is_far;
    check.add(norm_of_row(before.check[i]), row, is_far);
    of_set[row.set].add(norm_of_row(before.check[i]), row, is_far);
  }
  result.rows = row_figures(data, before, after, outlier, check_outlier);
  result.fit = fit.figures();
  result.check = check.figures();
  std::set<int> judging;
  for (const CheckRow& each : result.check_rows)
    if (each.angle_alone == result.check.angle_alone) judging.insert(each.configuration);
  result.check.configurations = static_cast<int>(judging.size());
  for (size_t s = 0; s < data.sets.size(); ++s)
    if (const Figures figures = of_set[s].figures(); figures.rows > 0)
      result.check_by_set.push_back({data.sets[s].name, after.aligned[s] != 0, figures});
  return result;
}

std::vector<Outlier> outlier_rows(const DataSet& data, const Judged& after,
                                  const std::vector<char>& outlier) {
  std::vector<Outlier> list;
  const auto add = [&](const RowResidual& r, bool check) {
    list.push_back(
        {r.row + 1, data.sets[r.set].name, r.size(), check,
         check ? "beyond the noise among the check rows: counted all the same" : "outlier",
         r.lengths == 0});
  };
  for (const RowResidual& r : after.fit)
    if (outlier[r.row]) add(r, false);
  for (size_t i = 0; i < after.check.size(); ++i)
    if (is_to_look_at(after, i)) add(after.check[i], true);
  for (const std::vector<OpenRow>* rows : {&after.open, &after.open_check})
    for (const OpenRow& open : *rows)
      list.push_back(
          {open.row + 1, data.sets[open.set].name, HUGE_VAL, rows == &after.open_check, open.why});
  std::sort(list.begin(), list.end(),
            [](const Outlier& a, const Outlier& b) { return a.row < b.row; });
  return list;
}

}  // namespace selfcal
