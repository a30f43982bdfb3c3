#include "diagnosis/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "diagnosis/causes.h"
#include "diagnosis/closing.h"
#include "diagnosis/next.h"
#include "diagnosis/null.h"
#include "diagnosis/practice.h"
#include "diagnosis/structures.h"
#include "diagnosis/view.h"
#include "diagnosis/whereabouts.h"
#include "kinematics/corrected_robot.h"

namespace selfcal {
namespace {

constexpr int kPasses = 4;
constexpr size_t kMostEffects = 60;
constexpr double kMostGrown = 2100;  ///< equations
constexpr double kSurelyUnknown = 0.7;
constexpr double kTried = 0.05;  ///< least probable cause that is tried alone
constexpr int kMostTried = 4;
constexpr double kAbsorbed = 0.02;  ///< share that survives below which nothing can be said

class Diagnostician {
 public:
  Diagnostician(const std::shared_ptr<const Robot>& robot, const DataSet& data,
                const DiagnosisOptions& options, const Progress& progress)
      : data_(data),
        options_(options),
        progress_(progress),
        view_(robot, data, options, progress) {}

  Diagnosis run() {
    for (int pass = 0; pass < kPasses; ++pass) {
      tell("weighing the causes", 0.2 + 0.2 * pass);
      const DenseEquations rows = view_.kept();
      bench_ = std::make_unique<Bench>(
          view_.whitened(), structures(data_.rows, rows, view_.tips(), view_.by_joint(rows)),
          view_.candidates(), view_.parameters(), options_.search);
      posterior_ = bench_->search();
      const Hypothesis& best = posterior_.hypotheses.front();
      const auto [columns, sigma] = Workbench::unfold(bench_->terms(best));
      const double variance =
          bench_->workbench(best.structure).estimate(bench_->terms(best)).variance *
          bench_->noise_variance(best.structure);
      // The bench and the view must end up with the same rows.
      if (pass + 1 == kPasses || !view_.refine(view_.residuals(columns, sigma), variance)) break;
    }
    result_.noise = view_.noise() * shared_noise();
    result_.candidates = cause_results(view_, *bench_, posterior_);
    tell("asking noise the same question", 0.75);
    result_.p_value = resampled_p(view_, *bench_, data_.rows, options_.resamples, options_.seed);
    decide();
    tell("practising on simulated sessions", 0.8);
    result_.practice = practise(view_, *bench_, options_);
    result_.verdict.probability = calibrated(result_.verdict.probability, result_.practice);
    result_.where = whereabouts(view_, *bench_, data_);
    result_.untestable = view_.candidates().untestable;
    list_detectable();
    result_.next = next_steps(view_, data_, result_);
    tell("closing the gap", 0.85);
    close();
    result_.why = verdict_in_words(result_);
    return std::move(result_);
  }

 private:
  void decide() {
    result_.verdict = named_cause(view_, *bench_, posterior_, result_.candidates, options_);
    if (result_.verdict.effect == "unknown") return;
    // Structure of no known cause is no matter of signs: repeats of a configuration tell of it.
    const bool noise_does_as_well = result_.p_value > options_.name_below_p;
    if (result_.verdict.effect != "none" && !noise_does_as_well) return;
    if (posterior_.unknown > kSurelyUnknown)
      result_.verdict = {.effect = "unknown", .probability = posterior_.unknown};
    else
      result_.verdict = {
          .effect = "none",
          .probability = std::max(posterior_.none, least_probability_of_none(result_.p_value))};
  }

  /// Noise of a new configuration over that of an immediate repeat.
  double shared_noise() const {
    for (const Hypothesis& h : posterior_.hypotheses)
      if (bench_->structure(h.structure).kind == 0)
        return std::hypot(1.0, bench_->structure(h.structure).kappa);
    return 1;
  }

