#include "diagnosis/report/verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <optional>

#include "diagnosis/constants.h"
#include "diagnosis/report/named.h"
#include "diagnosis/search/naming.h"
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
  return cause.effect + (cause.where.empty() ? "" : " at " + listed(cause.where));
}

/// "58 % sure"; what rounds to all of it is not.
std::string sure(double probability) {
  return probability < 0.995 ? phrase("%.0f %% sure", 100 * probability) : "over 99 % sure";
}

/// "link_compliance@j1 or backlash@j2", and what no known effect explains in any case; empty
/// without look-alikes.
std::string look_alikes(const CauseResult& cause) {
  std::vector<std::string> words;
  for (const std::string& each : cause.confounded_with)
    if (each != kUnknown && words.size() < kDiagnosis.report.most_look_alikes)
      words.push_back(each);
  if (std::ranges::count(cause.confounded_with, kUnknown) > 0)
    words.emplace_back("what no known effect explains");
  std::string list;
  for (const std::string& each : words) list += (list.empty() ? "" : " or ") + each;
  return list;
}

std::string with_shape(const CauseResult& cause) {
  return with_places(cause) + (cause.shape.empty() ? "" : " (" + cause.shape + ")");
}

/// What leaves more than before closes nothing, and what leaves less than noise closes all.
std::string percent(double share) {
  constexpr double kHardlyAny = 0.005, kAll = 1.05;
  return share < kHardlyAny ? "nothing" : share > kAll ? "all" : phrase("%.0f %%", 100 * share);
}

/// ". It closes 97 % of what calibration leaves; noise alone does as well in …"
std::string worth_of(const Diagnosis& diagnosis, const char* what) {
  const std::optional<double>& closed = diagnosis.gap.closed.fraction;
  const std::string chance =
      phrase("oise alone explains as much in %.2g of cases", diagnosis.p_value);
  if (!closed) return ". N" + chance;
  return std::string(". ") + what + " " + percent(*closed) + " of what calibration leaves; n" +
         chance;
}

std::string one_cause(const Diagnosis& diagnosis) {
  const CauseResult& verdict = diagnosis.verdict;
  std::string words = with_shape(verdict) + " causes the gap (" + sure(verdict.probability) + ")";
  if (const std::string alike = look_alikes(verdict); !alike.empty())
    words += ", or " + alike +
             " does: these rows cannot tell which (one of them: " + sure(verdict.together) + ")";
  return words + worth_of(diagnosis, "It closes");
}

/// Nearly all is closed, by each alone as by all, and nothing by one beside the others.
bool any_will_do(const Diagnosis& diagnosis) {
  const double all = diagnosis.gap.closed.fraction.value_or(0);
  if (all < 1 - kDiagnosis.naming.hardly_left) return false;
  return std::ranges::all_of(diagnosis.named, [&](const CauseResult& each) {
    const double alone = each.closes_alone.value_or(0), beside = each.closes_beside.value_or(1);
    return beside < kDiagnosis.naming.nothing_beside &&
           all - alone < kDiagnosis.naming.nothing_alone;
  });
}

std::string several_causes(const Diagnosis& diagnosis) {
  const bool any = any_will_do(diagnosis);
  std::string words =
      any ? "any one of these closes the gap alone, and which of them are there the "
            "rows cannot tell: "
          : phrase("%zu causes make the gap together: ", diagnosis.named.size());
  for (size_t i = 0; i < diagnosis.named.size(); ++i) {
    const CauseResult& each = diagnosis.named[i];
    words += (i == 0 ? "" : "; ") + with_shape(each) + " (" + sure(each.probability);
    if (each.closes_alone && each.closes_beside)
      words += ", closes " + percent(*each.closes_beside) + " beside the others, " +
               percent(*each.closes_alone) + " alone";
    words += ")";
    if (const std::string alike = look_alikes(each); !alike.empty())
      words += ", or " + alike + ": these rows cannot tell which";
  }
  return words +
         worth_of(diagnosis, any ? "One as well as all of them closes" : "Together they close");
}

/// ". Besides there is structure that …" where there is that as well; empty where what is named may
/// be it.
std::string beside_the_unknown(const Diagnosis& diagnosis) {
  for (const CauseResult& each : diagnosis.named)
    if (std::ranges::count(each.confounded_with, kUnknown) > 0) return {};
  for (const CauseResult& each : diagnosis.candidates)
    if (each.effect == kUnknown && each.probability > kDiagnosis.report.beside)
      return ". Besides there is structure that no known effect explains (" +
             sure(each.probability) + ")";
  return {};
}

std::string unusual_sizes(const std::vector<CauseResult>& named) {
  std::string words;
  for (const CauseResult& each : named)
    for (const NamedValue& v : each.parameters)
      if (is_beyond_usual(v, kDiagnosis.report.far_beyond))
        words += "; " + v.name + " = " + in_readable_unit(v.value, v.unit) +
                 " is far beyond the usual " + in_readable_unit(v.usual_least, v.unit) + " to " +
                 in_readable_unit(v.usual_most, v.unit) + ": something else may look like it";
  return words;
}

