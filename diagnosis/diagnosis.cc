#include "diagnosis/diagnosis.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/constants.h"
#include "diagnosis/evidence/discrepancy.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/evidence/visits.h"
#include "diagnosis/report/attribution.h"
#include "diagnosis/report/closing.h"
#include "diagnosis/report/detectable.h"
#include "diagnosis/report/doubt.h"
#include "diagnosis/report/experiment_design.h"
#include "diagnosis/report/verdict.h"
#include "diagnosis/report/warnings.h"
#include "diagnosis/search/causes.h"
#include "diagnosis/search/sign_flip_test.h"
#include "diagnosis/search/simulation_based_calibration.h"
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
        view_(robot, data, options, progress) {}

  /// Why these rows cannot be diagnosed; empty where they can.
  std::string problem() {
    prepare();
    return lacking();
  }

  Diagnosis run() {
    if (!named()) return std::move(result_);
    result_.where = attribution(view_, *bench_, data_);
    result_.untestable = view_.candidates().untestable;
    list_detectable(view_, *bench_, options_, result_);
    NextSteps next = next_steps(view_, data_, result_, options_);
    result_.next = std::move(next.steps);
    result_.next_why = std::move(next.why);
    tell("closing the gap", 0.85);
    close_gap(view_, freedom_alone(), posterior_, data_, options_, result_);
    result_.why = verdict_in_words(result_);
    if (const std::string doubt = doubt_of(view_, data_, result_); !doubt.empty())
      withdraw(doubt, result_);
    return std::move(result_);
  }

  /// The figures of the judging rows, and nothing else.
  std::vector<JudgedRow> judged() {
    if (!named()) return {};
    return judged_rows(view_, freedom_alone(), posterior_, data_, options_, result_);
  }

 private:
  /// The causes, and what of them is named; false where the rows are too few.
  bool named() {
    weigh();
    if (!result_.problem.empty()) return false;
    result_.noise = view_.noise() * shared_noise();
    result_.candidates = cause_results(view_, *bench_, posterior_);
    name();
    return true;
  }

  /// Of the noise alone, after which nothing looks at the rows that were weighed.
  double freedom_alone() {
    const double freedom = bench_->marginal_likelihood(0).freedom();
    bench_.reset();
    return freedom;
  }

  /// What noise does not do as well, with probabilities as often true as they say.
  void name() {
    tell("asking noise the same question", 0.75);
    const NullDistribution null(view_, *bench_, data_.rows, options_.resamples, options_.seed,
                                options_.most_rejected);
    ByNoise p{null.p_of(bench_->best_found().log_odds), 1};
    CauseResult named = named_cause(view_, *bench_, posterior_, result_.candidates, options_);
    const bool structure = posterior_.unknown > 0.5 || named.effect == kUnknown;
    if (structure)
      p.unknown = p_of_unknown(view_, *bench_, best_with_structure(), data_.rows,
                               options_.resamples, options_.seed);
    const bool asked_unknown = named.effect == kUnknown;
    result_.verdict = decided(std::move(named), posterior_, p, options_);
    result_.p_value = asked_unknown || result_.verdict.effect == kUnknown ? p.unknown : p.known;
    tell("practising on simulated sessions", 0.8);
    result_.practice = calibrate_by_simulation(view_, *bench_, null, options_);
    for (CauseResult& each : result_.candidates) {
      each.p_value = each.effect != kUnknown ? p.known : structure ? p.unknown : NAN;
      each.probability = calibrated(each.probability, result_.practice);
    }
    for (double* const each : {&result_.verdict.probability, &result_.verdict.together})
      *each = calibrated(*each, result_.practice);
    result_.verdict = unless_none(std::move(result_.verdict), result_.candidates, options_);
    agree(result_.candidates, result_.verdict);
    result_.named = sure_causes(result_.candidates, result_.verdict, p, options_);
  }

  /// The most probable causes beside structure of no known one.
  Hypothesis best_with_structure() const {
    for (const Hypothesis& h : posterior_.hypotheses)
      if (bench_->structure(h.structure).kind > 0) return h;
    return {};
  }

  /// The evidence of the rows that are kept.
  void prepare() {
    const DenseEquations rows = view_.kept();
    bench_.reset();  // before there is a second one
    bench_ = std::make_unique<EvidenceEvaluator>(
        view_.whitened(),
        structures(data_.rows, rows, view_.ends(), view_.by_joint(),
                   comparable_readings(view_.geometry(), data_.rows.q),
                   noise_of_visits(data_.rows, rows, view_.left())),
        view_.candidates(), view_.parameters(), options_.search);
  }

  /// Why there are too few rows; empty where there are enough.
  std::string lacking() const {
    const double freedom = bench_->marginal_likelihood(0).freedom();
    if (freedom >= kDiagnosis.rows.fewest_freedoms) return {};
    return "too few rows for a diagnosis: beyond what calibration takes they leave " +
           format_number(std::floor(freedom)) + " equations, at least 10 are needed";
  }

  /// Every cause on rows without the false ones, until neither these nor the noise change.
  void weigh() {
    for (int pass = 0; pass < kDiagnosis.rows.passes; ++pass) {
      tell("weighing the causes", 0.2 + 0.2 * pass);
      prepare();
      result_.problem = lacking();
      if (!result_.problem.empty()) return;
      posterior_ = bench_->search();
      const Hypothesis& best = posterior_.hypotheses.front();
      const auto [columns, sigma] = MarginalLikelihood::unfold(bench_->terms(best));
      const double variance =
          bench_->marginal_likelihood(best.structure).estimate(bench_->terms(best)).variance *
          bench_->noise_variance(best.structure);
      // The bench and the view must end up with the same rows.
      if (pass + 1 == kDiagnosis.rows.passes ||
          !view_.refine(view_.residuals(columns, sigma), variance))
        break;
    }
  }

  /// Noise of a new configuration over that of an immediate repeat.
  double shared_noise() const {
    for (const Hypothesis& h : posterior_.hypotheses)
      if (bench_->structure(h.structure).kind == 0)
        return std::hypot(1.0, bench_->structure(h.structure).kappa);
    return 1;
  }

  void tell(std::string_view stage, double share) const {
    if (progress_) progress_(stage, share);
  }

  const DataSet& data_;
  const DiagnosisOptions& options_;
  const Progress& progress_;
  LinearisedModel view_;
  std::unique_ptr<EvidenceEvaluator> bench_;
  Posterior posterior_;
  Diagnosis result_;
};

void judge_by_folds(const std::shared_ptr<const Robot>& robot, const DataSet& data,
                    DiagnosisOptions options, const Progress& progress, Diagnosis& diagnosis) {
  options.practice = 0;
  for (int fold = 0; fold < kFolds; ++fold) {
    if (progress) progress("judging by folds", 0.9 + 0.1 * fold / kFolds);
    const DataSet part = with_fold(data, fold);
    const std::vector<JudgedRow> of_fold = Diagnostician(robot, part, options, {}).judged();
    int first = 0;  // the number of the fold's first block
    for (const JudgedRow& row : diagnosis.judged) first = std::max(first, row.block + 1);
    for (JudgedRow row : of_fold) {
      row.block += first;
      diagnosis.judged.push_back(row);
    }
  }
  diagnosis.gap = gap_of(diagnosis.judged, options.seed, diagnosis.floor_freedom);
  diagnosis.gap.judged_on = "folds";
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
  if (diagnosis.judged.empty()) judge_by_folds(robot, data, options, progress, diagnosis);
  if (std::string warning = warning_of_gap(diagnosis); !warning.empty())
    diagnosis.warnings.push_back(std::move(warning));
  return diagnosis;
}

}  // namespace selfcal
