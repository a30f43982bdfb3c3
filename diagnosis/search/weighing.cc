#include "diagnosis/search/weighing.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "diagnosis/constants.h"
#include "diagnosis/evidence/discrepancy.h"
#include "diagnosis/evidence/visits.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

class Weighing {
 public:
  Weighing(LinearisedModel& linearised, const DataSet& data, const DiagnosisOptions& options,
           const Progress& progress)
      : linearised_(linearised), data_(data), options_(options), progress_(progress) {}

  Weighed run() {
    linearised_.try_fine_waves();
    offer_back();
    for (int pass = 0; pass < kDiagnosis.rows.passes; ++pass) {
      if (progress_) progress_("weighing the causes", 0.2 + 0.2 * pass);
      prepare();
      if (std::string problem = lacking(*evaluator_); !problem.empty())
        return {std::move(evaluator_), {}, std::move(problem)};
      posterior_ = evaluator_->search();
      // The evaluator and the linearised model must end up with the same rows.
      if (pass + 1 == kDiagnosis.rows.passes) break;
      const std::vector<char> aside = linearised_.outlier();
      const bool refined = refine_by(posterior_.hypotheses.front());
      // By the candidates' places, which change where more of them are tried.
      const std::vector<ShapedEffect> steps = likely_steps();
      const std::vector<char> pulses = there_and_back(posterior_.hypotheses.front());
      const bool finer = linearised_.try_moments_near(steps);
      if (finer) linearised_.take_back(wronged_by(steps, aside));
      const bool waves = linearised_.try_fine_waves();
      const bool fewer = linearised_.put_aside(pulses);
      if (!finer && !waves && !refined && !fewer) break;
    }
    return {std::move(evaluator_), std::move(posterior_), {}};
  }

 private:
  void prepare() {
    evaluator_.reset();  // before there is a second one
    evaluator_ = evidence_of(linearised_, data_, options_.search);
  }

  bool refine_by(const Hypothesis& best) {
    const auto [columns, sigma] = MarginalLikelihood::unfold(evaluator_->terms(best));
    const double variance =
        evaluator_->marginal_likelihood(best.structure).estimate(evaluator_->terms(best)).variance *
        evaluator_->noise_variance(best.structure);
    return linearised_.refine(linearised_.residuals(columns, sigma), variance);
  }

  /// A cause that acts in few rows has these put aside before it is looked for. Where one of all
  /// rows that a machine can have leaves hardly any of them far, they take part.
  void offer_back() {
    const std::vector<char> aside = linearised_.outlier();
    const auto count = std::ranges::count(aside, char{1});
    if (count < kDiagnosis.rows.fewest_offered && !follow_each_other(aside)) return;
    linearised_.start_with(std::vector<char>(aside.size(), 0));
    prepare();
    if (lacking(*evaluator_).empty()) {
      posterior_ = evaluator_->search();
      const Hypothesis& best = posterior_.hypotheses.front();
      if (!best.candidates.empty() && !evaluator_->is_impossible(best)) {
        refine_by(best);
        const auto left = std::ranges::count(linearised_.outlier(), char{1});
        if (static_cast<double>(left) <= kDiagnosis.rows.hardly_any * static_cast<double>(count))
          return;
      }
    }
    linearised_.start_with(aside);
  }

  /// Some rows `aside` are next to each other in time among those of their set that identify, as
  /// behind a step near the end.
  bool follow_each_other(const std::vector<char>& aside) const {
    std::vector<char> before(data_.sets.size(), 0);
    for (const int row : in_time(data_.rows)) {
      const auto at = static_cast<std::size_t>(row);
      if (data_.rows.check[at] != 0) continue;
      char& last = before[static_cast<std::size_t>(data_.rows.set[at])];
      if (last && aside[at]) return true;
      last = aside[at];
    }
    return false;
  }

  /// The rows for which one cause steps away and back, where they are so few that these are false.
  std::vector<char> there_and_back(const Hypothesis& best) const {
    std::vector<char> rows(linearised_.outlier().size(), 0);
    const std::vector<MarginalLikelihood::Term> terms = evaluator_->terms(best);
    const MarginalLikelihood& own = evaluator_->marginal_likelihood(best.structure);
    const Eigen::VectorXd mean = own.estimate(terms).mean;
    std::vector<Eigen::VectorXd> steps;  // by candidate
    Eigen::Index first = 0;
    for (const MarginalLikelihood::Term& term : terms) {
      const auto size = static_cast<Eigen::Index>(term.block->columns.size());
      steps.emplace_back(mean.segment(first, size));
      first += size;
    }
    const std::vector<Candidate>& list = evaluator_->candidates().list;
    for (std::size_t a = 0; a < steps.size(); ++a)
      for (std::size_t b = 0; b < steps.size(); ++b) {
        const Candidate &away = list[static_cast<std::size_t>(best.candidates[a])],
                        &back = list[static_cast<std::size_t>(best.candidates[b])];
        if (away.effect != back.effect || away.at != back.at || !away.shape.moment ||
            !back.shape.moment || *away.shape.moment >= *back.shape.moment ||
            steps[a].size() != steps[b].size() ||
            // As the rows behind both see them.
            !(steps[a].dot(own.gram(*terms[b].block) * steps[b]) < 0))
          continue;
        const std::vector<std::size_t> between =
            rows_between(*away.shape.moment, *back.shape.moment, away.at);
        if (between.size() >= kDiagnosis.shapes.fewest_between) continue;
        for (const std::size_t row : between) rows[row] = 1;
      }
    return rows;
  }

