// First the verdict in a sentence, then the gap, the causes, where it lies, what to do next.
#include "app/report/diagnosis_summary.h"

#include <cmath>

#include "app/report/format.h"
#include "app/report/gap_words.h"

namespace selfcal {
namespace {

constexpr size_t kMostListedCauses = 6;

std::string gap_lines(const Diagnosis& diagnosis) {
  const Gap& gap = diagnosis.gap;
  if (gap.rows == 0) return "No rows are kept aside: how far the gap closes was not judged.\n";
  std::string text = printed("Gap: %.4g mm with the maker's figures, %.4g mm calibrated",
                             1e3 * gap.rms_nominal, 1e3 * gap.rms_before);
  if (const std::string named = named_in_words(diagnosis); !named.empty())
    text += printed(", %.4g mm with ", 1e3 * gap.rms_after) + named;
  if (const std::string found = found_in_words(diagnosis); !found.empty())
    text += printed(", %.4g mm with ", 1e3 * gap.rms_all) + found;
  text += printed("; noise %.4g mm (rms, %d rows %s)\n", 1e3 * gap.noise_floor, gap.rows,
                  gap.judged_on == "folds" ? "judged by the others in turn" : "kept aside");
  if (const std::string closed = closed_in_words(diagnosis); !closed.empty())
    text += "     " + closed + "\n";
  if (const std::string left_out = false_rows_in_words(diagnosis); !left_out.empty())
    text += "     " + left_out + "\n";
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
    for (size_t p = 0;
         p < each.parameters.size() && each.probability > 0.5 && p < kMostListedCauses; ++p) {
      const NamedValue& v = each.parameters[p];
      text += printed("                 %s = %.3g ± %.1g %s (usual %.1g to %.1g)\n", v.name.c_str(),
                      v.value, v.sigma, v.unit.c_str(), v.usual_least, v.usual_most);
    }
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

}  // namespace

std::string summary(const Diagnosis& diagnosis) {
  std::string text = diagnosis.why + "\n" + gap_lines(diagnosis);
  text += cause_lines(diagnosis.candidates);
  const std::string where = share_line("by joint:", diagnosis.where.by_joint) +
                            share_line("by set:  ", diagnosis.where.by_set);
  if (!where.empty()) text += "\nWhere what calibration leaves lies:\n" + where;
  if (!diagnosis.next.empty()) text += "\nNext:\n";
  for (const NextStep& step : diagnosis.next) text += "  " + step.what + next_in_words(step) + "\n";
  if (!diagnosis.next_why.empty())
    text += (diagnosis.next.empty() ? "\nNext: nothing; " : "  ") + diagnosis.next_why + "\n";
  if (!diagnosis.rejected.empty())
    text += printed("\n%d rows put aside as false (diagnosis.json names them)\n",
                    static_cast<int>(diagnosis.rejected.size()));
  for (const std::string& warning : diagnosis.warnings) text += "note: " + warning + "\n";
  return text;
}

}  // namespace selfcal
