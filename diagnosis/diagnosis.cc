#include "diagnosis/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "constraints/estimation/identification.h"
#include "diagnosis/constants.h"
#include "diagnosis/evidence/evidence_evaluator.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/report/attribution.h"
#include "diagnosis/report/carry_over.h"
#include "diagnosis/report/detectable.h"
#include "diagnosis/report/doubt.h"
#include "diagnosis/report/experiment_design.h"
#include "diagnosis/report/scatter.h"
#include "diagnosis/report/uneven_noise.h"
#include "diagnosis/report/validated_correction.h"
#include "diagnosis/report/verdict.h"
#include "diagnosis/report/warnings.h"
#include "diagnosis/search/causes.h"
#include "diagnosis/search/naming.h"
#include "diagnosis/search/sign_flip_test.h"
#include "diagnosis/search/simulation_based_calibration.h"
#include "diagnosis/search/weighing.h"
#include "diagnosis/validation/folds.h"

namespace selfcal {
namespace {

constexpr const char* kAllKept = "every row is `part: check`: there is none to find a cause with";

class Diagnostician {
 public:
  Diagnostician(const std::shared_ptr<const Robot>& robot, const DataSet& data,
                const DiagnosisOptions& options, const Progress& progress)
      : data_(data),
        options_(options),
        progress_(progress),
        linearised_(robot, data, options, progress) {}

  /// Why these rows cannot be diagnosed; empty where they can.
  std::string problem() { return lacking(*evidence_of(linearised_, data_, options_.search)); }

  Diagnosis run() {
    if (!named()) return std::move(result_);
    result_.where = attribution(linearised_, *evaluator_, data_);
    result_.untestable = linearised_.candidates().untestable;
    list_detectable(linearised_, *evaluator_, data_, options_, result_);
    tell("closing the gap", 0.85);
    validate_correction(linearised_, freedom_alone(), posterior_, data_, options_, result_);
    // Without rows kept aside those that identify have told which is the larger part.
    const std::optional<double>& closed = result_.gap.closed.fraction;
    allow_for_the_unknown(result_.candidates, result_.verdict, result_.named,
                          closed ? 1 - *closed : kDiagnosis.naming.most_left);
    bound_by_what_is_left(result_.gap, result_.candidates, result_.verdict, result_.named);
    doubt_repeated_steps(result_.candidates, result_.verdict, result_.named);
    let_the_larger_share_lead(result_.verdict, result_.named);
    NextSteps next = next_steps(linearised_, data_, result_, options_);
    result_.next = std::move(next.steps);
    result_.next_why = std::move(next.why);
    if (!left_out_.empty()) result_.warnings.push_back(left_out_);
    trust_plain_steps(linearised_, data_, result_);
    result_.why = verdict_in_words(result_) + gears_beside_none(result_);
    const Solution calibrated = identify(linearised_.geometry(), data_);
    std::ranges::copy(calibrated.scale.contradictions, std::back_inserter(result_.warnings));
    if (const std::string doubt = doubt_of(linearised_, data_, calibrated, result_); !doubt.empty())
      withdraw(doubt, options_, result_);
    return std::move(result_);
  }

  /// The figures of the validation rows, and nothing else.
  std::vector<ValidationRow> validation_rows() {
    if (!named()) return {};
    return selfcal::validation_rows(linearised_, freedom_alone(), posterior_, data_, options_,
                                    result_);
  }

 private:
  /// The causes, and what of them is named; false where the rows are too few.
  bool named() {
    Weighed weighed = weigh(linearised_, data_, options_, progress_);
    evaluator_ = std::move(weighed.evaluator);
    posterior_ = std::move(weighed.posterior);
    result_.problem = std::move(weighed.problem);
    if (!result_.problem.empty()) return false;
    result_.noise = linearised_.noise() * shared_noise();
    result_.angles_left = linearised_.angles_left();
    result_.candidates = cause_results(linearised_, *evaluator_, posterior_);
    name();
    return true;
  }

  /// Of the noise alone, after which nothing looks at the rows that were weighed.
  double freedom_alone() {
    const double freedom = evaluator_->marginal_likelihood(0).freedom();
    evaluator_.reset();
    return freedom;
  }

  /// What noise does not do as well, with probabilities as often true as they say.
  void name() {
    tell("asking noise the same question", 0.75);
    const NullDistribution null(linearised_, *evaluator_, data_.rows, options_.resamples,
                                options_.seed, options_.most_outliers);
    ByNoise p{null.p_of(evaluator_->best_found().log_odds), 1};
    Posterior posterior = posterior_;
    CauseResult named =
        named_cause(linearised_, *evaluator_, posterior, result_.candidates, options_);
    const bool structure =
        posterior.unknown > kDiagnosis.naming.probable || named.effect == kUnknown;
    if (structure)
      p.unknown = p_of_unknown(linearised_, *evaluator_, best_with_structure(), data_.rows,
                               options_.resamples, options_.seed);
    // Structure that noise shows as well speaks against no cause that noise does not.
    if (structure && p.unknown > options_.name_below_p && p.known <= options_.name_below_p) {
      posterior =
          with_less_structure(posterior, share_of_structure(p.unknown, options_.name_below_p),
                              evaluator_->ingredients());
      result_.candidates = cause_results(linearised_, *evaluator_, posterior);
      named = named_cause(linearised_, *evaluator_, posterior, result_.candidates, options_);
    }
    const bool asked_unknown = named.effect == kUnknown;
    if (posterior.unknown > kDiagnosis.naming.probable || asked_unknown)
      result_.unknown = structure_of_unknown(*evaluator_, posterior, linearised_.geometry());
    result_.verdict = decided(std::move(named), posterior, p, options_);
    result_.p_value = asked_unknown || result_.verdict.effect == kUnknown ? p.unknown : p.known;
    tell("practising on simulated sessions", 0.8);
    result_.simulation = calibrate_by_simulation(linearised_, *evaluator_, null, options_);
    std::vector<CauseResult> together =
        with_look_alikes(linearised_, posterior, result_.candidates);
    for (std::vector<CauseResult>* list : {&result_.candidates, &together})
      for (CauseResult& each : *list) {
        each.p_value = each.effect != kUnknown ? p.known : structure ? p.unknown : NAN;
        each.probability = calibrated(each.probability, result_.simulation);
        each.together = calibrated(each.together, result_.simulation);
      }
    result_.verdict.probability = calibrated(result_.verdict.probability, result_.simulation);
    result_.verdict.together = calibrated(result_.verdict.together, result_.simulation);
    result_.verdict = unless_none(std::move(result_.verdict), result_.candidates, options_);
    agree(result_.candidates, result_.verdict);
    result_.named = sure_causes(together, result_.verdict, p, options_);
    left_out_ = leave_out_impossible(result_.named, result_.verdict);
    doubt_noise(linearised_, data_, evaluator_->marginal_likelihood(0).freedom(), result_);
    doubt_even_noise(linearised_, data_, result_);
  }

