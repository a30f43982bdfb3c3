// The diagnosis of a small data set, without simulated sessions and with few resamples:
// probabilities are such, and what is named has figures.
#include "diagnosis/diagnosis.h"

#include "app/report/diagnosis_json.h"
#include "app/report/diagnosis_summary.h"
#include "app/report/page/diagnosis_page.h"
#include "tests/fuzz/small_data_set.h"

namespace selfcal {
namespace {

void expect_probability(double p, const std::string& what) {
  promise(p >= 0 && p <= 1 + 1e-9, what + ": no probability: " + std::to_string(p));
}

void expect_known(const Diagnosis& diagnosis) {
  for (const CauseResult& each : diagnosis.candidates)
    expect_probability(each.probability, each.effect);
  expect_probability(diagnosis.verdict.probability, "the verdict " + diagnosis.verdict.effect);
  expect_probability(diagnosis.p_value, "p");
  promise(std::isfinite(diagnosis.gap.rms_before) && std::isfinite(diagnosis.gap.rms_after),
          "a gap that is no number");
  for (const CauseResult& each : diagnosis.named)
    for (const NamedValue& value : each.parameters)
      promise(std::isfinite(value.value) && std::isfinite(value.sigma),
              each.effect + " " + value.name + " is no number");
  promise(diagnosis.values.allFinite(), "parameters that are no numbers");
}

void try_diagnose(Bytes bytes) {
  const auto loaded = small_data_set(bytes);
  if (!loaded) return;
  DiagnosisOptions options;
  options.resamples = 9;
  options.simulated_sessions = 0;
  const DataSet& data = loaded->data;
  Findings findings{"given", diagnose(loaded->robot, data, options), {}, {}};
  const Diagnosis& diagnosis = findings.diagnosis;
  if (!diagnosis.problem.empty()) return;
  expect_known(diagnosis);
  promise(!summary(diagnosis).empty() && !to_json(findings).dump(1).empty() &&
              !next_json(diagnosis, data).dump(1).empty(),
          "told in no word");
  promise(!page_of(diagnosis_data({*loaded->robot, data, "given", 0}, findings)).empty(),
          "no page");
  const auto corrected = robot_of(robot_text(*diagnosis.model, diagnosis.values), "corrected.yaml");
  promise(corrected.has_value(), corrected ? "" : corrected.error().what);
}

}  // namespace
}  // namespace selfcal

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  selfcal::try_diagnose({data, size});
  return 0;
}
