#include "diagnosis/search/gears_off.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "diagnosis/constants.h"

namespace selfcal {
namespace {

/// Causes, and ratios of their own size: their columns in A, and 1 sigma.
struct Explanation {
  std::vector<int> causes;
  std::map<Eigen::Index, double> gears;
};

class GearsOff {
 public:
  GearsOff(const Whitened& rows, const HeldGears& held, const EvidenceEvaluator& evaluator,
           const Hypothesis& best)
      : rows_(rows), held_(held), evaluator_(evaluator), best_(best), geometry_(rows.A.cols()) {
    find_products();
  }

  std::map<std::string, double> find() {
    std::map<std::string, double> off;
    Explanation now{best_.candidates, {}};
    double log_now = log_weight(now);
    for (std::size_t i = now.causes.size(); i-- > 0;) {  // one of no weight is no rival
      Explanation fewer = without(now, i);
      const double log_fewer = log_weight(fewer);
      if (log_fewer <= log_now) continue;
      now = std::move(fewer);
      log_now = log_fewer;
    }
    while (now.gears.size() < held_.size()) {
      Explanation next;
      double log_next = -HUGE_VAL;
      for (const auto& [gear, name] : held_) {
        if (now.gears.contains(gear)) continue;
        for (const double sigma : kDiagnosis.gears.off)
          for (Explanation& other : with_gear(now, gear, sigma)) {
            const double log_other = log_weight(other);
            if (log_other > log_now - kDiagnosis.gears.nearly) off.emplace(name, sigma);
            if (log_other <= log_next) continue;
            log_next = log_other;
            next = std::move(other);
          }
      }
      if (log_next <= log_now) break;
      now = std::move(next);
      log_now = log_next;
    }
    for (const auto& [gear, name] : held_)
      if (const auto found = now.gears.find(gear); found != now.gears.end())
        off[name] = found->second;
    return off;
  }

 private:
  static Explanation without(Explanation all, std::size_t cause) {
    all.causes.erase(all.causes.begin() + static_cast<std::ptrdiff_t>(cause));
    return all;
  }

  /// Beside all causes, and in the place of each.
  static std::vector<Explanation> with_gear(const Explanation& now, Eigen::Index gear,
                                            double sigma) {
    std::vector<Explanation> list = {now};
    for (std::size_t i = 0; i < now.causes.size(); ++i) list.push_back(without(now, i));
    for (Explanation& each : list) each.gears[gear] = sigma;
    return list;
  }

  /// Of A, of the causes' columns, and of what the rows say.
  void find_products() {
    std::vector<int> columns;
    for (std::size_t i = 0; i < best_.candidates.size(); ++i) {
      const int cause = best_.candidates[i];
      const Hypothesis alone{{cause}, 0, 0, {best_.sizes[i]}};
      const auto [of_cause, sigma] = MarginalLikelihood::unfold(evaluator_.terms(alone));
      first_[cause] = geometry_ + static_cast<Eigen::Index>(columns.size());
      sigma_[cause] = sigma;
      columns.insert(columns.end(), of_cause.begin(), of_cause.end());
    }
    Eigen::MatrixXd all(rows_.A.rows(), geometry_ + static_cast<Eigen::Index>(columns.size()) + 1);
    all.leftCols(geometry_) = rows_.A;
    all.middleCols(geometry_, static_cast<Eigen::Index>(columns.size())) =
        rows_.C(Eigen::all, columns);
    all.rightCols<1>() = rows_.y;
    products_ = all.transpose() * all;
  }

  /// Log evidence of the rows, whatever their noise, and prior odds; of those that share the
  /// geometry's other priors.
  double log_weight(const Explanation& of) const {
    std::vector<Eigen::Index> columns(static_cast<std::size_t>(geometry_));
    for (Eigen::Index i = 0; i < geometry_; ++i) columns[static_cast<std::size_t>(i)] = i;
    Eigen::VectorXd weight = rows_.weight, pull = rows_.pull;
    double log_priors = 0;
    for (const auto& [gear, sigma] : of.gears) {
      pull[gear] /= weight[gear] * sigma;
      log_priors -= std::log(weight[gear] * sigma);
      weight[gear] = 1 / sigma;
    }
    for (const int cause : of.causes) {
      const Eigen::VectorXd& sigma = sigma_.at(cause);
      for (Eigen::Index i = 0; i < sigma.size(); ++i) columns.push_back(first_.at(cause) + i);
      weight.conservativeResize(weight.size() + sigma.size());
      weight.tail(sigma.size()) = sigma.cwiseInverse();
      log_priors -= sigma.array().log().sum();
    }
    pull.conservativeResize(weight.size());
    pull.tail(weight.size() - geometry_).setZero();
    const Eigen::Index says = products_.cols() - 1;
    Eigen::MatrixXd information = products_(columns, columns);
    information.diagonal() += weight.cwiseAbs2();
    const Eigen::VectorXd side =
        products_(columns, std::vector<Eigen::Index>{says}) + weight.cwiseProduct(pull);
    const Eigen::LDLT<Eigen::MatrixXd> factor(information);
    const double squares =
        products_(says, says) + pull.squaredNorm() - side.dot(factor.solve(side));
    const double odds = static_cast<double>(of.gears.size()) * std::log(kDiagnosis.gears.odds);
    return log_priors - factor.vectorD().array().abs().log().sum() / 2 -
           static_cast<double>(rows_.y.size()) / 2 * std::log(std::max(squares, 1e-300)) + odds +
           evaluator_.log_prior(of.causes, 0);
  }

  const Whitened& rows_;
  const HeldGears& held_;
  const EvidenceEvaluator& evaluator_;
  const Hypothesis& best_;
  Eigen::Index geometry_;                 ///< columns
  std::map<int, Eigen::Index> first_;     ///< column of a cause in products_
  std::map<int, Eigen::VectorXd> sigma_;  ///< of a cause's columns
  Eigen::MatrixXd products_;
};

}  // namespace

std::map<std::string, double> gears_off(const Whitened& rows, const HeldGears& held,
                                        const EvidenceEvaluator& evaluator,
                                        const Hypothesis& best) {
  return GearsOff(rows, held, evaluator, best).find();
}

}  // namespace selfcal
