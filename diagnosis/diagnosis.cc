#include "diagnosis/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "diagnosis/evidence/discrepancy.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/evidence/visits.h"
#include "diagnosis/report/attribution.h"
#include "diagnosis/report/detectable.h"
#include "diagnosis/report/experiment_design.h"
#include "diagnosis/report/holdout_validation.h"
#include "diagnosis/report/named.h"
#include "diagnosis/report/warnings.h"
#include "diagnosis/search/causes.h"
#include "diagnosis/search/sign_flip_test.h"
#include "diagnosis/search/simulation_based_calibration.h"
#include "diagnosis/validation/folds.h"
#include "kinematics/corrected_robot.h"
#include "kinematics/expects.h"

namespace selfcal {
namespace {

constexpr int kDiagnosisPasses = 4;
constexpr double kFewestFreedoms = 10;  ///< equations beyond the geometry
constexpr size_t kMostEffects = 60;
constexpr double kMostGrown = 2100;  ///< equations
constexpr double kTried = 0.05;      ///< least probable cause that is tried alone
constexpr int kMostTried = 4;

class Diagnostician {
 public:
  Diagnostician(const std::shared_ptr<const Robot>& robot, const DataSet& data,
                const DiagnosisOptions& options, const Progress& progress)
      : data_(data),
        options_(options),
        progress_(progress),
        view_(robot, data, options, progress) {}

  Diagnosis run() {
    weigh();
    if (!result_.problem.empty()) return std::move(result_);
    result_.noise = view_.noise() * shared_noise();
    result_.candidates = cause_results(view_, *bench_, posterior_);
    tell("asking noise the same question", 0.75);
    const NullDistribution null(view_, *bench_, data_.rows, options_.resamples, options_.seed);
    result_.p_value = null.p_of(bench_->best_found());
    result_.verdict = decided(named_cause(view_, *bench_, posterior_, result_.candidates, options_),
                              posterior_, result_.p_value, options_);
    tell("practising on simulated sessions", 0.8);
    result_.practice = calibrate_by_simulation(view_, *bench_, null, options_);
    for (double* const each : {&result_.verdict.probability, &result_.verdict.together})
      *each = calibrated(*each, result_.practice);
    result_.where = attribution(view_, *bench_, data_);
    result_.untestable = view_.candidates().untestable;
    list_detectable(view_, *bench_, options_, result_);
    result_.next = next_steps(view_, data_, result_);
    tell("closing the gap", 0.85);
    close();
    result_.why = verdict_in_words(result_);
    return std::move(result_);
  }

