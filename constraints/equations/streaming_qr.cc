// Householder QR of [R; new rows] whenever the buffer is full (Golub and Van Loan, 5.2 and 6.5).
#include "constraints/equations/streaming_qr.h"

#include "kinematics/linear_algebra.h"

namespace selfcal {

StreamingQr::StreamingQr(int columns) : columns_(columns), buffer_(5 * columns, columns) {}

void StreamingQr::push(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  for (Eigen::Index done = 0; done < rows.rows();) {
    if (filled_ == buffer_.rows()) reduce();
    const Eigen::Index count = std::min(rows.rows() - done, buffer_.rows() - filled_);
    buffer_.middleRows(filled_, count) = rows.middleRows(done, count);
    filled_ += count;
    done += count;
  }
}

Eigen::MatrixXd StreamingQr::R() {
  reduce();
  return buffer_.topRows(columns_);
}

void StreamingQr::reduce() {
  if (filled_ < columns_) {
    buffer_.middleRows(filled_, columns_ - filled_).setZero();
    filled_ = columns_;
  }
  triangularise(buffer_.topRows(filled_));
  filled_ = columns_;
}

}  // namespace selfcal
