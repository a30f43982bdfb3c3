// An identification in words.
#include "app/report/summary.h"

#include <algorithm>
#include <cmath>

#include "app/report/format.h"
#include "app/report/next_steps.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

constexpr size_t kMostListedItems = 12;
constexpr double kToldShare = 0.1;  ///< of the end position's doubt: less is not told
constexpr double kHardly = 0.9;     ///< of its tolerance: a parameter that is known no better
constexpr double kAlone = 0.9;      ///< share of the scale that one length carries alone

/// "touch" when every row that identifies is one, else "row".
const char* noun(const DataSet& data, const Solution& solution) {
  for (size_t s = 0; s < data.sets.size(); ++s)
    if (solution.sets.size() > s && solution.sets[s].identifies &&
        data.sets[s].method->touches() == TouchedSurface::none)
      return "row";
  return "touch";
}

std::string carried(const ParameterResult& p) {
  std::string text = p.parameter.name + " grouped with ";
  for (size_t i = 0; i < p.grouped_with.size() && i < 2; ++i)
    text += (i ? ", " : "") + p.grouped_with[i].name;
  return text + (p.grouped_with.size() > 2 ? "…" : "");
}

std::string first_line(const DataSet& data, const Solution& solution) {
  const auto count = std::count_if(solution.parameters.begin(), solution.parameters.end(),
                                   [](const auto& p) { return p.status == Status::identified; });
  int rows = 0;
  for (const SetResult& set : solution.sets)
    if (set.identifies) rows += set.rows;
  const std::string of = noun(data, solution);
  std::string text =
      counted(count, "parameter") + " identified from " +
      (of == "touch" && rows != 1 ? std::to_string(rows) + " touches" : counted(rows, of));
  size_t told = 0;
  const std::vector<Note>& held = solution.gauge;
  for (size_t i = 0; i < held.size() && told < 2; ++i) {
    if (i > 0 && held[i].text == held[i - 1].text) continue;  // one of several for one reason
    const bool alone = i + 1 == held.size() || held[i + 1].text != held[i].text;
    text += (told++ ? ", " : "; ") + held[i].parameter + (alone ? "" : "…") + " held";
  }
  for (const ParameterResult& p : solution.parameters)
    if (p.status == Status::grouped && !p.grouped_with.empty() && told < 4)
      text += (told++ ? ", " : "; ") + carried(p);
  return text + "\n";
}

/// Value in the unit that a person reads.
struct Shown {
  double factor;
  const char* unit;
};
Shown shown(const Parameter& parameter) {
  switch (parameter.quantity) {
    case Quantity::length:
      return {1e3, "mm"};
    case Quantity::angle:
      return {1e3, "mrad"};
    case Quantity::ratio:
      return {1e6, "ppm"};
    case Quantity::other:
      break;
  }
  return {1, parameter.other_unit.c_str()};
}

/// Nominal, new, change and sigma of a parameter. A ratio's own value is no ppm.
std::string parameter_line(const ParameterResult& p, int width) {
  const Shown unit = shown(p.parameter);
  const bool ratio = p.parameter.quantity == Quantity::ratio;
  const char* format = p.parameter.part == Part::effect || ratio ? " %11.4g" : " %11.4f";
  std::string text = "  " + padded(full_name(p.parameter), width);
  for (const double value : {p.parameter.nominal, p.value})
    text += printed(ratio ? " %11.7f" : format, (ratio ? 1 : unit.factor) * value);
  for (const double value : {p.value - p.parameter.nominal, p.sigma})
    text += printed(format, unit.factor * value);
  return text + " " + unit.unit + "\n";
}