 private:
  /// Every cause on rows without the false ones, until neither these nor the noise change.
  void weigh() {
    for (int pass = 0; pass < kDiagnosisPasses; ++pass) {
      tell("weighing the causes", 0.2 + 0.2 * pass);
      const DenseEquations rows = view_.kept();
      bench_ = std::make_unique<EvidenceEvaluator>(
          view_.whitened(),
          structures(data_.rows, rows, view_.ends(), view_.by_joint(rows),
                     comparable_readings(view_.geometry(), data_.rows.q),
                     noise_of_visits(data_.rows, rows, view_.left())),
          view_.candidates(), view_.parameters(), options_.search);
      posterior_ = bench_->search();
      if (bench_->marginal_likelihood(0).freedom() < kFewestFreedoms) {
        result_.problem =
            "too few rows for a diagnosis: beyond what calibration takes they leave " +
            format_number(std::floor(bench_->marginal_likelihood(0).freedom())) +
            " equations, at least 10 are needed";
        return;
      }
      expects(std::isfinite(posterior_.log_total), "the evidence of finite rows is finite");
      const Hypothesis& best = posterior_.hypotheses.front();
      const auto [columns, sigma] = MarginalLikelihood::unfold(bench_->terms(best));
      const double variance =
          bench_->marginal_likelihood(best.structure).estimate(bench_->terms(best)).variance *
          bench_->noise_variance(best.structure);
      // The bench and the view must end up with the same rows.
      if (pass + 1 == kDiagnosisPasses || !view_.refine(view_.residuals(columns, sigma), variance))
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

  /// All that the rows say of the named causes and their like: from more rows than were weighed for
  /// the name, and again with the noise that it leaves.
  Correction grown(Hypothesis best) {
    view_.weigh(kMostGrown);
    const Candidates all = with_profiles(view_.candidates());
    SearchRule rule = options_.search;
    rule.noise_is_known = true;  // each pass takes it from what the one before leaves
    Correction correction;
    for (int pass = 0; pass < kDiagnosisPasses; ++pass) {
      const DenseEquations rows = view_.kept();
      const double of_visits = noise_of_visits(data_.rows, rows, view_.left());
      const EvidenceEvaluator bench(view_.whitened(),
                                    noise_alone(data_.rows, rows, view_.by_joint(rows), of_visits),
                                    all, view_.parameters(), rule);
      best.structure = 0;
      // What is named is in the model, even where all the rest together makes up for it.
      best = with_named(bench.grow(best, kMostEffects), result_.verdict, all, posterior_);
      const auto [columns, sigma] = MarginalLikelihood::unfold(bench.terms(best));
      const double variance = bench.marginal_likelihood(0).estimate(bench.terms(best)).variance *
                              bench.noise_variance(0);
      const bool again = view_.refine(view_.residuals(columns, sigma), variance);
      result_.noise = view_.noise() * std::hypot(1.0, of_visits);
      if (again && pass + 1 < kDiagnosisPasses) continue;
      for (size_t i = 0; i < best.candidates.size(); ++i) {
        const Candidate& each = all.list[best.candidates[i]];
        correction.push_back({each.entries.front(), {}, names(result_.verdict, each)});
        bench.add_sigma(best.candidates[i], best.sizes[i], correction.back().sigma);
      }
      break;
    }
    return correction;
  }

  /// The best explanation with what is named; beside an unknown one, of what is probable all the
  /// same.
  Hypothesis believed() const {
    const CauseResult& verdict = result_.verdict;
    if (verdict.effect == kNone) return {};
    const auto candidate = [&](int c) -> const Candidate& { return view_.candidates().list[c]; };
    const auto probable = [&](int c) { return posterior_.family.at(candidate(c).effect) > 0.5; };
    const auto named = [&](int c) { return names(verdict, candidate(c)); };
    for (const Hypothesis& h : posterior_.hypotheses)
      if (!h.candidates.empty() &&
          (verdict.effect == kUnknown ? std::ranges::all_of(h.candidates, probable)
                                      : std::ranges::any_of(h.candidates, named)))
        return h;
    return {};
  }

  /// Geometry alone against geometry with what is named, and with everything found.
  void close() {
    const Hypothesis best = believed();
    const double noise = result_.noise;
    if (!best.candidates.empty()) result_.found = grown(best);
    // What nobody knows is no noise; nor is what more of the named effects explains.
    if (posterior_.unknown > 0.5) result_.noise = std::min(noise, result_.noise);
    Closing closing = validate_on_holdout(view_.shared_geometry(), view_.adjusted(), data_,
                                          result_.found, view_.site(), result_.noise, options_);
    result_.judged = std::move(closing.judged);
    result_.gap = gap_of(result_.judged, options_.seed);
    result_.rejected = std::move(closing.rejected);
    for (int row = 0; row < data_.rows.rows(); ++row)
      if (view_.outlier()[row])
        result_.rejected.push_back({row + 1, data_.sets[data_.rows.set[row]].name, 0, false,
                                    "no explanation comes near it: a false reading"});
    result_.model = closing.model;
    result_.values = closing.all.fitted.state.xi;
    result_.converged = closing.converged;
    close_each();
    result_.warnings = warnings_of(view_, data_, closing);
  }

  /// What each of the probable causes would close alone.
  void close_each() {
    int tried = 0;
    for (CauseResult& each : result_.candidates) {
      if (each.correction.empty() || each.probability < kTried || ++tried > kMostTried) continue;
      const Closing alone =
          validate_on_holdout(view_.shared_geometry(), view_.adjusted(), data_, each.correction,
                              view_.site(), result_.noise, options_);
      each.rms_after = gap_of(alone.judged, options_.seed).rms_all;
    }
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
    const Diagnosis of_fold = Diagnostician(robot, part, options, {}).run();
    diagnosis.judged.insert(diagnosis.judged.end(), of_fold.judged.begin(), of_fold.judged.end());
  }
  diagnosis.gap = gap_of(diagnosis.judged, options.seed);
  diagnosis.gap.judged_on = "folds";
}

}  // namespace

Diagnosis diagnose(const std::shared_ptr<const Robot>& robot, const DataSet& data,
                   const DiagnosisOptions& options, const Progress& progress) {
  if (std::ranges::all_of(data.rows.check, [](auto check) { return check != 0; })) {
    Diagnosis nothing;
    nothing.problem = "every row is `part: check`: there is none to find a cause with";
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
