// First the verdict in a sentence, then the gap, what to do next, the causes, where it lies.
#include "app/report/diagnosis_summary.h"

#include <algorithm>
#include <cmath>

#include "app/report/format.h"
#include "app/report/gap_report.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

constexpr size_t kMostListedCauses = 6;

std::string millimetres(double metres) { return plain_figure(1e3 * metres, 4); }

std::string gap_lines(const Diagnosis& diagnosis) {
  const Gap& gap = diagnosis.gap;
  if (gap.rows == 0)
    return "How far the gap closes was not judged: " + diagnosis.gap_unjudged + ".\n";
  std::string text =
      printed("Gap: %s mm with the maker's figures, %s mm calibrated",
              millimetres(gap.rms_nominal).c_str(), millimetres(gap.rms_before).c_str());
  if (const std::string named = named_in_words(diagnosis); !named.empty())
    text += printed(", %s mm with ", millimetres(gap.rms_after).c_str()) + named;
  if (const std::string found = found_in_words(diagnosis); !found.empty())
    text += printed(", %s mm with ", millimetres(gap.rms_all).c_str()) + found;
  text +=
      printed("; noise %s mm (rms, %d rows %s)\n", millimetres(gap.noise_floor).c_str(), gap.rows,
              gap.validated_on == "folds" ? "judged by the others in turn" : "kept aside");
  if (const std::string closed = closed_in_words(diagnosis); !closed.empty())
    text += "     " + closed + "\n";
  if (const std::string left_out = false_rows_in_words(diagnosis); !left_out.empty())
    text += "     " + left_out + "\n";
  return text;
}

/// A line each of those that stand out from zero, and one of all others.
std::string parameter_lines(const std::vector<NamedValue>& parameters) {
  const std::string indent(17, ' ');
  std::string text;
  std::vector<std::string> near_zero;
  for (size_t p = 0; p < parameters.size() && p < kMostListedCauses; ++p) {
    const NamedValue& v = parameters[p];
    const ReadableUnit unit = readable_unit(v.unit, std::max(std::abs(v.value), v.sigma));
    const std::string doubt = "± " + plain_figure(unit.factor * v.sigma, 2) + " " + unit.name;
    if (std::abs(v.value) < v.sigma) {
      near_zero.push_back(v.name + " (" + doubt + ")");
      continue;
    }
    text += indent + v.name + " = " + plain_figure(unit.factor * v.value) + " " + doubt +
            " (usual " + plain_figure(unit.factor * v.usual_least, 1) + " to " +
            plain_figure(unit.factor * v.usual_most, 1) + ")\n";
  }
  if (!near_zero.empty()) text += indent + "not told from zero: " + listed(near_zero) + "\n";
  return text;
}

std::string cause_lines(const std::vector<CauseResult>& causes) {
  std::string text = "\n  probability  cause\n";
  for (size_t i = 0; i < causes.size() && i < kMostListedCauses; ++i) {
    const CauseResult& each = causes[i];
    if (i > 2 && each.probability < 0.02) break;
    text += printed("  %9.3f    ", each.probability) + effect_in_words(each.effect) +
            places_in_words(each.where);
    if (!each.shape.empty()) text += " " + each.shape;
    if (each.visible > 0) text += printed(", visible %.2g times the noise", each.visible);
    text += "\n";
    if (each.of_its_kind() > 0.5) text += parameter_lines(each.parameters);
  }
  return text;
}

template <class Shares>
std::string share_line(const char* title, const Shares& shares) {
  std::string text;
  for (const auto& each : shares)
    if (each.share > 0.02) text += printed("  %s %.0f %%", each.name.c_str(), 100 * each.share);
  return text.empty() ? "" : std::string("  ") + title + text + "\n";
}

std::string next_lines(const Diagnosis& diagnosis) {
  std::string text;
  if (!diagnosis.next.empty()) text += "\nNext:\n";
  for (const NextStep& step : diagnosis.next) text += "  " + step.what + next_in_words(step) + "\n";
  if (!diagnosis.next_why.empty())
    text += (diagnosis.next.empty() ? "\nNext: nothing: " : "  ") + diagnosis.next_why + "\n";
  return text;
}

}  // namespace

std::string summary(const Diagnosis& diagnosis) {
  std::string text = diagnosis.why + "\n" + gap_lines(diagnosis) + next_lines(diagnosis);
  text += cause_lines(diagnosis.candidates);
  const std::string where = share_line("by joint:", diagnosis.where.by_joint) +
                            share_line("by set:  ", diagnosis.where.by_set);
  if (!where.empty()) text += "\nWhere what calibration leaves lies:\n" + where;
  if (!diagnosis.outliers.empty())
    text += "\n" + counted(static_cast<std::int64_t>(diagnosis.outliers.size()), "row") +
            " put aside as false (diagnosis.json names them)\n";
  for (const std::string& warning : diagnosis.warnings) text += "note: " + warning + "\n";
  return text;
}

}  // namespace selfcal