  /// The most probable causes beside structure of no known one.
  Hypothesis best_with_structure() const {
    for (const Hypothesis& h : posterior_.hypotheses)
      if (evaluator_->structure(h.structure).kind > 0) return h;
    return {};
  }

  /// Noise of a new configuration over that of an immediate repeat.
  double shared_noise() const {
    for (const Hypothesis& h : posterior_.hypotheses)
      if (evaluator_->structure(h.structure).kind == 0)
        return std::hypot(1.0, evaluator_->structure(h.structure).kappa);
    return 1;
  }

  void tell(std::string_view stage, double share) const {
    if (progress_) progress_(stage, share);
  }

  const DataSet& data_;
  const DiagnosisOptions& options_;
  const Progress& progress_;
  LinearisedModel linearised_;
  std::unique_ptr<EvidenceEvaluator> evaluator_;
  Posterior posterior_;
  Diagnosis result_;
  std::string left_out_;  ///< of what would be named, and why
};

void cross_validate(const std::shared_ptr<const Robot>& robot, const DataSet& data,
                    DiagnosisOptions options, const Progress& progress, Diagnosis& diagnosis) {
  options.simulated_sessions = 0;
  for (int fold = 0; fold < kDiagnosis.validation.folds; ++fold) {
    if (progress) progress("judging by folds", 0.9 + 0.1 * fold / kDiagnosis.validation.folds);
    const DataSet part = with_fold(data, fold);
    const std::vector<ValidationRow> of_fold =
        Diagnostician(robot, part, options, {}).validation_rows();
    int first = 0;  // the number of the fold's first block
    for (const ValidationRow& row : diagnosis.validation_rows)
      first = std::max(first, row.block + 1);
    for (ValidationRow row : of_fold) {
      row.block += first;
      diagnosis.validation_rows.push_back(row);
    }
  }
  if (diagnosis.named.empty())  // a third may name what the whole does not
    for (ValidationRow& row : diagnosis.validation_rows) row.after = row.before;
  diagnosis.gap = gap_of(diagnosis.validation_rows, options.seed, diagnosis.floor_freedom, "folds");
}

}  // namespace

std::string why_not_diagnosable(const std::shared_ptr<const Robot>& robot, const DataSet& data) {
  if (std::ranges::all_of(data.rows.check, [](auto check) { return check != 0; })) return kAllKept;
  const DiagnosisOptions options;
  const Progress silent;
  return Diagnostician(robot, data, options, silent).problem();
}

Diagnosis diagnose(const std::shared_ptr<const Robot>& robot, const DataSet& data,
                   const DiagnosisOptions& options, const Progress& progress) {
  if (std::ranges::all_of(data.rows.check, [](auto check) { return check != 0; })) {
    Diagnosis nothing;
    nothing.problem = kAllKept;
    return nothing;
  }
  Diagnosis diagnosis = Diagnostician(robot, data, options, progress).run();
  if (!diagnosis.problem.empty()) return diagnosis;
  if (std::string nuisance = warning_of_own_effects(*robot); !nuisance.empty())
    diagnosis.warnings.push_back(std::move(nuisance));
  const bool kept_aside = std::ranges::count(data.rows.check, char{1}) > 0;
  if (!kept_aside) {
    cross_validate(robot, data, options, progress, diagnosis);
    if (names_effect(diagnosis.verdict.effect)) {
      if (const std::optional<double>& closed = diagnosis.gap.closed.fraction)
        let_the_larger_lead(diagnosis.candidates, 1 - *closed, diagnosis.verdict);
      diagnosis.why = verdict_in_words(diagnosis);
    }
    if (const std::string doubt = closes_nothing(diagnosis); !doubt.empty())
      withdraw(doubt, options, diagnosis);
  }
  if (diagnosis.validation_rows.empty())
    diagnosis.gap_unjudged =
        std::ranges::none_of(data.sets, [](const Set& set) { return set.method->has_lengths(); })
            ? "these rows measure no lengths, of which the gap is told"
        : kept_aside ? "no row kept aside measures a length"
                     : "too few rows to keep some aside";
  if (std::string left = leave_out_what_does_not_carry_over(data, options, diagnosis);
      !left.empty())
    diagnosis.warnings.push_back(std::move(left));
  if (std::string warning = warning_of_gap(diagnosis); !warning.empty())
    diagnosis.warnings.push_back(std::move(warning));
  return diagnosis;
}

}  // namespace selfcal
