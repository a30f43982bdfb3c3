// A stated probability p comes true as often as sigmoid(logit(p) / T) says, T fitted to the
// simulated sessions by maximum likelihood; T > 1 where the search is surer than it may be.
#include "diagnosis/search/simulation_based_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "diagnosis/constants.h"
#include "diagnosis/search/naming.h"

namespace selfcal {
namespace {

double clamped_logit(double p) {
  p = std::clamp(p, kDiagnosis.simulation.hardly, 1 - kDiagnosis.simulation.hardly);
  return std::log(p / (1 - p));
}

struct Stated {
  double probability = 0;
  bool right = false;
};

class Simulator {
 public:
  Simulator(const LinearisedModel& linearised, EvidenceEvaluator& evaluator,
            const NullDistribution& null, const DiagnosisOptions& options)
      : linearised_(linearised),
        evaluator_(evaluator),
        null_(null),
        options_(options),
        rows_(evaluator.rows().rows()),
        random_(options.seed) {}

  SimulationBasedCalibration run() {
    SimulationBasedCalibration simulation;
    std::vector<Stated> stated;
    int causes = 0, none = 0;
    for (int first = 0; first < options_.simulated_sessions; first += kDiagnosis.simulation.at_once)
      for (const auto& [truth, answer] :
           answers(std::min(kDiagnosis.simulation.at_once, options_.simulated_sessions - first))) {
        stated.push_back({answer.probability, answer.effect == truth});
        if (truth == kNone) {
          ++none;
          simulation.false_alarms += answer.effect != kNone;
        } else {
          ++causes;
          simulation.right += answer.effect == truth;
        }
      }
    simulation.sessions = options_.simulated_sessions;
    simulation.right /= std::max(causes, 1);
    simulation.false_alarms /= std::max(none, 1);
    // The sessions share the model's assumptions, as no machine does: they make nothing surer.
    simulation.temperature = std::max(1.0, fitted(stated));
    evaluator_.condition_on_rows();
    return simulation;
  }

 private:
  /// Of further sessions: what is true, and what is answered.
  std::vector<std::pair<std::string, CauseResult>> answers(int sessions) {
    std::vector<std::pair<std::string, CauseResult>> list(static_cast<std::size_t>(sessions));
    Eigen::MatrixXd Y(rows_.y.size(), sessions);
    Eigen::Index drawn = 0;
    for (auto& each : list) Y.col(drawn++) = session(each.first);
    const EvidenceEvaluator::Statistics statistics = evaluator_.statistics_of(Y);
    for (std::size_t i = 0; i < list.size(); ++i) {
      evaluator_.condition_on(statistics, static_cast<Eigen::Index>(i));
      list[i].second = answered(evaluator_.search_coarsely(kDiagnosis.simulation.extended_singles));
    }
    return list;
  }

  CauseResult answered(const Posterior& posterior) const {
    CauseResult best{.effect = kUnknown, .probability = posterior.unknown};
    if (posterior.none >= options_.name_below_none)
      best = without_cause(posterior);
    else
      for (const auto& [family, p] : posterior.family)
        if (p > best.probability) best = {.effect = family, .probability = p};
    return decided(std::move(best), posterior, {null_.p_of(evaluator_.best_found().log_odds), 0},
                   options_);
  }

  Eigen::VectorXd normal(Eigen::Index size) {
    std::normal_distribution<double> draw;
    Eigen::VectorXd v(size);
    for (double& x : v) x = draw(random_);
    return v;
  }

  Eigen::VectorXd session(std::string& truth) {
    const double kind = std::generate_canonical<double, 53>(random_);
    if (kind < kDiagnosis.simulation.with_unknown) {
      truth = kUnknown;
      std::vector<int> known_size;
      for (int s = 0; s < evaluator_.structures(); ++s)
        if (evaluator_.structure(s).kind > 0 && evaluator_.structure(s).kappa > 1)
          known_size.push_back(s);
      if (known_size.empty()) return normal(rows_.y.size());
      const DiscrepancyCovariance& structure =
          evaluator_.structure(known_size[random_() % known_size.size()]);
      return structure.coloured(normal(rows_.y.size()));
    }
    const DiscrepancyCovariance& noise = evaluator_.structure(0);
    Eigen::VectorXd y = noise.coloured(normal(rows_.y.size()));
    truth = kNone;
    if (kind < kDiagnosis.simulation.with_unknown + kDiagnosis.simulation.with_none) return y;
    const int c = drawn_cause();
    if (c < 0) return y;
    truth = linearised_.candidates().list[c].effect;
    const Block& block = evaluator_.block(c);
    const double r =
        kDiagnosis.simulation.visible[random_() % kDiagnosis.simulation.visible.size()] *
        std::sqrt(noise.noise);
    Eigen::VectorXd size = normal(block.unit.size());
    for (const int i : block.positive) size[i] = std::abs(size[i]);
    return y + rows_.C(Eigen::all, block.columns) * (r * block.unit.cwiseProduct(size));
  }

  /// A family, then a place and a shape of it, each as likely as the others; -1 when calibration
  /// absorbs all of them.
  int drawn_cause() {
    std::vector<std::string> families;
    std::vector<int> seen;
    for (int c = 0; c < static_cast<int>(linearised_.candidates().list.size()); ++c) {
      if (evaluator_.beyond_nuisance(c) < kDiagnosis.simulation.least_beyond_nuisance)
        continue;  // absorbed by calibration: no cause of this session
      seen.push_back(c);
      const std::string& effect = linearised_.candidates().list[c].effect;
      if (families.empty() || families.back() != effect) families.push_back(effect);
    }
    std::sort(families.begin(), families.end());
    families.erase(std::unique(families.begin(), families.end()), families.end());
    if (families.empty()) return -1;
    const std::string family = families[random_() % families.size()];
    std::erase_if(seen, [&](int c) { return linearised_.candidates().list[c].effect != family; });
    return seen[random_() % seen.size()];
  }

  static double fitted(const std::vector<Stated>& stated) {
    double best = 1, most = -INFINITY;
    const DiagnosisConstants::Simulation& constants = kDiagnosis.simulation;
    for (double T = constants.coldest; T < constants.hottest; T *= constants.step) {
      double log_likelihood = -constants.far_from_one * std::pow(std::log(T), 2);
      for (const Stated& each : stated) {
        const double p = 1 / (1 + std::exp(-clamped_logit(each.probability) / T));
        log_likelihood += std::log(each.right ? p : 1 - p);
      }
      if (log_likelihood <= most) continue;
      most = log_likelihood;
      best = T;
    }
    return best;
  }

  const LinearisedModel& linearised_;
  EvidenceEvaluator& evaluator_;
  const NullDistribution& null_;
  const DiagnosisOptions& options_;
  const Whitened& rows_;
  std::mt19937_64 random_;
};

}  // namespace

SimulationBasedCalibration calibrate_by_simulation(const LinearisedModel& linearised,
                                                   EvidenceEvaluator& evaluator,
                                                   const NullDistribution& null,
                                                   const DiagnosisOptions& options) {
  return Simulator(linearised, evaluator, null, options).run();
}

double calibrated(double probability, const SimulationBasedCalibration& simulation) {
  if (simulation.sessions == 0) return probability;
  return 1 / (1 + std::exp(-clamped_logit(probability) / simulation.temperature));
}

}  // namespace selfcal
