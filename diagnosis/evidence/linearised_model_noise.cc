// The noise of the rows that a linearised model has, as better explanations tell it, and the rows
// that lie beyond it.
#include <algorithm>
#include <cmath>

#include "constraints/statistics.h"
#include "diagnosis/constants.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/evidence/rows.h"

namespace selfcal {

void LinearisedModel::bound_noise() {
  const std::vector<Scale> declared = declared_noise(data_);
  for (size_t s = 0; s < noise_.size(); ++s) {
    if (declared[s].length > noise_[s].length || declared[s].angle > noise_[s].angle)
      quieter_.push_back(static_cast<int>(s));
    noise_[s] = {std::max(noise_[s].length, declared[s].length),
                 std::max(noise_[s].angle, declared[s].angle)};
  }
  relative_.assign(noise_.size(), {});
}

double LinearisedModel::least() const {
  const std::vector<Scale> least = least_of_sets();
  double sum = 0, rows = 0;
  for (size_t s = 0; s < least.size(); ++s)
    for (const auto& [has, share] :
         {std::pair(data_.sets[s].method->has_lengths(), least[s].length),
          std::pair(data_.sets[s].method->has_angles(), least[s].angle)}) {
      if (!has) continue;
      sum += adjusted_.fitted.rows[s] * share * share;
      rows += adjusted_.fitted.rows[s];
    }
  return rows > 0 ? sum / rows : 0;
}

std::vector<Scale> LinearisedModel::noise_of_sets() const {
  std::vector<Scale> noise = declared_noise(data_);
  for (size_t s = 0; s < noise.size(); ++s)
    noise[s] = {std::max(noise[s].length, scale_ * relative_[s].length * noise_[s].length),
                std::max(noise[s].angle, scale_ * relative_[s].angle * noise_[s].angle)};
  return noise;
}

double LinearisedModel::angles_left() const {
  std::vector<double> angles;
  const DenseEquations rows = kept();
  const Eigen::VectorXd left = this->left();
  for (size_t i = 0; i < rows.row.size(); ++i) {
    if (rows.row[i] < 0 || rows.quantity[i] != Quantity::angle) continue;
    const auto set = static_cast<size_t>(data_.rows.set[rows.row[i]]);
    angles.push_back(std::abs(left[static_cast<Eigen::Index>(i)]) * scale_ * relative_[set].angle *
                     noise_[set].angle);
  }
  return angles.empty() ? 0 : kDiagnosis.rows.median_to_sigma * median(std::move(angles));
}

double LinearisedModel::noise() const {
  double squares = 0;
  int rows = 0;
  for (size_t s = 0; s < noise_.size(); ++s) {
    if (!data_.sets[s].method->has_lengths()) continue;
    squares +=
        adjusted_.fitted.rows[s] * std::pow(scale_ * relative_[s].length * noise_[s].length, 2);
    rows += adjusted_.fitted.rows[s];
  }
  return std::sqrt(squares / std::max(rows, 1));
}

void LinearisedModel::start_with(std::vector<char> outlier) {
  for (size_t row = 0; row < held_.size(); ++row)
    if (!held_[row]) outlier[row] = outlier_[row];
  outlier_ = std::move(outlier);
  left_ = all_.y;
  scale_ = 1;
  relative_.assign(relative_.size(), {});
}

void LinearisedModel::take_back(const std::vector<char>& rows) {
  for (size_t row = 0; row < held_.size(); ++row)
    if (held_[row] && rows[row]) outlier_[row] = 0;
}

bool LinearisedModel::put_aside(const std::vector<char>& rows) {
  bool any = false;
  for (size_t row = 0; row < held_.size(); ++row) {
    if (!held_[row] || !rows[row] || outlier_[row]) continue;
    outlier_[row] = 1;
    any = true;
  }
  return any;
}

std::vector<Scale> LinearisedModel::least_of_sets() const {
  std::vector<Scale> least = declared_noise(data_);
  for (size_t s = 0; s < least.size(); ++s) {
    if (least[s].length > 0) least[s].length /= scale_ * relative_[s].length * noise_[s].length;
    if (least[s].angle > 0) least[s].angle /= scale_ * relative_[s].angle * noise_[s].angle;
  }
  return least;
}

bool LinearisedModel::refine(const Eigen::VectorXd& residuals, double variance) {
  const DenseEquations rows = kept();
  const std::vector<Scale> unlike =
      unlike_noise(data_, rows, residuals(equations_of(all_, taking_part())),
                   geometry_leaves(whitened_geometry()), least_of_sets());
  const bool alike = std::ranges::all_of(
      unlike, [](const Scale& each) { return each.length == 1 && each.angle == 1; });
  Eigen::VectorXd left = residuals;
  for (Eigen::Index i = 0; i < left.size(); ++i)
    if (const int row = all_.row[static_cast<size_t>(i)]; row >= 0)
      left[i] /= unlike[data_.rows.set[row]].of(all_.quantity[static_cast<size_t>(i)]);
  std::vector<char> outlier = outliers_among(
      all_, left, static_cast<double>(nuisance_.columns.size()), outlier_.size(), most_outliers_);
  for (size_t row = 0; row < held_.size(); ++row)
    if (!held_[row]) outlier[row] = outlier_[row];
  if (outlier == outlier_ && alike && std::abs(variance - 1) < 0.1) return false;
  outlier_ = std::move(outlier);
  left_ = std::move(left);
  for (size_t s = 0; s < relative_.size(); ++s) {
    relative_[s].length *= unlike[s].length;
    relative_[s].angle *= unlike[s].angle;
  }
  scale_ *= std::sqrt(variance);
  return true;
}

}  // namespace selfcal
