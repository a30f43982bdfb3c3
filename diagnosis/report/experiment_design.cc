// Expected log evidence of A over B, A true: half of what A's rows leave beyond geometry and B, in
// squared sigmas. The odds after the new rows are those of now times the exponential of its growth.
#include "diagnosis/report/experiment_design.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>

#include "diagnosis/constants.h"
#include "diagnosis/report/candidate_rows.h"
#include "diagnosis/report/row_choice.h"
#include "diagnosis/report/separation.h"
#include "diagnosis/search/causes.h"

namespace selfcal {
namespace {

std::string first_label(const CauseResult& cause) {
  return label(cause.effect, cause.where.empty() ? "" : cause.where.front());
}

/// Is it the one or the other? Without another one: or noise.
struct Question {
  const CauseResult* one;
  const CauseResult* other;
  double probability;  ///< of the one, now

  std::vector<std::string> names() const {
    return {first_label(*one), other ? first_label(*other) : std::string(kNone)};
  }
};

std::vector<Node> other_entries(const CauseResult* other) {
  return other ? entries_of(other->correction) : std::vector<Node>{};
}

double odds(double one, double other) {
  constexpr double kLeast = kDiagnosis.report.least_of_pair;
  return std::clamp(one / std::max(one + other, 1e-12), kLeast, 1 - kLeast);
}

/// The most probable of the causes that are listed as look-alikes; null where none of them is
/// known.
const CauseResult* look_alike(const Diagnosis& diagnosis, const CauseResult& of) {
  for (const CauseResult& each : diagnosis.candidates)
    for (const std::string& name : of.confounded_with)
      if (each.effect != of.effect && !each.correction.empty() &&
          name.substr(0, name.find('@')) == each.effect)
        return &each;
  return nullptr;
}

std::vector<Question> questions(const Diagnosis& diagnosis) {
  std::vector<Question> list;
  for (const CauseResult& each : diagnosis.named)
    if (const CauseResult* other = look_alike(diagnosis, each); other && !each.correction.empty())
      list.push_back({&each, other, odds(each.probability, other->probability)});
  if (names_effect(diagnosis.verdict.effect)) return list;
  double none = 0;
  for (const CauseResult& each : diagnosis.candidates)
    if (each.effect == kNone) none = each.probability;
  for (const CauseResult& each : diagnosis.candidates) {
    const bool named = std::ranges::count(diagnosis.named, each.effect, &CauseResult::effect) > 0;
    if (each.correction.empty() || each.probability < kDiagnosis.report.edge || named) continue;
    list.push_back({&each, nullptr, odds(each.probability, none)});
    const CauseResult* other = look_alike(diagnosis, each);
    if (other && other->probability >= kDiagnosis.report.edge)
      list.push_back({&each, other, odds(each.probability, other->probability)});
    break;
  }
  return list;
}

/// The structure may be anything: the answer, what these rows cannot tell from it, or what is left
/// beside it.
bool unknown_at_issue(const Diagnosis& diagnosis) {
  return diagnosis.verdict.effect == kUnknown ||
         (names_effect(diagnosis.verdict.effect) &&
          std::ranges::any_of(diagnosis.candidates,
                              [](const CauseResult& each) {
                                return each.effect == kUnknown &&
                                       each.probability > kDiagnosis.report.beside;
                              })) ||
         std::ranges::any_of(diagnosis.named, [](const CauseResult& each) {
           return std::ranges::count(each.confounded_with, kUnknown) > 0;
         });
}

double probability_of(const Diagnosis& diagnosis, std::string_view effect) {
  const auto found = std::ranges::find(diagnosis.candidates, effect, &CauseResult::effect);
  return found == diagnosis.candidates.end() ? 0 : found->probability;
}

/// The causes that rows shall tell apart, most probable first: those that are probable, or look
/// like one that is; none where it is settled.
std::vector<const CauseResult*> at_issue(const Diagnosis& diagnosis) {
  const auto looks_alike = [&](const CauseResult& each) {
    return std::ranges::any_of(diagnosis.candidates, [&](const CauseResult& other) {
      return other.probability >= kDiagnosis.report.edge &&
             std::ranges::any_of(other.confounded_with, [&](const std::string& name) {
               return name.substr(0, name.find('@')) == each.effect;
             });
    });
  };
  std::vector<const CauseResult*> list;
  for (const CauseResult& each : diagnosis.candidates)
    if (!each.correction.empty() && list.size() < kDiagnosis.report.most_at_issue &&
        (each.probability >= kDiagnosis.report.least_at_issue || looks_alike(each)))
      list.push_back(&each);
  const bool settled =
      list.empty() ||
      (list.size() == 1 && (list.front()->probability >= kDiagnosis.report.settled ||
                            probability_of(diagnosis, kNone) < kDiagnosis.report.edge));
  if (settled || list.front()->probability < kDiagnosis.report.edge) return {};
  return list;
}

class Planner {
 public:
  Planner(const LinearisedModel& linearised, const DataSet& data, const Diagnosis& diagnosis,
          const DiagnosisOptions& options)
      : linearised_(linearised),
        data_(data),
        diagnosis_(diagnosis),
        options_(options),
        asked_(questions(diagnosis)) {}

