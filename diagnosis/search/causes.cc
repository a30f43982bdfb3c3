#include "diagnosis/search/causes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include "diagnosis/constants.h"
#include "diagnosis/search/sign_flip_test.h"

namespace selfcal {
namespace {

/// A time, or the row of it where the order of the rows is the time: row 1 is at 0 s.
std::string time_in_words(double seconds, bool order_is_time) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", order_is_time ? std::ceil(seconds) + 1 : seconds);
  return text;
}

/// What the linear parameters do not say of it; a step lies `between` two rows, and others of the
/// same cause are at `further` moments.
std::string in_words(const EffectShape& shape,
                     const std::optional<std::pair<double, double>>& between,
                     const std::vector<double>& further, bool order_is_time) {
  const auto time = [&](double seconds) { return time_in_words(seconds, order_is_time); };
  const auto lasting = [&](double seconds) {
    char text[32];
    std::snprintf(text, sizeof text, order_is_time ? "%.0f rows" : "%.0f s", seconds);
    return std::string(text);
  };
  std::vector<std::string> parts;
  const std::string row = order_is_time ? "row " : "", rows = order_is_time ? "rows " : "",
                    unit = order_is_time ? "" : " s";
  if (shape.moment) parts.push_back("from " + row + time(*shape.moment) + unit + " on");
  if (between)
    parts.push_back("between " + rows + time(between->first) + " and " + time(between->second) +
                    unit);
  bool again = shape.moment.has_value();
  for (const double moment : further)
    parts.push_back((std::exchange(again, true) ? "again from " : "from ") + row + time(moment) +
                    unit + " on");
  if (shape.settle) parts.push_back("settling in " + lasting(*shape.settle));
  if (shape.lag) parts.push_back("lagging by " + lasting(*shape.lag));
  if (shape.by == "temperature") parts.emplace_back("following the temperature");
  if (shape.by == "tool") parts.emplace_back("of the tool itself");
  if (shape.tool) parts.emplace_back("of the tool too");
  if (shape.base) parts.emplace_back("of what carries the robot too");
  if (!shape.half_waves.empty()) parts.emplace_back("wandering");
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

class Teller {
 public:
  Teller(const LinearisedModel& linearised, const EvidenceEvaluator& evaluator,
         const Posterior& posterior)
      : linearised_(linearised), evaluator_(evaluator), posterior_(posterior) {}

  std::vector<CauseResult> causes() const {
    std::vector<CauseResult> list;
    for (const auto& [family, probability] : posterior_.family) {
      if (probability < kDiagnosis.naming.least_told) continue;
      CauseResult cause;
      cause.effect = family;
      cause.probability = std::min(probability, 1.0);
      cause.where = places(family, probability);
      describe(cause);
      confound(cause);
      doubt_order(cause);
      list.push_back(std::move(cause));
    }
    list.push_back({.effect = kNone, .probability = posterior_.none});
    list.push_back({.effect = kUnknown, .probability = std::min(posterior_.unknown, 1.0)});
    std::sort(list.begin(), list.end(),
              [](const auto& a, const auto& b) { return a.probability > b.probability; });
    return list;
  }

 private:
  const Candidate& candidate(int c) const { return linearised_.candidates().list[c]; }

  bool holds(const Hypothesis& h, const std::string& effect, const std::string& at) const {
    return std::any_of(h.candidates.begin(), h.candidates.end(), [&](int c) {
      return candidate(c).effect == effect && (at.empty() || candidate(c).at == at);
    });
  }

  /// None where it most probably acts on the whole robot.
  std::vector<std::string> places(const std::string& family, double probability) const {
    std::vector<std::pair<double, std::string>> ranked;
    for (const auto& [cause, p] : posterior_.cause)
      if (cause.first == family) ranked.emplace_back(-p, cause.second);
    std::sort(ranked.begin(), ranked.end());
    std::vector<std::string> list;
    if (!ranked.empty() && ranked.front().second.empty()) return list;
    std::erase_if(ranked, [](const auto& each) { return each.second.empty(); });
    for (const auto& [p, at] : ranked)
      if (list.empty() || -p > kDiagnosis.naming.also_there * probability) list.push_back(at);
    return list;
  }

  /// Size and parameters, from the most probable hypothesis that has the cause.
  void describe(CauseResult& cause) const {
    cause.settles =
        kDiagnosis.naming.settles * (linearised_.context().end - linearised_.context().begin);
    const std::string at = cause.where.empty() ? "" : cause.where.front();
    const auto found =
        std::find_if(posterior_.hypotheses.begin(), posterior_.hypotheses.end(),
                     [&](const Hypothesis& h) { return holds(h, cause.effect, at); });
    if (found == posterior_.hypotheses.end()) return;
    const MarginalLikelihood::Estimate estimate =
        evaluator_.marginal_likelihood(found->structure).estimate(evaluator_.terms(*found));
    Eigen::Index first = 0;
    double squares = 0;
    for (size_t i = 0; i < found->candidates.size(); ++i) {
      const int c = found->candidates[i];
      const Block& block = evaluator_.block(c);
      const auto size = static_cast<Eigen::Index>(block.columns.size());
      if (candidate(c).effect == cause.effect) {
        const Eigen::VectorXd v = estimate.mean.segment(first, size);
        squares += v.dot(evaluator_.marginal_likelihood(0).gram(block.columns) * v);
        cause.beyond_nuisance = std::max(cause.beyond_nuisance, evaluator_.beyond_nuisance(c));
        add_parameters(c, estimate, first, further_moments(*found, c), cause);
        evaluator_.add_sigma(c, found->sizes[i], cause.correction.back().sigma);
      }
      first += size;
    }
    const double noise = evaluator_.noise_variance(found->structure) * estimate.variance;
    cause.visible = std::sqrt(squares / evaluator_.marginal_likelihood(0).freedom() *
                              evaluator_.noise_variance(0) / noise);
  }

  /// The moments of the hypothesis' steps of one cause, but for the first of them.
  std::vector<double> further_moments(const Hypothesis& h, int first) const {
    std::vector<double> moments;
    for (const int c : h.candidates)
      if (c != first && candidate(c).effect == candidate(first).effect &&
          candidate(c).at == candidate(first).at && candidate(c).shape.moment)
        moments.push_back(*candidate(c).shape.moment);
    std::ranges::sort(moments);
    return moments;
  }

  void add_parameters(int c, const MarginalLikelihood::Estimate& estimate, Eigen::Index first,
                      const std::vector<double>& further, CauseResult& cause) const {
    const Candidate& found = candidate(c);
    FoundEffect effect{.what = {found.effect, found.at, found.shape}};
    if (cause.shape.empty()) {
      if (found.between) cause.between = when(found);
      cause.shape = in_words(found.shape, cause.between, further, linearised_.order_is_time());
    }
    for (size_t k = 0; k < candidate(c).main.size(); ++k) {
      const EffectParameter& p = linearised_.parameters()[candidate(c).main[k]];
      const Eigen::Index i = first + static_cast<Eigen::Index>(k);
      cause.parameters.push_back(
          {label(candidate(c).at.empty() ? "robot" : candidate(c).at, "") + "." + p.name, p.unit,
           estimate.mean[i], std::sqrt(estimate.variance * estimate.covariance(i, i)),
           p.usual_least, p.usual_most, p.positive});
      effect.values.emplace_back(p.name, estimate.mean[i]);
    }
    cause.correction.push_back(std::move(effect));
  }

  /// The rows between which a step lies, but for one in twenty of its probability.
  std::pair<double, double> when(const Candidate& step) const {
    std::map<std::pair<double, double>, double> probability;  // by the rows about a moment
    double all = 0;
    for (const Hypothesis& h : posterior_.hypotheses) {
      const Candidate* nearest = nullptr;
      for (const int c : h.candidates)
        if (const Candidate& each = candidate(c);
            each.between && each.effect == step.effect && each.at == step.at &&
            (!nearest || std::abs(*each.shape.moment - *step.shape.moment) <
                             std::abs(*nearest->shape.moment - *step.shape.moment)))
          nearest = &each;
      if (!nearest) continue;
      probability[*nearest->between] += std::exp(h.log_weight);
      all += std::exp(h.log_weight);
    }
    std::vector<std::pair<double, std::pair<double, double>>> likely;
    for (const auto& [rows, p] : probability) likely.emplace_back(p, rows);
    std::ranges::sort(likely, std::greater());
    std::pair<double, double> range{INFINITY, -INFINITY};
    double held = 0;
    for (const auto& [p, rows] : likely) {
      range = {std::min(range.first, rows.first), std::max(range.second, rows.second)};
      if ((held += p) >= kDiagnosis.naming.of_moment * all) break;
    }
    return range;
  }

  /// Other families that are probable where this one is not: the rows cannot tell them apart.
  void confound(CauseResult& cause) const {
    if (cause.probability < kDiagnosis.naming.worth_telling) return;
    std::map<Cause, double> instead;
    double with = 0;
    for (const Hypothesis& h : posterior_.hypotheses) {
      const double p = std::exp(h.log_weight);
      if (holds(h, cause.effect, "")) {
        with += p;
        continue;
      }
      for (const int c : h.candidates) instead[{candidate(c).effect, candidate(c).at}] += p;
      if (evaluator_.structure(h.structure).kind > 0 && h.candidates.empty())
        instead[{kUnknown, ""}] += p;
    }
    for (const auto& [other, p] : instead)
      if (p > kDiagnosis.naming.confounded * with)
        cause.confounded_with.push_back(label(other.first, other.second));
  }

  /// What drifts with the order of rows that carry no time may be what goes with their places.
  void doubt_order(CauseResult& cause) const {
    const double meant =
        std::ranges::find(linearised_.candidates().list, cause.effect, &Candidate::effect)->meant;
    if (meant >= 1) return;
    cause.together = std::min(cause.probability / meant, 1.0);
    if (std::ranges::count(cause.confounded_with, kUnknown) == 0)
      cause.confounded_with.emplace_back(kUnknown);
  }

  const LinearisedModel& linearised_;
  const EvidenceEvaluator& evaluator_;
  const Posterior& posterior_;
};

}  // namespace

std::string label(const std::string& effect, const std::string& at) {
  return at.empty() ? effect : effect + "@" + at;
}

std::vector<CauseResult> cause_results(const LinearisedModel& linearised,
                                       const EvidenceEvaluator& evaluator,
                                       const Posterior& posterior) {
  return Teller(linearised, evaluator, posterior).causes();
}

std::optional<UnknownStructure> structure_of_unknown(const EvidenceEvaluator& evaluator,
                                                     const Posterior& posterior,
                                                     const Robot& robot) {
  std::map<int, std::map<int, double>> weights;  // by domain and joint
  double all = 0;
  for (const Hypothesis& h : posterior.hypotheses)
    if (const auto& structure = evaluator.structure(h.structure); structure.kind > 0) {
      const double weight = std::exp(h.log_weight);
      weights[structure.kind][structure.joint] += weight;
      all += weight;
    }
  const auto largest = [](const std::map<int, double>& of) {
    return *std::ranges::max_element(of, {}, &std::pair<const int, double>::second);
  };
  std::map<int, double> by_kind, by_joint;
  for (const auto& [kind, joints] : weights)
    for (const auto& [joint, weight] : joints) {
      by_kind[kind] += weight;
      if (joint >= 0) by_joint[joint] += weight;
    }
  if (!by_joint.empty() && largest(by_joint).second > all / 2) {
    const int joint = largest(by_joint).first;
    std::map<int, double> of_joint;
    for (const auto& [kind, joints] : weights)
      if (const auto found = joints.find(joint); found != joints.end())
        of_joint[kind] = found->second;
    return UnknownStructure{static_cast<KernelDomain>(largest(of_joint).first),
                            robot.joints()[static_cast<std::size_t>(joint)].name};
  }
  if (!by_kind.empty() && largest(by_kind).second > all / 2)
    return UnknownStructure{static_cast<KernelDomain>(largest(by_kind).first)};
  return std::nullopt;
}

}  // namespace selfcal
