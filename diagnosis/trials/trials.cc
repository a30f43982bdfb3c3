// Shares are counted over the trials that a line asks about: of one cause, a pair, none, unknown.
// Expected calibration error: over ten bins of the stated probability, the difference between its
// mean and the share of verdicts that name a true cause, weighed by the bin's trials.
#include "diagnosis/trials/trials.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace selfcal {
namespace {

bool names_or_confounds(const TrialCauseNamed& cause, const std::string& effect) {
  if (cause.effect == effect) return true;
  return cause.probability <= kMostWhenConfounded &&
         std::any_of(
             cause.confounded_with.begin(), cause.confounded_with.end(),
             [&](const std::string& other) { return other.substr(0, other.find('@')) == effect; });
}

struct Trial {
  TrialTruth truth;
  std::optional<TrialAnswer> answer;

  bool single() const { return names_effect(truth.effect) && truth.second.empty(); }
  bool pair() const { return !truth.second.empty(); }
  bool says(const std::function<bool(const TrialAnswer&)>& what) const {
    return answer && what(*answer);
  }
};

class Table {
 public:
  Table(const TrialTruths& truths, const TrialAnswers& answers) {
    for (const auto& [name, truth] : truths) {
      Trial trial{truth, std::nullopt};
      if (const auto found = answers.find(name); found != answers.end())
        trial.answer = found->second;
      trials_.push_back(std::move(trial));
    }
  }

  using Which = std::function<bool(const Trial&)>;

  /// Share of the trials `asked` for which `counts` holds.
  void share(ScoreLine line, const Which& asked, const Which& counts) {
    line.count = 0;
    for (const Trial& trial : trials_)
      if (asked(trial)) {
        ++line.of;
        *line.count += counts(trial) ? 1 : 0;
      }
    if (line.of > 0) line.value = static_cast<double>(*line.count) / line.of;
    lines_.push_back(std::move(line));
  }

  void calibration() {
    struct Bin {
      double stated = 0, right = 0, trials = 0;
    };
    std::vector<Bin> bins(10);
    ScoreLine line{"calibration_error", "expected calibration error of the verdict's probability"};
    for (const Trial& trial : trials_) {
      if (!trial.answer) continue;
      const TrialCauseNamed& verdict = trial.answer->verdict;
      Bin& bin = bins[static_cast<size_t>(std::clamp(verdict.probability * 10, 0.0, 9.0))];
      bin.stated += verdict.probability;
      bin.right += right_cause(trial.truth, *trial.answer) ? 1 : 0;
      bin.trials += 1;
      ++line.of;
    }
    double error = 0;
    for (const Bin& bin : bins) error += std::abs(bin.stated - bin.right);
    if (line.of > 0) line.value = error / line.of;
    line.target = 0.05;
    line.at_most = true;
    lines_.push_back(std::move(line));
  }

  void closed() {
    ScoreLine line{"closed_over_told", "closed fraction over that of a fit told the cause"};
    double answered = 0, told = 0;
    bool any = false;  // a method that says nothing of it has no score
    for (const Trial& trial : trials_) {
      if (!names_effect(trial.truth.effect) || !trial.truth.told_closed) continue;
      told += *trial.truth.told_closed;
      answered += trial.answer ? std::clamp(trial.answer->closed.value_or(0), 0.0, 1.0) : 0;
      any = any || (trial.answer && trial.answer->closed);
      ++line.of;
    }
    if (any && told > 0) line.value = answered / told;
    line.target = 0.95;
    lines_.push_back(std::move(line));
  }

  std::vector<ScoreLine> lines() { return std::move(lines_); }

