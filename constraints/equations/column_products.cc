#include "constraints/equations/column_products.h"

#include <algorithm>
#include <numeric>

#include "kinematics/kernels/kernels.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr Eigen::Index kBuffered = 64;
static_assert(kBuffered % kernels::kMultiple == 0);
constexpr Eigen::Index kBufferedWide = 512;
constexpr int kWide = 128;  ///< columns from which a library's product is the faster one

}  // namespace

ColumnProducts::ColumnProducts(int columns)
    : columns_(columns),
      buffer_(Eigen::MatrixXd::Zero(columns < kWide ? kBuffered : kBufferedWide, columns)) {
  const std::size_t padded = kernels::padded_columns(static_cast<std::size_t>(columns));
  if (columns < kWide)
    sums_.assign(padded * padded * kernels::kMultiple, 0.0);
  else
    square_.setZero(columns, columns);
}

void ColumnProducts::add(const Eigen::MatrixXd& rows) {
  if (wide()) return add_square(rows, square_);
  const auto count = static_cast<std::size_t>(rows.rows());
  kernels::add_column_products(rows.data(), static_cast<std::size_t>(columns_), count, count,
                               sums_.data());
}

void ColumnProducts::push(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  for (Eigen::Index done = 0; done < rows.rows();) {
    const Eigen::Index count = std::min(rows.rows() - done, buffer_.rows() - filled_);
    buffer_.middleRows(filled_, count) = rows.middleRows(done, count);
    filled_ += count;
    done += count;
    if (filled_ < buffer_.rows()) break;
    add(buffer_);
    filled_ = 0;
  }
}

Eigen::MatrixXd ColumnProducts::sum() {
  if (filled_ > 0) {
    buffer_.bottomRows(buffer_.rows() - filled_).setZero();
    add(buffer_);
    filled_ = 0;
  }
  if (wide()) return square_.selfadjointView<Eigen::Lower>();
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
