#include "constraints/equations/column_products.h"

#include <algorithm>
#include <numeric>

#include "kinematics/kernels/kernels.h"

namespace selfcal {
namespace {

constexpr Eigen::Index kBuffered = 64;
static_assert(kBuffered % kernels::kMultiple == 0);

}  // namespace

ColumnProducts::ColumnProducts(int columns)
    : columns_(columns),
      buffer_(Eigen::MatrixXd::Zero(kBuffered, columns)),
      sums_(kernels::padded_columns(static_cast<std::size_t>(columns)) *
                kernels::padded_columns(static_cast<std::size_t>(columns)) * kernels::kMultiple,
            0.0) {}

void ColumnProducts::add(const Eigen::MatrixXd& rows) {
  const auto count = static_cast<std::size_t>(rows.rows());
  kernels::add_column_products(rows.data(), static_cast<std::size_t>(columns_), count, count,
                               sums_.data());
}

void ColumnProducts::push(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  for (Eigen::Index done = 0; done < rows.rows();) {
    const Eigen::Index count = std::min(rows.rows() - done, kBuffered - filled_);
    buffer_.middleRows(filled_, count) = rows.middleRows(done, count);
    filled_ += count;
    done += count;
    if (filled_ < kBuffered) break;
    add(buffer_);
    filled_ = 0;
  }
}

Eigen::MatrixXd ColumnProducts::sum() {
  if (filled_ > 0) {
    buffer_.bottomRows(kBuffered - filled_).setZero();
    add(buffer_);
    filled_ = 0;
  }
  Eigen::MatrixXd H(columns_, columns_);
  const auto padded =
      static_cast<Eigen::Index>(kernels::padded_columns(static_cast<std::size_t>(columns_)));
  for (Eigen::Index j = 0; j < columns_; ++j)
    for (Eigen::Index i = j; i < columns_; ++i) {
      const double* const lanes =
          sums_.data() + (j * padded + i) * static_cast<Eigen::Index>(kernels::kMultiple);
      H(i, j) = H(j, i) = std::accumulate(lanes, lanes + kernels::kMultiple, 0.0);
    }
  return H;
}

}  // namespace selfcal
