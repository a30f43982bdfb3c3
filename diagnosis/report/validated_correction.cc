#include "diagnosis/report/validated_correction.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "diagnosis/constants.h"
#include "diagnosis/evidence/discrepancy.h"
#include "diagnosis/evidence/evidence_evaluator.h"
#include "diagnosis/evidence/visits.h"
#include "diagnosis/report/holdout_validation.h"
#include "diagnosis/report/named.h"
#include "diagnosis/report/shared_by_outliers.h"
#include "diagnosis/report/warnings.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

class CorrectionValidation {
 public:
  CorrectionValidation(LinearisedModel& linearised, double freedom, const Posterior& posterior,
                       const DataSet& data, const DiagnosisOptions& options, Diagnosis& result)
      : linearised_(linearised),
        posterior_(posterior),
        data_(data),
        options_(options),
        result_(result),
        freedom_(freedom) {}

  void run() {
    HoldoutValidation validation = of_everything();
    result_.validation_rows = std::move(validation.rows);
    result_.gap = gap_of(result_.validation_rows, options_.seed, freedom_);
    result_.floor_freedom = freedom_;
    result_.outliers = std::move(validation.outliers);
    for (int row = 0; row < data_.rows.rows(); ++row)
      if (linearised_.outlier()[row])
        result_.outliers.push_back({row + 1, data_.sets[data_.rows.set[row]].name, 0, false,
                                    "no explanation comes near it: a false reading"});
    result_.model = validation.model;
    result_.values = validation.all.fitted.state.xi;
    result_.converged = validation.converged;
    share_among_named();
    const std::vector<std::string> idle = leave_out_idle();
    validate_candidates();
    result_.warnings = warnings_of(linearised_, data_, validation, result_);
    std::ranges::copy(idle, std::back_inserter(result_.warnings));
    if (std::string shared =
            shared_by_outliers(data_, linearised_.geometry().joints(), result_.outliers);
        !shared.empty())
      result_.warnings.push_back(std::move(shared));
  }

  /// Geometry alone against geometry with what is named, and with everything found.
  HoldoutValidation of_everything() {
    const Hypothesis best = believed();
    const double noise = result_.noise;
    if (!best.candidates.empty()) result_.found = grown(best);
    // What nobody knows is no noise; nor is what more of the named effects explains.
    if (posterior_.unknown > kDiagnosis.naming.probable)
      result_.noise = std::min(noise, result_.noise);
    return validated(result_.found);
  }

 private:
  /// By set, what `result_.noise` is of all that were fitted; of others what their data sheet says.
  std::vector<double> noise_of_lengths() const {
    const std::vector<Scale> noise = linearised_.noise_of_sets();
    const double pooled = linearised_.noise();
    std::vector<double> list;
    for (size_t s = 0; s < noise.size(); ++s) {
      const double declared = data_.sets[s].noise;
      const bool fitted = linearised_.adjusted().fitted.rows[s] > 0 && pooled > 0;
      list.push_back(fitted         ? result_.noise * noise[s].length / pooled
                     : declared > 0 ? declared
                                    : result_.noise);
    }
    return list;
  }

  HoldoutValidation validated(const Correction& correction) const {
    return validate_on_holdout(linearised_.shared_geometry(), linearised_.adjusted(), data_,
                               correction, linearised_.context(), noise_of_lengths(),
                               undecided(correction), options_);
  }

  /// By row: kept aside, and taken when a step of the correction may or may not have happened.
  std::vector<char> undecided(const Correction& correction) const {
    std::vector<char> rows(static_cast<size_t>(data_.rows.rows()), 0);
    for (const FoundEffect& found : correction)
      for (const CauseResult& each : result_.candidates) {
        if (!found.what.shape.moment || !each.between || !is_of(each, found)) continue;
        const int set = linearised_.context().find(found.what.at);
        for (size_t row = 0; row < rows.size(); ++row) {
          const double time = data_.rows.time[static_cast<Eigen::Index>(row)];
          rows[row] =
              rows[row] || (data_.rows.check[row] && time > each.between->first &&
                            time < each.between->second && (set < 0 || data_.rows.set[row] == set));
        }
      }
    return rows;
  }

  Gap gap_with(Correction correction) const {
    for (FoundEffect& each : correction) each.named = true;
    return gap_of(validated(correction).rows, options_.seed, freedom_);
  }