  /// Rows that take part, between two moments; of one set alone where `at` is one.
  std::vector<std::size_t> rows_between(double from, double to, const std::string& at) const {
    const auto named = std::ranges::find(data_.sets, at, &Set::name);
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < linearised_.outlier().size(); ++row) {
      const double t = data_.rows.time[static_cast<Eigen::Index>(row)];
      if (t > from && t < to && data_.rows.check[row] == 0 && !linearised_.outlier()[row] &&
          (named == data_.sets.end() || data_.rows.set[row] == named - data_.sets.begin()))
        rows.push_back(row);
    }
    return rows;
  }

  /// Of the most probable hypothesis with any: rows on the wrong side of a step may be what speaks
  /// for another.
  std::vector<ShapedEffect> likely_steps() const {
    std::vector<ShapedEffect> steps;
    for (const Hypothesis& h : posterior_.hypotheses) {
      if (h.log_weight < std::log(kDiagnosis.shapes.likely)) break;
      for (const int c : h.candidates)
        if (const Candidate& each = linearised_.candidates().list[c]; each.shape.moment)
          steps.push_back({each.effect, each.at, each.shape});
      if (!steps.empty()) break;
    }
    if (const Candidate* step = plainest_step())
      steps.push_back({step->effect, step->at, step->shape});
    return steps;
  }

  /// The step that alone explains most, where that is much: a row on its wrong side speaks against
  /// it so loudly that it may be in no probable hypothesis yet.
  const Candidate* plainest_step() const {
    const std::vector<Candidate>& list = linearised_.candidates().list;
    const Candidate* plainest = nullptr;
    double most = kDiagnosis.shapes.plain;
    for (int c = 0; c < static_cast<int>(list.size()); ++c) {
      const Candidate& each = list[static_cast<std::size_t>(c)];
      const double evidence = each.shape.moment ? evaluator_->evidence(c) : 0;
      if (evidence <= most) continue;
      most = evidence;
      plainest = &each;
    }
    return plainest;
  }

  /// The rows that were not put `aside` until a step was supposed at one of few moments, and lie
  /// between that and the next: they speak for another moment.
  std::vector<char> wronged_by(const std::vector<ShapedEffect>& steps,
                               const std::vector<char>& aside) const {
    std::vector<char> rows(aside.size(), 0);
    const std::vector<int> order = in_time(data_.rows);
    const auto apart = static_cast<std::ptrdiff_t>(order.size()) / kDiagnosis.shapes.moments + 1;
    const std::vector<char>& outlier = linearised_.outlier();
    for (const ShapedEffect& step : steps) {
      const auto behind = std::ranges::find_if(
          order, [&](int row) { return data_.rows.time[row] >= *step.shape.moment; });
      const auto from = behind - std::min(apart, behind - order.begin());
      const auto to = behind + std::min(apart, order.end() - behind);
      for (auto at = from; at != to; ++at) {
        const auto row = static_cast<std::size_t>(*at);
        if (outlier[row] && !aside[row]) rows[row] = 1;
      }
    }
    return rows;
  }

  LinearisedModel& linearised_;
  const DataSet& data_;
  const DiagnosisOptions& options_;
  const Progress& progress_;
  std::unique_ptr<EvidenceEvaluator> evaluator_;
  Posterior posterior_;
};

}  // namespace

std::unique_ptr<EvidenceEvaluator> evidence_of(const LinearisedModel& linearised,
                                               const DataSet& data, const SearchRule& rule) {
  const DenseEquations rows = linearised.kept();
  return std::make_unique<EvidenceEvaluator>(
      linearised.whitened(),
      structures(data.rows, rows, linearised.ends(), size_of(linearised.geometry()),
                 linearised.joint_errors(), noise_of_visits(data.rows, rows, linearised.left())),
      linearised.candidates(), linearised.parameters(), rule);
}

std::string lacking(const EvidenceEvaluator& evaluator) {
  const double freedom = evaluator.marginal_likelihood(0).freedom();
  if (freedom >= kDiagnosis.rows.fewest_freedoms) return {};
  return "too few rows for a diagnosis: beyond what calibration takes they leave " +
         format_number(std::max(0.0, std::floor(freedom))) + " equations, at least " +
         format_number(kDiagnosis.rows.fewest_freedoms) + " are needed";
}

Weighed weigh(LinearisedModel& linearised, const DataSet& data, const DiagnosisOptions& options,
              const Progress& progress) {
  return Weighing(linearised, data, options, progress).run();
}

}  // namespace selfcal