/// What was moved that the rows are all measured against.
std::string moved_at_once(const Diagnosis& diagnosis) {
  const auto surely = [](const CauseResult& each) {
    return is_moved_at_once(each) && std::ranges::any_of(each.parameters, [](const NamedValue& v) {
             return std::abs(v.value) > kDiagnosis.report.sigmas * v.sigma;
           });
  };
  return std::ranges::any_of(diagnosis.named, surely)
             ? ". The instrument or the robot's base was moved then: give the rows before and "
               "after it as two sets, each with a frame of its own"
             : "";
}

/// ". zero_shift at j4 steps 3 times: …", of what is named.
std::string repeated_steps(const Diagnosis& diagnosis) {
  std::string words;
  for (const CauseResult& each : diagnosis.named) {
    for (const std::string& at : each.where) {
      const std::ptrdiff_t steps = steps_at(each, at);
      if (steps > 1)
        words += ". " + each.effect + " at " + at + phrase(" steps %td times: something ", steps) +
                 "there slips again and again, or wanders";
    }
  }
  return words;
}

/// Causes that are more probable than none, though noise may have made them: "backlash at j1 (41 %
/// sure)".
std::string likelier_than_none(const Diagnosis& diagnosis) {
  std::string words;
  for (const CauseResult& each : diagnosis.candidates)
    if (names_effect(each.effect) && each.probability > diagnosis.verdict.probability)
      words +=
          (words.empty() ? "" : ", ") + with_places(each) + " (" + sure(each.probability) + ")";
  return words;
}

/// ": rows near each other in the cell err alike", where that is known.
std::string how_it_errs(const std::optional<UnknownStructure>& structure) {
  return structure ? ": " + in_words(*structure) : std::string();
}

std::string advice_on_unknown(const std::optional<UnknownStructure>& structure) {
  return structure && structure->domain == KernelDomain::same
             ? ". Look at the machine and at what measures it, or go to "
               "some of these configurations again from elsewhere: "
               "what a robot does not repeat looks like this"
             : ". Look at the machine and at what measures it, or repeat "
               "some configurations to be sure of the noise";
}

/// ". Named besides: backlash at j1 (93 % sure). Probable besides: …", of a verdict that is
/// unknown.
std::string besides(const Diagnosis& diagnosis) {
  std::string named, probable;
  for (const CauseResult& each : diagnosis.named)
    named += (named.empty() ? ". Named besides: " : ", ") + with_places(each) + " (" +
             sure(each.probability) + ")";
  for (const CauseResult& each : diagnosis.candidates) {
    const bool is_named = std::ranges::any_of(diagnosis.named, [&](const CauseResult& other) {
      return other.effect == each.effect && other.where == each.where;
    });
    if (names_effect(each.effect) && !is_named && each.of_its_kind() > kDiagnosis.report.beside)
      probable += (probable.empty() ? ". Probable besides: " : ", ") + with_places(each);
  }
  return named + probable;
}

/// ". It is more than …", where repeats say so.
std::string louder_than_stated(const Diagnosis& diagnosis) {
  if (diagnosis.scatter.empty()) return {};
  return ". It is more than is stated, and noise all the same: " + diagnosis.scatter +
         ". Something shakes or slips, or the figure that is stated is too small";
}

std::string no_cause(const Diagnosis& diagnosis) {
  if (const std::string likelier = likelier_than_none(diagnosis); !likelier.empty())
    return "no cause is named: these rows do not settle whether it is " + likelier +
           " or noise alone (" + sure(diagnosis.verdict.probability) +
           phrase("; as much is found in %.2g of resampled rows)", diagnosis.p_value);
  if (diagnosis.p_value > DiagnosisOptions{}.name_below_p)
    return phrase(
               "no cause is named: noise alone explains what calibration leaves (as much is found "
               "in %.2g of resampled rows)",
               diagnosis.p_value) +
           louder_than_stated(diagnosis);
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
    return (diagnosis.named.size() > 1 ? several_causes(diagnosis) : one_cause(diagnosis)) +
           moved_at_once(diagnosis) + repeated_steps(diagnosis) + beside_the_unknown(diagnosis) +
           unusual_sizes(diagnosis.named);
  const std::string beside = besides(diagnosis);
  if (!diagnosis.uneven.empty())
    return "no known effect explains the gap (" + sure(verdict.probability) +
           "): " + diagnosis.uneven + beside +
           ". Time stamps that jitter, a beam that bends, a part that shakes or hits are like this";
  if (!diagnosis.scatter.empty())
    return "no known effect explains the gap (" + sure(verdict.probability) +
           "): " + diagnosis.scatter + beside +
           ". Either that is stated too small, or something errs from row to row: repeat some "
           "configurations at once, which tells the noise";
  return "no known effect explains the gap (" + sure(verdict.probability) +
         phrase("; noise alone does in %.2g of cases)", diagnosis.p_value) +
         how_it_errs(diagnosis.unknown) + beside + repeated_steps(diagnosis) +
         advice_on_unknown(diagnosis.unknown) + unusual_sizes(diagnosis.named);
}

std::string names_in_words(const std::vector<CauseResult>& causes) {
  std::vector<std::string> names;
  for (const CauseResult& each : causes) names.push_back(with_places(each));
  return listed(names);
}

}  // namespace selfcal