  NextSteps run() {
    if (options_.possible) return choose();
    if (asked_.empty() && !unknown_at_issue(diagnosis_)) return {{}, why_nothing()};
    further_ = candidate_rows(linearised_, data_);
    for (const Question& each : asked_) try_all(each);
    take_best();
    if (unknown_at_issue(diagnosis_)) look_closer();
    if (next_.steps.empty() && next_.why.empty())
      next_.why = "this robot and these rows leave nothing to change from one visit to another";
    return std::move(next_);
  }

 private:
  /// Those of the possible rows that tell all that is at issue from each other.
  NextSteps choose() {
    const std::vector<const CauseResult*> causes = at_issue(diagnosis_);
    if (causes.empty()) return {{}, why_nothing()};
    DataSet both = data_;
    both.rows = joined(data_.rows, options_.possible->rows);
    const int first = data_.rows.rows();
    both.rows.check.resize(both.rows.set.size(), 0);
    if (both.rows.time.size() > 0)
      both.rows.time.tail(both.rows.rows() - first).setConstant(linearised_.context().end + 1);
    std::vector<CausePair> pairs;
    const double none = probability_of(diagnosis_, kNone);
    for (const CauseResult* one : causes) {
      for (const CauseResult* other : causes)
        if (one != other)
          pairs.push_back(pair_of(*one, entries_of(other->correction), other->probability));
      if (none >= kDiagnosis.report.edge) pairs.push_back(pair_of(*one, {}, none));
    }
    if (pairs.empty()) return {{}, why_nothing()};
    const RowChoice choice = choose_rows(linearised_, both, first, pairs, options_.most_further);
    if (choice.rows.empty())
      return {{}, "none of the rows that can be taken tells these causes apart"};
    NextStep step;
    std::map<std::string, int> kinds;
    for (const int row : choice.rows) {
      step.chosen.push_back(row - first);
      ++kinds[options_.possible->what[static_cast<size_t>(row - first)]];
    }
    for (const auto& [what, count] : kinds)
      step.what += (step.what.empty() ? "take " : ", ") + std::to_string(count) + " " + what;
    for (const CauseResult* each : causes) step.separates.push_back(first_label(*each));
    if (none >= kDiagnosis.report.edge) step.separates.emplace_back(kNone);
    double left = 0;
    for (size_t k = 0; k < pairs.size(); ++k)
      left +=
          2 * pairs[k].weight * std::exp(-choice.apart[k] / 2) / static_cast<double>(pairs.size());
    step.probability_after = 1 - std::min(left, 1.0);
    step.rows = taken(both.rows, choice.rows);
    return {{std::move(step)}, {}};
  }

  static CausePair pair_of(const CauseResult& one, std::vector<Node> other, double probability) {
    const double p = std::max(one.probability, kDiagnosis.report.least_at_issue),
                 q = std::max(probability, kDiagnosis.report.least_at_issue);
    return {entries_of(one.correction), std::move(other), p * q / (p + q)};
  }

  std::string why_nothing() const {
    if (names_effect(diagnosis_.verdict.effect)) return "no other cause looks like what is named";
    return "no cause is as probable as " + format_number(100 * kDiagnosis.report.edge) +
           " %: more of the same rows would only lower that";
  }

