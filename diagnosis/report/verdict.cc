#include "diagnosis/report/verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <optional>

#include "diagnosis/constants.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

[[gnu::format(printf, 1, 2)]] std::string phrase(const char* format, ...) {
  char text[300];
  va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  return text;
}

/// "backlash at j1, j2 and j3".
std::string with_places(const CauseResult& cause) {
  std::string words = cause.effect;
  for (size_t i = 0; i < cause.where.size(); ++i)
    words += (i == 0 ? " at " : i + 1 == cause.where.size() ? " and " : ", ") + cause.where[i];
  return words;
}

/// ", or what these rows cannot tell from it (…)"; empty without look-alikes.
std::string look_alikes(const CauseResult& cause) {
  std::string words;
  for (size_t i = 0; i < cause.confounded_with.size() && i < kDiagnosis.report.most_look_alikes;
       ++i)
    words +=
        (i == 0 ? ", or what these rows cannot tell from it (" : ", ") + cause.confounded_with[i];
  return words.empty() ? words : words + ")";
}

std::string with_shape(const CauseResult& cause) {
  return with_places(cause) + (cause.shape.empty() ? "" : " (" + cause.shape + ")");
}

std::string one_cause(const CauseResult& verdict, double p) {
  const std::string alike = look_alikes(verdict);
  std::string words = with_shape(verdict) + alike + (alike.empty() ? "" : ",") +
                      phrase(" causes the gap (probability %.2f", verdict.probability);
  if (!verdict.confounded_with.empty()) words += phrase(", with these %.2f", verdict.together);
  return words + phrase(", p %.2g)", p);
}

/// What leaves more than before closes nothing.
std::string percent(double share) {
  return share < 0.005 ? "nothing" : phrase("%.0f %%", 100 * share);
}

std::string several_causes(const std::vector<CauseResult>& named, double p) {
  std::string words;
  for (size_t i = 0; i < named.size(); ++i) {
    const CauseResult& each = named[i];
    words += (i == 0                  ? ""
              : i + 1 == named.size() ? " and "
                                      : ", ") +
             with_shape(each) + look_alikes(each) + phrase(" (probability %.2f", each.probability);
    if (each.closes_alone && each.closes_beside)
      words += ", alone it closes " + percent(*each.closes_alone) + ", beside the others " +
               percent(*each.closes_beside);
    words += ")";
  }
  return words + phrase(" cause the gap together (p %.2g)", p);
}

/// ", beside structure that …" where there is that as well; empty where what is named may be it.
std::string beside_the_unknown(const Diagnosis& diagnosis) {
  for (const CauseResult& each : diagnosis.named)
    if (std::ranges::count(each.confounded_with, kUnknown) > 0) return {};
  for (const CauseResult& each : diagnosis.candidates)
    if (each.effect == kUnknown && each.probability > kDiagnosis.report.beside)
      return phrase(", beside structure that no known effect explains (probability %.2f)",
                    each.probability);
  return {};
}

std::string unusual_sizes(const std::vector<CauseResult>& named) {
  std::string words;
  for (const CauseResult& each : named)
    for (const NamedValue& v : each.parameters)
      if (std::abs(v.value) - kDiagnosis.report.sigmas * v.sigma >
          kDiagnosis.report.far_beyond * v.usual_most)
        words += "; " + v.name + " = " + in_readable_unit(v.value, v.unit) +
                 " is far beyond the usual " + in_readable_unit(v.usual_least, v.unit) + " to " +
                 in_readable_unit(v.usual_most, v.unit) + ": something else may look like it";
  return words;
}

/// Causes that are more probable than none, though noise may have made them: "backlash at j1 0.41".
std::string likelier_than_none(const Diagnosis& diagnosis) {
  std::string words;
  for (const CauseResult& each : diagnosis.candidates)
    if (names_effect(each.effect) && each.probability > diagnosis.verdict.probability)
      words += (words.empty() ? "" : ", ") + with_places(each) + phrase(" %.2f", each.probability);
  return words;
}

/// ": rows near each other in the cell err alike; look at the machine, or …".
std::string of_unknown(std::optional<KernelDomain> domain) {
  const std::string advice =
      domain == KernelDomain::same
          ? "look at the machine, or go to some of them again from elsewhere: what a robot does "
            "not repeat looks like this"
          : "look at the machine, or repeat some configurations to be sure of the noise";
  return ": " + (domain ? std::string(in_words(*domain)) + "; " : std::string()) + advice;
}

std::string no_cause(const Diagnosis& diagnosis) {
  if (const std::string likelier = likelier_than_none(diagnosis); !likelier.empty())
    return "no cause is named: these rows do not settle it (" + likelier +
           phrase(", none %.2f; as much is found in %.2g of resampled rows)",
                  diagnosis.verdict.probability, diagnosis.p_value);
  if (diagnosis.p_value > DiagnosisOptions{}.name_below_p)
    return phrase(
        "no cause is named: noise alone explains what calibration leaves (as much is found in %.2g "
        "of resampled rows)",
        diagnosis.p_value);
  return phrase(
      "no cause is named: what calibration leaves may be noise (probability %.2g), though "
      "resampled "
      "rows show as much in %.2g of cases only",
      diagnosis.verdict.probability, diagnosis.p_value);
}

}  // namespace

std::string verdict_in_words(const Diagnosis& diagnosis) {
  const CauseResult& verdict = diagnosis.verdict;
  if (verdict.effect == kNone) return no_cause(diagnosis);
  if (verdict.effect != kUnknown)
    return (diagnosis.named.size() > 1 ? several_causes(diagnosis.named, diagnosis.p_value)
                                       : one_cause(verdict, diagnosis.p_value)) +
           beside_the_unknown(diagnosis) + unusual_sizes(diagnosis.named);
  std::string beside;
  for (const CauseResult& each : diagnosis.candidates)
    if (names_effect(each.effect) && each.of_its_kind() > kDiagnosis.report.beside)
      beside += (beside.empty() ? ", beside " : ", ") + with_places(each);
  return "there is structure that no known effect explains" +
         phrase(" (probability %.2f, p %.2g)", verdict.probability, diagnosis.p_value) + beside +
         of_unknown(diagnosis.unknown) + unusual_sizes(diagnosis.named);
}

}  // namespace selfcal
