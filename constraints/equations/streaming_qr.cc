// Householder QR of [R; new rows] whenever the buffer is full (Golub and Van Loan, 5.2 and 6.5).
#include "constraints/equations/streaming_qr.h"

#include <algorithm>

#include "kinematics/kernels/kernels.h"

namespace selfcal {
namespace {

/// Rows of the buffer: as many as stay in the first cache, a multiple of what kernels ask for.
Eigen::Index buffered(int columns) {
  constexpr Eigen::Index kNumbers = 4096, kFewest = 32, kMost = 256;  // 32 kB of doubles
  constexpr auto kStep = static_cast<Eigen::Index>(kernels::kMultiple);
  return std::clamp(kNumbers / std::max(columns, 1) / kStep * kStep, kFewest, kMost);
}

}  // namespace

StreamingQr::StreamingQr(int columns)
    : R_(Eigen::MatrixXd::Zero(columns, columns)), buffer_(buffered(columns), columns) {}

void StreamingQr::push(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  for (Eigen::Index done = 0; done < rows.rows();) {
    if (filled_ == buffer_.rows()) reduce();
    const Eigen::Index count = std::min(rows.rows() - done, buffer_.rows() - filled_);
    buffer_.middleRows(filled_, count) = rows.middleRows(done, count);
    filled_ += count;
    done += count;
  }
}

const Eigen::MatrixXd& StreamingQr::R() {
  reduce();
  return R_;
}

Eigen::MatrixXd StreamingQr::rows() {
  if (!reduced_ && filled_ <= R_.cols()) return buffer_.topRows(filled_);
  return R();
}

void StreamingQr::reduce() {
  constexpr auto kStep = static_cast<Eigen::Index>(kernels::kMultiple);
  const Eigen::Index rows = (filled_ + kStep - 1) / kStep * kStep;
  buffer_.middleRows(filled_, rows - filled_).setZero();
  kernels::append_rows(R_.data(), static_cast<size_t>(R_.cols()), buffer_.data(),
                       static_cast<size_t>(rows), static_cast<size_t>(buffer_.rows()));
  filled_ = 0;
  reduced_ = true;
}

}  // namespace selfcal