 private:
  std::vector<Trial> trials_;
  std::vector<ScoreLine> lines_;
};

ScoreLine line(std::string name, std::string what, double target, bool at_most = false) {
  ScoreLine out{std::move(name), std::move(what)};
  out.target = target;
  out.at_most = at_most;
  return out;
}

void add_causes(Table& table) {
  const auto right = [](const Trial& t) {
    return t.says([&](const TrialAnswer& a) { return right_cause(t.truth, a); });
  };
  const auto placed = [](const Trial& t) {
    return t.says([&](const TrialAnswer& a) { return right_place(t.truth, a); });
  };
  const auto from = [](double least, double below) {
    return [=](const Trial& t) { return t.single() && t.truth.r >= least && t.truth.r < below; };
  };
  table.share(line("right_cause_r_0.5", "right cause at r 0.5", 0.65), from(0, 0.6), right);
  table.share(line("right_cause_r_0.75", "right cause at r 0.75", 0.85), from(0.6, 0.9), right);
  table.share(line("right_cause_r_1", "right cause at r 1 and above", 0.97), from(0.9, HUGE_VAL),
              right);
  table.share(
      line("right_place", "right place among the right causes", 0.95),
      [&](const Trial& t) { return t.single() && right(t); }, placed);
  table.share(
      line("both_of_a_pair", "both causes of a pair at r 1 and above", 0.8),
      [](const Trial& t) { return t.pair() && t.truth.r >= 0.9; },
      [](const Trial& t) {
        return t.says([&](const TrialAnswer& a) { return both_causes(t.truth, a); });
      });
}

void add_absences(Table& table) {
  const auto none = [](const Trial& t) { return t.truth.effect == kNone; };
  const auto unknown = [](const Trial& t) { return t.truth.effect == kUnknown; };
  const auto verdict = [](const std::string& effect) {
    return [=](const Trial& t) {
      return t.says([&](const TrialAnswer& a) { return a.verdict.effect == effect; });
    };
  };
  table.share(line("false_alarms", "a named cause where there is none", 0.01, true), none,
              [](const Trial& t) {
                return t.says([](const TrialAnswer& a) { return names_effect(a.verdict.effect); });
              });
  table.share(line("unknown_on_none", "`unknown` where there is nothing", 0.05, true), none,
              verdict(kUnknown));
  table.share(
      line("unknown_recognised", "`unknown` recognised at r 1.5 and above", 0.85),
      [&](const Trial& t) { return unknown(t) && t.truth.r >= 1.4; }, verdict(kUnknown));
  table.share(line("confident_on_unknown",
                   "a named cause (probability 0.5 and above) where it is unknown", 0.05, true),
              unknown, [](const Trial& t) {
                return t.says([](const TrialAnswer& a) {
                  return names_effect(a.verdict.effect) && a.verdict.probability >= kConfident;
                });
              });
}

}  // namespace

bool right_cause(const TrialTruth& truth, const TrialAnswer& answer) {
  return names_or_confounds(answer.verdict, truth.effect) ||
         (!truth.second.empty() && names_or_confounds(answer.verdict, truth.second));
}

bool right_place(const TrialTruth& truth, const TrialAnswer& answer) {
  const auto found = truth.where.find(answer.verdict.effect);
  if (found == truth.where.end()) {  // right by being confounded with it: that names the place
    return std::any_of(answer.verdict.confounded_with.begin(), answer.verdict.confounded_with.end(),
                       [&](const std::string& other) {
                         const auto at = other.find('@');
                         const auto place = truth.where.find(other.substr(0, at));
                         if (place == truth.where.end()) return false;
                         return at == std::string::npos || place->second.empty() ||
                                std::count(place->second.begin(), place->second.end(),
                                           other.substr(at + 1)) > 0;
                       });
  }
  if (found->second.empty()) return true;
  int right = 0, wrong = 0;
  for (const std::string& place : answer.verdict.where)
    ++(std::count(found->second.begin(), found->second.end(), place) > 0 ? right : wrong);
  return right > 0 && wrong <= 1;
}

bool both_causes(const TrialTruth& truth, const TrialAnswer& answer) {
  const auto named = [&](const std::string& effect) {
    return names_or_confounds(answer.verdict, effect) ||
           std::any_of(answer.candidates.begin(), answer.candidates.end(),
                       [&](const TrialCauseNamed& each) {
                         return each.probability >= kConfident && names_or_confounds(each, effect);
                       });
  };
  return named(truth.effect) && named(truth.second);
}

std::vector<ScoreLine> score(const TrialTruths& truths, const TrialAnswers& answers) {
  Table table(truths, answers);
  add_causes(table);
  add_absences(table);
  table.calibration();
  table.closed();
  return table.lines();
}

}  // namespace selfcal
