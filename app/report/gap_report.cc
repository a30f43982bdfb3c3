// Where rows judge each other by thirds, each third is judged by what the others name and find, so
// that the two figures may differ though all that is found of the whole is named.
#include "app/report/gap_report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "app/report/format.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

bool only_named(const Diagnosis& diagnosis) {
  return diagnosis.gap.validated_on == "check" &&
         std::ranges::all_of(diagnosis.found, &FoundEffect::named);
}

/// Whole ones, without the sign of a zero.
double percent(double share) { return std::round(100 * share) + 0.0; }

std::string closed_by(const Closed& closed, const std::string& words) {
  constexpr double kAll = 1.05;  // beyond it less is left than noise
  const std::string share =
      (*closed.fraction > kAll ? "all " : printed("%.0f %% ", percent(*closed.fraction))) + words;
  if (closed.too_few) return share + " (too few rows judge it for an interval)";
  if (!std::isfinite(closed.least + closed.most))
    return share + " (so near the noise that no interval can be given)";
  return share + printed(" (%.0f to %.0f %%)", percent(closed.least), percent(closed.most));
}

}  // namespace

std::string effect_in_words(std::string effect) {
  std::ranges::replace(effect, '_', ' ');
  return effect;
}

std::string places_in_words(const std::vector<std::string>& where) {
  return where.empty() ? "" : " at " + listed(where);
}

std::string named_in_words(const Diagnosis& diagnosis) {
  std::string text;
  for (const CauseResult& each : diagnosis.named)
    text += (text.empty() ? "" : "; ") + effect_in_words(each.effect) + places_in_words(each.where);
  if (text.empty()) return "";
  return text + (only_named(diagnosis) ? " (named; nothing else was found)" : " (named)");
}

std::string found_in_words(const Diagnosis& diagnosis) {
  const Correction& found = diagnosis.found;
  if (found.empty() || only_named(diagnosis)) return "";
  // One at a place may be there in several shapes.
  std::map<std::pair<std::string, std::string>, bool> effects;
  for (const FoundEffect& each : found) effects[{each.what.effect, each.what.at}] |= each.named;
  const auto unnamed = static_cast<size_t>(
      std::ranges::count(effects, false, [](const auto& each) { return each.second; }));
  const std::string which = unnamed == 0                ? "all named"
                            : unnamed == effects.size() ? "none named"
                                                        : printed("%zu of them not named", unnamed);
  return "everything found (" + counted(static_cast<std::int64_t>(effects.size()), "effect") +
         ", " + which + ")";
}

std::string false_rows_in_words(const Diagnosis& diagnosis) {
  const Gap& gap = diagnosis.gap;
  if (gap.false_rows == 0) return "";
  const bool one = gap.false_rows == 1;
  std::string text =
      printed("%d row%s kept aside that no model comes near %s left out; with %s ", gap.false_rows,
              one ? "" : "s", one ? "is" : "are", one ? "it" : "them");
  text += with_figures("%.4g mm calibrated", 1e3 * gap.with_false_rows.before);
  if (!diagnosis.named.empty())
    text += with_figures(", %.4g mm with what is named", 1e3 * gap.with_false_rows.after);
  if (!diagnosis.found.empty())
    text += with_figures(", %.4g mm with everything found", 1e3 * gap.with_false_rows.all);
  return text;
}

std::string gap_in_words(const SimulatorGap& gap) {
  std::string others;
  for (const std::string& each : gap.sets) others += (others.empty() ? "" : ", ") + each;
  if (gap.rows == 0)
    return "how far it is from the robot cannot be said by rows of " + others +
           ", which are told against each other";
  return mm(gap.rms) + " mm from the robot" +
         printed(" on %.0f rows%s (rms)", static_cast<double>(gap.rows),
                 gap.kept_aside ? " kept aside" : "") +
         (others.empty() ? "" : ", those of " + others + " not counted");
}

std::string next_in_words(const NextStep& step) {
  std::string list;
  for (const std::string& each : step.separates)
    if (each != kUnknown) list += (list.empty() ? "" : " or ") + each;
  if (list.empty()) return "";
  if (std::isnan(step.probability_after)) return " (tells " + list + ")";
  return printed(" (then %.0f %% sure, of ", 100 * step.probability_after) + list + ")";
}

std::string closed_in_words(const Diagnosis& diagnosis) {
  const Gap& gap = diagnosis.gap;
  const bool named = !diagnosis.named.empty();
  const bool found = !found_in_words(diagnosis).empty();
  std::string text;
  if (named && gap.closed.fraction)
    text = closed_by(gap.closed, found ? "of what calibration leaves is closed by what is named"
                                       : "of what calibration leaves is closed");
  if (found && gap.closed_all.fraction)
    text += text.empty() ? closed_by(gap.closed_all,
                                     "of what calibration leaves is closed by everything found")
                         : ", " + closed_by(gap.closed_all, "by everything found");
  return text;
}

}  // namespace selfcal
