#include "diagnosis/report/named.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "diagnosis/constants.h"
#include "kinematics/effect.h"

namespace selfcal {
namespace {

/// `h` and what it lacks of one cause.
void add_named(Hypothesis& h, const CauseResult& cause, const Candidates& all,
               const Posterior& posterior) {
  CauseResult one{.effect = cause.effect, .correction = cause.correction};
  const auto named = [&](int c) { return names(one, all.list[static_cast<size_t>(c)]); };
  const std::vector<std::string> anywhere{""};
  for (const std::string& at : cause.where.empty() ? anywhere : cause.where) {
    one.where.clear();
    if (!at.empty()) one.where.push_back(at);
    if (std::ranges::any_of(h.candidates, named)) continue;
    for (const Hypothesis& other : posterior.hypotheses) {
      const auto found = std::ranges::find_if(other.candidates, named);
      if (found == other.candidates.end()) continue;
      h.candidates.push_back(*found);
      h.sizes.push_back(other.sizes[static_cast<size_t>(found - other.candidates.begin())]);
      break;
    }
  }
}

}  // namespace

bool names(const CauseResult& cause, const Candidate& candidate) {
  if (candidate.effect != cause.effect ||
      (!cause.where.empty() && std::ranges::count(cause.where, candidate.at) == 0))
    return false;
  bool other = false;  // it is there, and in the other way
  for (const FoundEffect& each : cause.correction) {
    if (each.what.at != candidate.at) continue;
    if (each.what.shape.moment.has_value() == candidate.shape.moment.has_value()) return true;
    other = true;
  }
  return !other;
}

bool is_of(const CauseResult& cause, const FoundEffect& found) {
  return names(cause,
               {.effect = found.what.effect, .at = found.what.at, .shape = found.what.shape});
}

bool names_any(const std::vector<CauseResult>& named, const Candidate& candidate) {
  return std::ranges::any_of(named,
                             [&](const CauseResult& each) { return names(each, candidate); });
}

bool is_beyond_usual(const NamedValue& v, double times) {
  return std::abs(v.value) - kDiagnosis.report.sigmas * v.sigma > times * v.usual_most;
}

const NamedValue* beyond_usual(const CauseResult& cause, double times) {
  const auto found = std::ranges::find_if(
      cause.parameters, [&](const NamedValue& v) { return is_beyond_usual(v, times); });
  return found == cause.parameters.end() ? nullptr : &*found;
}

const NamedValue* of_impossible_size(const CauseResult& cause) {
  if (cause.effect == "fixture_shift") return beyond_usual(cause, kDiagnosis.report.elsewhere);
  if (lasting_of(cause.effect) == EffectLasting::moved_at_will) return nullptr;
  return beyond_usual(cause, kDiagnosis.report.impossible);
}

std::vector<CauseResult> take_idle(std::vector<CauseResult>& named) {
  const auto closes = [](const CauseResult& each) {
    return of_impossible_size(each) || !each.closes_alone || !each.closes_beside ||
           *each.closes_alone >= kDiagnosis.naming.nothing_alone ||
           *each.closes_beside >= kDiagnosis.naming.nothing_beside;
  };
  if (std::ranges::none_of(named, closes)) return {};
  std::vector<CauseResult> idle;
  std::ranges::remove_copy_if(named, std::back_inserter(idle), closes);
  std::erase_if(named, [&](const CauseResult& each) { return !closes(each); });
  return idle;
}

Hypothesis with_named(Hypothesis h, const std::vector<CauseResult>& named, const Candidates& all,
                      const Posterior& posterior) {
  for (const CauseResult& each : named) add_named(h, each, all, posterior);
  return h;
}

bool is_moved_at_once(const CauseResult& cause) {
  return cause.effect == "base_drift" &&
         std::ranges::any_of(cause.correction, [](const FoundEffect& found) {
           return found.what.shape.moment.has_value();
         });
}

}  // namespace selfcal