std::string parameter_table(const Solution& solution) {
  std::vector<const ParameterResult*> moved, still, hardly;
  int grouped = 0, without_effect = 0, width = 9;
  for (const ParameterResult& p : solution.parameters) {
    grouped += p.status == Status::grouped;
    without_effect += p.status == Status::no_effect;
    if (p.status != Status::identified) continue;
    const bool moves = std::abs(p.value - p.parameter.nominal) > p.sigma;
    const bool known = !(p.parameter.tolerance > 0) || p.sigma < kHardly * p.parameter.tolerance;
    (moves ? moved : known ? still : hardly).push_back(&p);
    width = std::max(width, characters(full_name(p.parameter)));
  }
  std::string text = "\n  " + padded("parameter", width) +
                     printed(" %11s %11s %11s %11s\n", "nominal", "new", "change", "sigma");
  for (const ParameterResult* p : moved) text += parameter_line(*p, width);
  if (!still.empty()) text += "  changed by less than their sigma, so perhaps not at all:\n";
  for (const ParameterResult* p : still) text += parameter_line(*p, width);
  if (!hardly.empty())
    text += "  hardly told by these rows, known no better than the maker's tolerance:\n";
  for (const ParameterResult* p : hardly) text += parameter_line(*p, width);
  if (grouped + without_effect > 0)
    text += printed(
        "  and %d grouped with these, %d without effect on these rows (result.json says "
        "which)\n",
        grouped, without_effect);
  return text;
}

template <class Items, class Line>
void list(std::string& text, const char* title, const Items& items, Line line) {
  if (items.empty()) return;
  text += std::string("\n") + title + "\n";
  for (size_t i = 0; i < items.size() && i < kMostListedItems; ++i)
    text += "  " + line(items[i]) + "\n";
  if (items.size() > kMostListedItems)
    text += printed("  and %d more\n", static_cast<int>(items.size() - kMostListedItems));
}

/// In um below a millimetre.
std::string small_length(double metres) {
  return metres < 1e-3 ? plain_figure(1e6 * metres) + " um" : plain_figure(1e3 * metres) + " mm";
}
std::string small_angle(double angle) {
  return angle < 1e-3 ? plain_figure(1e6 * angle) + " urad" : plain_figure(1e3 * angle) + " mrad";
}

std::string set_line(const SetResult& set) {
  std::string text = set.name + " (" + set.method + "): ";
  if (!set.identifies)
    text += printed("%d rows judge%s", set.rows,
                    set.aligned ? ", own unknowns fitted to them (aligned)" : "");
  else
    text += printed("%d of %d rows used", set.used, set.rows);
  if (set.noise_sigma > 0) text += ", noise " + small_length(set.noise_sigma);
  if (set.noise_angle_sigma > 0)
    text += (set.noise_sigma > 0 ? " and " : ", noise ") + small_angle(set.noise_angle_sigma);
  if (set.repeat_sigma >= 0) text += ", of repeats alone " + small_length(set.repeat_sigma);
  if (set.repeat_angle_sigma >= 0)
    text += (set.repeat_sigma >= 0 ? " and " : ", of repeats alone ") +
            small_angle(set.repeat_angle_sigma);
  return text;
}

/// Of a length given: what hangs on it, and from what size on an error in it is noticed.
std::string scale_line(const ScaleLength& each, bool alone) {
  std::string text =
      printed("%s of set %s, %.6g mm", each.what.c_str(), each.set.c_str(), 1e3 * each.value);
  text += alone ? ", alone" : printed(" (%.0f %% of it)", 100 * each.share);
  text += printed(": 0.1 mm of it makes %.2g mm at the end position", 0.1 * each.moves);
  text += printed("; the maker's lengths expect %.6g +- %.2g mm", 1e3 * each.expected,
                  1e3 * each.expected_sigma);
  return text + printed(each.by_others_sigma < 0
                            ? " and notice an error from %.2g mm on"
                            : ", and with the other lengths given notice an error of it alone "
                              "from %.2g mm on",
                        1e3 * each.unseen);
}

