#include "diagnosis/search/gears_off.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "diagnosis/constants.h"

namespace selfcal {
namespace {

/// Causes and ratios (by their place among the held ones, with 1 sigma over what they are held to)
/// in one noise.
struct Explanation {
  std::vector<int> causes;
  std::map<std::size_t, double> gears;
  int structure = 0;
};

class GearsOff {
 public:
  GearsOff(const std::vector<HeldGear>& held, const EvidenceEvaluator& evaluator,
           const Posterior& posterior)
      : held_(held), evaluator_(evaluator), best_(posterior.hypotheses.front()) {
    const auto alone = std::ranges::find_if(posterior.hypotheses, [&](const Hypothesis& h) {
      return evaluator.structure(h.structure).kind == 0;
    });
    noise_ = alone != posterior.hypotheses.end() ? alone->structure : best_.structure;
    auto rows = std::make_shared<Whitened>(evaluator.rows().rows());
    const Eigen::Index causes = rows->C.cols();
    rows->C.conservativeResize(Eigen::NoChange, causes + static_cast<Eigen::Index>(held.size()));
    for (std::size_t i = 0; i < held.size(); ++i) {
      const Eigen::Index column = causes + static_cast<Eigen::Index>(i);
      rows->C.col(column) = rows->A.col(held[i].column);
      exact_.push_back(1 / rows->weight[held[i].column]);
      gears_.push_back({.columns = {static_cast<int>(column)}, .unit = Eigen::VectorXd::Ones(1)});
    }
    for (const int cause : best_.candidates) {
      blocks_.push_back(evaluator.block(cause));
      blocks_.back().group = -1;
    }
    for (const std::vector<Block>* list : {&blocks_, &gears_})
      for (const Block& block : *list) {
        first_.push_back(static_cast<Eigen::Index>(columns_.size()));
        columns_.insert(columns_.end(), block.columns.begin(), block.columns.end());
      }
    for (const int structure : {best_.structure, noise_})
      if (!seen_.contains(structure)) {
        MarginalLikelihood seen(rows, evaluator.structure(structure), {});
        Eigen::MatrixXd products = seen.gram(columns_);
        seen_.emplace(structure, std::pair(std::move(seen), std::move(products)));
      }
  }

  std::map<std::string, double> find() const {
    Explanation now{best_.candidates, {}, best_.structure};
    double log_now = log_weight(now);
    for (std::size_t i = now.causes.size(); i-- > 0;)  // one of no weight is no rival
      take_if_better(without_cause(now, i), now, log_now);
    for (bool grows = true; grows;) {
      grows = false;
      Explanation next = now;
      double log_next = log_now;
      for (const Explanation& other : with_another_gear(now))
        grows = take_if_better(other, next, log_next) || grows;
      now = std::move(next);
      log_now = log_next;
    }
    for (std::size_t gear = 0; gear < held_.size(); ++gear) {
      Explanation fewer = now;
      if (fewer.gears.erase(gear) > 0) take_if_better(fewer, now, log_now);
    }
    std::map<std::string, double> off;
    for (const auto& [gear, sigma] : now.gears) off[held_[gear].name] = sigma;
    std::map<std::size_t, double> nearly;  // log weight of the best
    for (const Explanation& other : with_another_gear(now)) {
      const double log_other = log_weight(other);
      if (log_other <= log_now - kDiagnosis.gears.nearly) continue;
      for (const auto& [gear, sigma] : other.gears) {
        if (now.gears.contains(gear)) continue;
        const auto [best, first] = nearly.try_emplace(gear, log_other);
        if (first || log_other > best->second) off[held_[gear].name] = sigma;
        best->second = std::max(best->second, log_other);
      }
    }
    return off;
  }

 private:
  static Explanation without_cause(Explanation all, std::size_t cause) {
    all.causes.erase(all.causes.begin() + static_cast<std::ptrdiff_t>(cause));
    return all;
  }

  bool take_if_better(const Explanation& other, Explanation& best, double& log_best) const {
    const double log_other = log_weight(other);
    if (!(log_other > log_best)) return false;
    best = other;
    log_best = log_other;
    return true;
  }

  /// One more ratio: beside all, in the place of a cause, or of structure.
  std::vector<Explanation> with_another_gear(const Explanation& now) const {
    std::vector<Explanation> fewer = {now}, list;
    for (std::size_t i = 0; i < now.causes.size(); ++i) fewer.push_back(without_cause(now, i));
    if (now.structure != noise_) {
      fewer.push_back(now);
      fewer.back().structure = noise_;
    }
    for (std::size_t gear = 0; gear < held_.size(); ++gear)
      for (const double off : kDiagnosis.gears.off)
        for (const Explanation& each : fewer) {
          if (now.gears.contains(gear)) continue;
          list.push_back(each);
          list.back().gears[gear] = off * std::abs(held_[gear].nominal);
        }
    return list;
  }

  /// Log evidence times prior.
  double log_weight(const Explanation& of) const {
    std::vector<MarginalLikelihood::Term> terms;
    std::vector<Eigen::Index> columns;
    const auto add = [&](const Block& block, std::size_t place, double size) {
      terms.push_back({&block, size});
      for (std::size_t i = 0; i < block.columns.size(); ++i)
        columns.push_back(first_[place] + static_cast<Eigen::Index>(i));
    };
    for (std::size_t i = 0; i < best_.candidates.size(); ++i)
      if (std::ranges::count(of.causes, best_.candidates[i]) > 0)
        add(blocks_[i], i, best_.sizes[i]);
    for (const auto& [gear, sigma] : of.gears) {
      const double beyond = sigma * sigma - exact_[gear] * exact_[gear];
      add(gears_[gear], blocks_.size() + gear, std::sqrt(std::max(beyond, 0.0)));
    }
    const auto& [seen, products] = seen_.at(of.structure);
    return seen.log_evidence(terms, products(columns, columns)) +
           evaluator_.log_prior(of.causes, of.structure) +
           static_cast<double>(of.gears.size()) * std::log(kDiagnosis.gears.odds);
  }

  const std::vector<HeldGear>& held_;
  const EvidenceEvaluator& evaluator_;
  const Hypothesis& best_;
  int noise_ = 0;              ///< the structure of noise alone
  std::vector<double> exact_;  ///< 1 sigma of each ratio as it is held
  std::vector<Block> blocks_,
      gears_;                        ///< of the best causes; of the ratios, at a size of their own
  std::vector<int> columns_;         ///< of all of them
  std::vector<Eigen::Index> first_;  ///< of each among columns_
  /// By structure: the rows in it, and the products of columns_.
  std::map<int, std::pair<MarginalLikelihood, Eigen::MatrixXd>> seen_;
};

}  // namespace

std::map<std::string, double> gears_off(const std::vector<HeldGear>& held,
                                        const EvidenceEvaluator& evaluator,
                                        const Posterior& posterior) {
  if (held.empty() || posterior.hypotheses.empty()) return {};
  return GearsOff(held, evaluator, posterior).find();
}

}  // namespace selfcal
