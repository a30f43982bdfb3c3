#include "diagnosis/comparison/pair.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/constants.h"
#include "diagnosis/evidence/discrepancy.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/evidence/rows.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/size.h"

namespace selfcal {

FittedSession::FittedSession(const Robot& geometry, DataSet rows, const DiagnosisOptions& options,
                             const Progress& progress)
    : data(std::move(rows)),
      fit(adjust(Equations(geometry, data, Use::fit), geometry_options(options), progress).fitted) {
}

FittedSession parted(FittedSession session, const std::vector<std::string>& sets) {
  std::vector<Set>& all = session.data.sets;
  const auto asked = [&](const Set& set) { return std::ranges::count(sets, set.name) > 0; };
  std::vector<char> apart;
  for (const Set& set : all)
    apart.push_back(asked(set) || (set.reference >= 0 && asked(all[set.reference])));
  for (size_t s = 0; s < all.size(); ++s)
    if (apart[s]) all[s].name += "' of its own";
  return session;
}

Pair::Pair(std::shared_ptr<const Robot> geometry, const FittedSession& before,
           const FittedSession& after, Between between, const DiagnosisOptions& options,
           const Progress& progress)
    : geometry_(std::move(geometry)),
      most_outliers_(options.most_outliers),
      first_rows_(before.data.rows.rows()),
      both_(merged(before.data, after.data)),
      equations_(*geometry_, both_, Use::fit) {
  const Options free = geometry_options(options);
  noise_.assign(both_.sets.size(), {0, 0});
  rows_.assign(both_.sets.size(), 0);
  add_noise_of(before);
  add_noise_of(after);
  for (size_t s = 0; s < rows_.size(); ++s)
    noise_[s] = rows_[s] > 0 ? Scale{std::sqrt(noise_[s].length / rows_[s]),
                                     std::sqrt(noise_[s].angle / rows_[s])}
                             : Scale{};
  adjusted_ = adjust(equations_, free, progress);
  every_ = equations_.dense(adjusted_.fitted.state, noise_, std::vector<char>(outlier_.size(), 0));
  changes_ = changeable(equations_, every_.W, before.data, after.data, between);
}

/// Adds the squares of its noise to those of both's sets.
void Pair::add_noise_of(const FittedSession& part) {
  const Fit& fit = part.fit;
  const std::vector<Scale> noise = pooled_noise(part.data, fit);
  const auto first = static_cast<int>(outlier_.size());
  outlier_.insert(outlier_.end(), fit.noise.outlier.begin(), fit.noise.outlier.end());
  std::vector<int> set_of(part.data.sets.size(), -1);  // among both's
  for (int row = 0; row < part.data.rows.rows(); ++row)
    set_of[part.data.rows.set[row]] = both_.rows.set[first + row];
  for (size_t of = 0; of < fit.rows.size(); ++of) {
    if (fit.rows[of] == 0) continue;
    const auto s = static_cast<size_t>(set_of[of]);
    noise_[s].length += fit.rows[of] * std::pow(noise[of].length, 2);
    noise_[s].angle += fit.rows[of] * std::pow(noise[of].angle, 2);
    rows_[s] += fit.rows[of];
  }
}

DenseEquations Pair::weighed(const std::vector<char>& outlier) const {
  std::vector<int> first, second;
  for (int row = 0; row < both_.rows.rows(); ++row)
    (row < first_rows_ ? first : second).push_back(row);
  const auto later = [&](int row) { return row >= first_rows_; };
  const auto more = static_cast<double>(std::ranges::count_if(every_.row, later));
  const double fewer = static_cast<double>(every_.row.size()) - more;
  const auto part = [](double others) {
    return kDiagnosis.rows.most_weighed - std::min(others, kDiagnosis.rows.most_weighed / 2);
  };
  std::vector<char> take = weighed_rows(taken(both_.rows, first), fewer, part(more));
  const std::vector<char> rest = weighed_rows(taken(both_.rows, second), more, part(fewer));
  take.insert(take.end(), rest.begin(), rest.end());
  for (size_t row = 0; row < take.size(); ++row) take[row] = take[row] && !outlier[row];
  return kept(every_, take);
}

Whitened Pair::whitened(const DenseEquations& rows) const {
  Nuisance priors = nuisance(adjusted_, equations_.robot_columns(), rows.W.cols());
  Whitened out;
  out.A = rows.W(Eigen::all, priors.columns);
  out.C = rows.W(Eigen::all, changes_.columns);
  for (Eigen::Index i = 0; i < out.C.rows(); ++i)
    if (rows.row[static_cast<size_t>(i)] < first_rows_) out.C.row(i).setZero();
  out.y = rows.y;
  out.weight = std::move(priors.weight);
  out.pull = std::move(priors.pull);
  return out;
}

EvidenceEvaluator Pair::evaluator(const DenseEquations& rows, SearchRule rule) const {
  rule.extended_further = 0;  // what changed at three joints need not have changed at others
  const Eigen::MatrixXd by_joint = rows.W(Eigen::all, reading_columns(*geometry_));
  return EvidenceEvaluator(
      whitened(rows),
      structures(both_.rows, rows, ends(*geometry_, both_.rows), size_of(*geometry_),
                 {.readings = {by_joint, credible_steps(both_.rows.q, by_joint)},
                  .alike = comparable_readings(*geometry_, both_.rows.q)}),
      changes_.candidates, changes_.parameters, rule);
}

std::vector<char> Pair::outliers_among(const DenseEquations& rows,
                                       const Hypothesis& changes) const {
  std::vector<int> with;
  for (const int c : changes.candidates)
    for (const int k : changes_.candidates.list[static_cast<size_t>(c)].main) with.push_back(k);
  const auto free = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(with.size()), HUGE_VAL);
  const Whitened some = whitened(rows);
  const Eigen::VectorXd left = left_of(whitened(every_), some, with, free);
  return selfcal::outliers_among(every_, left, static_cast<double>(some.A.cols() + free.size()),
                                 outlier_.size(), most_outliers_);
}

}  // namespace selfcal