/// How the rows kept aside are met. False ones among them count; where they hide what is left of
/// the others these come first.
std::string met(const Solution& solution) {
  const Figures& check = solution.residual.check;
  if (check.rows == 0) return {};
  const char* unit = check.angle_alone ? "mrad" : "mm";
  const auto from_to = [&](double before, double after) {
    return printed("%s %s instead of %s %s", plain_figure(1e3 * after).c_str(), unit,
                   plain_figure(1e3 * before).c_str(), unit);
  };
  const std::string all = from_to(check.rms_before, check.rms_after);
  const std::string what = check.angle_alone ? "directions are met to " : "the tool is met to ";
  const int beyond = check.rows - check.rows_without_outliers;
  const double within = check.rms_without_outliers;
  if (!(within > 0) || beyond == 0 || within >= 0.9 * check.rms_after)
    return what + all + " on " + counted(check.rows, "row") + " kept aside";
  return what + from_to(check.rms_before_without_outliers, within) + " on " +
         counted(check.rows_without_outliers, "row") + " kept aside; with " +
         std::to_string(beyond) + " beyond the noise " + all;
}

}  // namespace

std::string headline(const Solution& solution) {
  const std::string figures = met(solution);
  const bool files_first = std::ranges::any_of(
      solution.warnings, [](const std::string& each) { return each.starts_with(kFilesFirst); });
  if (files_first && solution.verdict.answer != Answer::improved)
    return std::string(solution.verdict.answer == Answer::not_improved ? "Not improved"
                                                                       : "Not determined") +
           ": rows and robot file do not belong together as they are" +
           (figures.empty() ? std::string() : "; " + figures) + ".";
  switch (solution.verdict.answer) {
    case Answer::improved:
      return "Improved: " + figures + ".";
    case Answer::not_improved:
      return std::string("Not improved: ") +
             (seem_met_better(solution.residual)
                  ? "that these rows are met better may be chance, for all that they can tell"
              : lie_apart(solution.residual)
                  ? "the rows kept aside do not belong to those that identify"
                  : "the maker's figures explain the rows as well") +
             (figures.empty() ? std::string() : " (" + figures + ")") + ".";
    case Answer::not_determined:
      break;
  }
  return "Not determined: these rows do not say how the robot really is" +
         (figures.empty() ? std::string() : "; " + figures) + ".";
}

std::string summary(const DataSet& data, const Solution& solution) {
  std::string text = headline(solution) + "\n";
  if (!solution.verdict.why.empty()) text += solution.verdict.why + "\n";
  const auto itself = [](const std::string& each) { return each; };
  if (solution.sets.empty()) {
    list(text, "Next", next_steps(data, solution), itself);
    return text;
  }
  text += first_line(data, solution) + parameter_table(solution);
  list(text, "Sets", solution.sets, set_line);
  const std::vector<ScaleLength>& lengths = solution.scale.stands_on;
  const bool alone = lengths.size() == 1 && lengths.front().share > kAlone;
  list(text, "The scale stands on", lengths,
       [alone](const ScaleLength& each) { return scale_line(each, alone); });
  std::vector<BudgetLine> budget = solution.uncertainty.budget;
  std::erase_if(budget, [&](const BudgetLine& each) {
    return each.sigma < kToldShare * solution.workspace.rms;
  });
  list(text, "The end position's doubt in the workspace (1 sigma)", budget,
       [](const BudgetLine& each) {
         return with_figures("%.3g mm: ", 1e3 * each.sigma) + each.source;
       });
  list(text, "Held", solution.gauge,
       [](const Note& note) { return note.parameter + ": " + note.text; });
  list(text, "Not excited by these rows", solution.unexcited,
       [](const Note& note) { return note.parameter + ": " + note.text; });
  list(text, "Rows beyond the noise", solution.outliers, [](const Outlier& r) {
    const std::string of_row = printed("row %d (%s): ", r.row, r.set.c_str());
    if (!std::isfinite(r.residual)) return of_row + r.why;
    return of_row + plain_figure(1e3 * r.residual) + (r.angle_alone ? " mrad, " : " mm, ") + r.why;
  });
  list(text, "Warnings", solution.warnings, itself);
  list(text, "Next", next_steps(data, solution), itself);
  return text;
}

}  // namespace selfcal