  /// The smallest that would have been named, of each cause in its best seen shape.
  void list_detectable() {
    std::map<Cause, Detectable> best;
    const std::vector<Candidate>& list = view_.candidates().list;
    for (int c = 0; c < static_cast<int>(list.size()); ++c) {
      if (bench_->survival(c) < kAbsorbed) continue;
      const double needed = -std::log(options_.name_below_none) -
                            std::log(options_.search.family_odds) - list[c].log_prior;
      const Detectable each{list[c].effect, list[c].at,
                            view_.parameters()[list[c].main.front()].unit,
                            bench_->detectable(c, needed)};
      const auto [at, made] = best.try_emplace({list[c].effect, list[c].at}, each);
      if (!made && each.smallest < at->second.smallest) at->second = each;
    }
    for (auto& [cause, each] : best) result_.detectable.push_back(std::move(each));
    for (int c = 0; c < static_cast<int>(list.size()); ++c)
      if (!best.contains({list[c].effect, list[c].at})) {
        best[{list[c].effect, list[c].at}] = {};
        result_.untestable.push_back(
            {list[c].effect, list[c].at, "absorbed by calibration on these rows"});
      }
  }

  /// All that the rows say of the named causes and their like: from more rows than were weighed for
  /// the name, and again with the noise that it leaves.
  Hypothesis grown(Hypothesis best) {
    view_.weigh(kMostGrown);
    for (int pass = 0; pass < kPasses; ++pass) {
      const DenseEquations rows = view_.kept();
      const Bench bench(view_.whitened(), noise_alone(data_.rows, rows, view_.by_joint(rows)),
                        view_.candidates(), view_.parameters(), options_.search);
      best.structure = 0;
      best = bench.grow(best, kMostEffects);
      const auto [columns, sigma] = Workbench::unfold(bench.terms(best));
      const double variance =
          bench.workbench(0).estimate(bench.terms(best)).variance * bench.noise_variance(0);
      if (!view_.refine(view_.residuals(columns, sigma), variance)) break;
    }
    result_.noise = view_.noise();
    return best;
  }

  /// Geometry alone against geometry with the effects that are there.
  void close() {
    std::vector<Node> entries;
    Hypothesis best;
    for (const Hypothesis& h : posterior_.hypotheses)
      if (result_.verdict.effect != "none" && !h.candidates.empty()) {
        best = h;
        break;
      }
    if (!best.candidates.empty()) best = grown(best);
    for (const int c : best.candidates)
      entries.push_back(view_.candidates().list[c].entries.front());
    Closing closing = close_gap(view_.shared_geometry(), view_.adjusted(), data_, entries,
                                view_.site(), result_.noise, options_);
    result_.gap = closing.gap;
    result_.rejected = std::move(closing.rejected);
    for (int row = 0; row < data_.rows.rows(); ++row)
      if (view_.put_aside()[row])
        result_.rejected.push_back({row + 1, data_.sets[data_.rows.set[row]].name, 0, false,
                                    "no explanation comes near it: a false reading"});
    result_.model = closing.model;
    result_.values = closing.after.fitted.state.xi;
    close_each();
  }

  /// What each of the probable causes would close alone.
  void close_each() {
    int tried = 0;
    for (CauseResult& each : result_.candidates) {
      if (each.entries.empty() || each.probability < kTried || ++tried > kMostTried) continue;
      each.rms_after = close_gap(view_.shared_geometry(), view_.adjusted(), data_, each.entries,
                                 view_.site(), result_.noise, options_)
                           .gap.rms_after;
    }
  }

  void tell(std::string_view stage, double share) const {
    if (progress_) progress_(stage, share);
  }

  const DataSet& data_;
  const DiagnosisOptions& options_;
  const Progress& progress_;
  View view_;
  std::unique_ptr<Bench> bench_;
  Posterior posterior_;
  Diagnosis result_;
};

}  // namespace

Diagnosis diagnose(const std::shared_ptr<const Robot>& robot, const DataSet& data,
                   const DiagnosisOptions& options, const Progress& progress) {
  return Diagnostician(robot, data, options, progress).run();
}

}  // namespace selfcal
