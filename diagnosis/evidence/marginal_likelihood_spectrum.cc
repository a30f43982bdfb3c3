// One block at many sizes: with D G D = U diag(value) U' its evidence at each size is a sum.
#include <algorithm>
#include <array>
#include <cmath>

#include "diagnosis/constants.h"
#include "diagnosis/evidence/marginal_likelihood.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr double kAlikeColumns = 1e-8;  ///< of two columns' square: they are nearly one

}  // namespace

void MarginalLikelihood::add_spectrum(const Block& block, std::span<const double> sizes,
                                      std::vector<double>& to) const {
  const auto n = static_cast<Eigen::Index>(block.columns.size());
  Eigen::MatrixXd scaled(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      scaled(i, j) = scaled(j, i) = block.unit[i] * block.unit[j] * product(block.group, i, j);
  const Symmetric eigen =
      n == 1 ? Symmetric{scaled.col(0), Eigen::MatrixXd::Identity(1, 1)} : symmetric_eigen(scaled);
  const Eigen::ArrayXd value = eigen.values.array().max(0);
  for (const double size : sizes) to.push_back((size * size * value).log1p().sum() / 2);
  to.insert(to.end(), value.begin(), value.end());
  const auto vectors = eigen.vectors.reshaped();
  to.insert(to.end(), vectors.begin(), vectors.end());
}

std::size_t MarginalLikelihood::spectrum_size(const Block& block, std::size_t sizes) {
  const std::size_t n = block.columns.size();
  return sizes + n + n * n;
}

void MarginalLikelihood::log_evidences(const Block& block, std::span<const double> sizes,
                                       const double* spectrum, double* logs) const {
  const std::size_t n = block.columns.size();
  const double* const value = spectrum + sizes.size();
  const double* const U = value + n;
  std::array<double, kMostLooped> turned;  // U'D g
  std::fill_n(turned.begin(), n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double each = block.unit[static_cast<Eigen::Index>(i)] * g_[block.columns[i]];
    for (std::size_t k = 0; k < n; ++k) turned[k] += U[k * n + i] * each;
  }
  for (std::size_t s = 0; s < sizes.size(); ++s) {
    const double squared = sizes[s] * sizes[s];
    double explained = 0;
    for (std::size_t k = 0; k < n; ++k)
      explained += squared * turned[k] * turned[k] / (1 + squared * value[k]);
    const double left = yy_ - explained;
    logs[s] = constant_ - spectrum[s] + of_noise(left, nu_);
    for (const int i : block.positive) {
      double mean = 0, square = 0;  // of the parameter, and its variance over s^2
      for (std::size_t k = 0; k < n; ++k) {
        const double of = U[k * n + static_cast<std::size_t>(i)];
        mean += sizes[s] * of * turned[k] / (1 + squared * value[k]);
        square += of * of / (1 + squared * value[k]);
      }
      logs[s] += of_sign(mean / std::sqrt(square * variance(left)));
    }
  }
}

double MarginalLikelihood::at_most(const Block& block) const {
  if (block.columns.size() > 2 || block.group < 0) return INFINITY;
  const double a = g_[block.columns.front()], b = g_[block.columns.back()];
  const double aa = product(block.group, 0, 0);
  double explained = a * a / aa;
  if (block.columns.size() == 2) {
    const double ab = product(block.group, 1, 0), bb = product(block.group, 1, 1);
    const double volume = aa * bb - ab * ab;
    if (!(volume > kAlikeColumns * aa * bb)) return INFINITY;
    explained = (a * a * bb - 2 * a * b * ab + b * b * aa) / volume;
  }
  if (!(explained >= 0)) return INFINITY;
  return constant_ + of_noise(yy_ - explained, nu_) +
         static_cast<double>(block.positive.size()) * std::log(2 * kDiagnosis.evidence.right_sign);
}

}  // namespace selfcal