  /// All that the rows say of the named causes and their like: from more rows than were weighed for
  /// the name, and again with the noise that it leaves.
  Correction grown(Hypothesis best) {
    linearised_.weigh(kDiagnosis.validation.most_grown);
    const Candidates all = with_profiles(linearised_.candidates());
    SearchRule rule = options_.search;
    rule.noise_is_known = true;  // each pass takes it from what the one before leaves
    Correction correction;
    for (int pass = 0; pass < kDiagnosis.validation.passes; ++pass) {
      const DenseEquations rows = linearised_.kept();
      const double of_visits = noise_of_visits(data_.rows, rows, linearised_.left());
      const EvidenceEvaluator evaluator(
          linearised_.whitened(),
          noise_alone(data_.rows, rows, linearised_.reading_errors(), of_visits), all,
          linearised_.parameters(), rule);
      best.structure = 0;
      // What is named is in the model, even where all the rest together makes up for it.
      best = with_named(evaluator.grow(best, kDiagnosis.validation.most_effects), result_.named,
                        all, posterior_);
      const auto [columns, sigma] = MarginalLikelihood::unfold(evaluator.terms(best));
      const double variance =
          evaluator.marginal_likelihood(0).estimate(evaluator.terms(best)).variance *
          evaluator.noise_variance(0);
      const bool again = linearised_.refine(linearised_.residuals(columns, sigma), variance);
      result_.noise = linearised_.noise() * std::hypot(1.0, of_visits);
      if (again && pass + 1 < kDiagnosis.validation.passes) continue;
      for (size_t i = 0; i < best.candidates.size(); ++i) {
        const Candidate& each = all.list[best.candidates[i]];
        correction.push_back(
            {.what = {each.effect, each.at, each.shape}, .named = names_any(result_.named, each)});
        evaluator.add_sigma(best.candidates[i], best.sizes[i], correction.back().sigma);
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
    const auto candidate = [&](int c) -> const Candidate& {
      return linearised_.candidates().list[c];
    };
    const auto probable = [&](int c) {
      return posterior_.family.at(candidate(c).effect) > kDiagnosis.naming.probable;
    };
    const auto named = [&](int c) { return names(verdict, candidate(c)); };
    for (const Hypothesis& h : posterior_.hypotheses)
      if (!h.candidates.empty() &&
          (verdict.effect == kUnknown ? std::ranges::all_of(h.candidates, probable)
                                      : std::ranges::any_of(h.candidates, named)))
        return h;
    return {};
  }

  /// The share of the gap that each named cause closes alone, and what the others leave of it.
  void share_among_named() {
    if (!result_.gap.closed.fraction) return;
    const double all = *result_.gap.closed.fraction;
    std::map<std::vector<char>, std::optional<double>> closed;  // by which are in the model
    const auto closed_by = [&](const std::vector<char>& in) {
      const auto [known, made] = closed.try_emplace(in);
      if (!made) return known->second;
      Correction some;
      for (size_t i = 0; i < in.size(); ++i)
        if (in[i]) some.push_back(result_.found[i]);
      return known->second = gap_with(std::move(some)).closed_all.fraction;
    };
    for (CauseResult& each : result_.named) {
      std::vector<char> alone, others;
      for (const FoundEffect& found : result_.found) {
        const bool own = is_of(each, found);
        alone.push_back(found.named && own);
        others.push_back(found.named && !own);
      }
      if (std::ranges::count(alone, 1) == 0) continue;
      const bool only = std::ranges::count(others, 1) == 0;
      each.closes_alone = only ? all : closed_by(alone);
      const std::optional<double> without = only ? std::optional(0.0) : closed_by(others);
      if (without) each.closes_beside = all - *without;
    }
  }

  /// What of several named causes closes nothing is not named; in words.
  std::vector<std::string> leave_out_idle() {
    const std::vector<CauseResult> idle = take_idle(result_.named);
    std::vector<std::string> words;
    for (const CauseResult& each : idle) {
      for (FoundEffect& found : result_.found)
        if (is_of(each, found)) found.named = false;
      if (each.effect == result_.verdict.effect && each.where == result_.verdict.where)
        result_.verdict = result_.named.front();
      words.push_back(each.effect + (each.where.empty() ? "" : " at " + listed(each.where)) +
                      " is as probable as " + with_figures("%.2f", each.of_its_kind()) +
                      " by the rows that identify, and closes nothing of those kept aside: it is "
                      "not named");
    }
    if (idle.empty()) return words;
    result_.validation_rows = validated(result_.found).rows;
    result_.gap = gap_of(result_.validation_rows, options_.seed, freedom_);
    share_among_named();
    return words;
  }

  /// What each of the probable causes would leave alone.
  void validate_candidates() {
    int tried = 0;
    for (CauseResult& each : result_.candidates)
      if (!each.correction.empty() && each.probability >= kDiagnosis.validation.tried &&
          ++tried <= kDiagnosis.validation.most_tried)
        each.rms_after = gap_with(each.correction).rms_all;
  }

  LinearisedModel& linearised_;
  const Posterior& posterior_;
  const DataSet& data_;
  const DiagnosisOptions& options_;
  Diagnosis& result_;
  const double freedom_;
};

}  // namespace

void validate_correction(LinearisedModel& linearised, double freedom, const Posterior& posterior,
                         const DataSet& data, const DiagnosisOptions& options, Diagnosis& into) {
  CorrectionValidation(linearised, freedom, posterior, data, options, into).run();
}

std::vector<ValidationRow> validation_rows(LinearisedModel& linearised, double freedom,
                                           const Posterior& posterior, const DataSet& data,
                                           const DiagnosisOptions& options, Diagnosis& of) {
  return CorrectionValidation(linearised, freedom, posterior, data, options, of)
      .of_everything()
      .rows;
}

}  // namespace selfcal