  Observations rows_of(const CandidateRows& further) const {
    std::vector<int> added(further.both.rows.rows() - data_.rows.rows());
    std::iota(added.begin(), added.end(), data_.rows.rows());
    return taken(further.both.rows, added);
  }

  /// What a question's rows would tell, and the log evidence that they are worth.
  struct Tried {
    NextStep step;
    double gain;
  };

  std::vector<Tried> tried(const Question& asked) const {
    const double p = asked.probability;
    std::vector<Tried> list;
    for (const CandidateRows& further : further_) {
      Separation causes(linearised_, entries_of(asked.one->correction), other_entries(asked.other),
                        further.both, data_.rows.rows());
      const double now = causes.apart();
      causes.take_all();
      const double gain = (causes.apart() - now) / 2;
      list.push_back(
          {{further.what, asked.names(), 1 / (1 + (1 - p) / p * std::exp(-gain)), rows_of(further)},
           gain});
    }
    std::ranges::stable_sort(list, std::ranges::greater{}, &Tried::gain);
    return list;
  }

  /// The best for each question, and all others that are worth their while; where the best leaves
  /// the question open, that it does.
  void try_all(const Question& asked) {
    std::vector<Tried> list = tried(asked);
    if (list.empty()) return;
    if (list.front().step.probability_after < kDiagnosis.report.settled)
      next_.why += (next_.why.empty() ? "" : "; ") + left_open(asked, list.front());
    next_.steps.push_back(std::move(list.front().step));
    for (auto each = list.begin() + 1; each != list.end(); ++each)
      if (each->step.probability_after > asked.probability + kDiagnosis.report.worth)
        others_.push_back(std::move(each->step));
  }

  /// How many rows like these it would take, each worth as much as the next one.
  static std::string left_open(const Question& asked, const Tried& best) {
    const auto log_odds = [](double p) { return std::log(p / (1 - p)); };
    const std::string names = asked.names().front() + " from " + asked.names().back();
    const double times =
        (log_odds(kDiagnosis.report.settled) - log_odds(asked.probability)) / best.gain;
    if (!(best.gain > 0 && times <= kDiagnosis.report.most_times))
      return "rows of no such kind tell " + names +
             ": what corrects the one corrects the other, as far as they can show";
    return "\"" + best.step.what + "\" is not enough to tell " + names + ": about " +
           format_number(std::ceil(times)) + " times as many rows are, " +
           format_number(100 * kDiagnosis.report.settled) + " % sure";
  }

  /// Every question's best step, and the best of the others up to as many as are told.
  void take_best() {
    std::ranges::stable_sort(others_, std::ranges::greater{}, &NextStep::probability_after);
    for (NextStep& each : others_)
      if (next_.steps.size() < kDiagnosis.report.most_steps) next_.steps.push_back(std::move(each));
    std::ranges::stable_sort(next_.steps, std::ranges::greater{}, &NextStep::probability_after);
  }

  /// What would show of which kind the structure is; how sure one would be then, nobody knows.
  void look_closer() {
    size_t told = 0;
    for (const CandidateRows& each : further_)
      if (!each.tells.empty() && told++ < kDiagnosis.report.most_for_unknown &&
          std::ranges::find(next_.steps, each.what, &NextStep::what) == next_.steps.end())
        next_.steps.push_back({each.what,
                               {kUnknown, each.tells},
                               std::numeric_limits<double>::quiet_NaN(),
                               rows_of(each)});
  }

  const LinearisedModel& linearised_;
  const DataSet& data_;
  const Diagnosis& diagnosis_;
  const DiagnosisOptions& options_;
  const std::vector<Question> asked_;
  std::vector<CandidateRows> further_;
  std::vector<NextStep> others_;  ///< that are not the best for their question
  NextSteps next_;
};

}  // namespace

NextSteps next_steps(const LinearisedModel& linearised, const DataSet& data,
                     const Diagnosis& diagnosis, const DiagnosisOptions& options) {
  return Planner(linearised, data, diagnosis, options).run();
}

}  // namespace selfcal
