// R of rows in pieces against the rows themselves.
#include "constraints/equations/streaming_qr.h"

#include <gtest/gtest.h>

#include <random>

namespace selfcal {
namespace {

constexpr int kColumns = 7;

Eigen::MatrixXd random_rows(int rows, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, kColumns, [&] { return normal(random); });
}

/// R^T R against W^T W: rounding of sums of 1000 squares, relative to their size.
void expect_factor_of(const Eigen::MatrixXd& R, const Eigen::MatrixXd& W) {
  ASSERT_EQ(R.rows(), kColumns);
  ASSERT_EQ(R.cols(), kColumns);
  EXPECT_TRUE(R.isUpperTriangular(0));
  const Eigen::MatrixXd product = W.transpose() * W;
  EXPECT_LT((R.transpose() * R - product).norm(), 1e-13 * (product.norm() + 1));
}

TEST(StreamingQr, OfAThousandRowsInOddPiecesHasTheirProduct) {
  const Eigen::MatrixXd W = random_rows(1000, 1);
  StreamingQr qr(kColumns);
  Eigen::Index at = 0;
  for (Eigen::Index piece = 1; at < W.rows(); piece = piece * 3 % 101) {
    const Eigen::Index count = std::min(piece, W.rows() - at);
    qr.push(W.middleRows(at, count));
    at += count;
  }
  expect_factor_of(qr.R(), W);
}

TEST(StreamingQr, GivesRowsAsTheyCameOnlyWhereTheyAreNoMoreThanColumns) {
  for (const int count : {0, 5, kColumns, kColumns + 1, 1000}) {
    const Eigen::MatrixXd W = random_rows(count, 4);
    StreamingQr qr(kColumns);
    qr.push(W);
    const Eigen::MatrixXd rows = qr.rows();
    if (count <= kColumns)
      EXPECT_EQ(rows, W);
    else
      expect_factor_of(rows, W);
  }
}

TEST(StreamingQr, OfFewerRowsThanColumnsHasTheirProduct) {
  const Eigen::MatrixXd W = random_rows(3, 2);
  StreamingQr qr(kColumns);
  qr.push(W.topRows(1));
  qr.push(W.bottomRows(2));
  expect_factor_of(qr.R(), W);
}

TEST(StreamingQr, GoesOnAfterItWasAsked) {
  const Eigen::MatrixXd W = random_rows(300, 3);
  StreamingQr qr(kColumns);
  for (const Eigen::Index at : {0, 100, 200}) {
    qr.push(W.middleRows(at, 100));
    expect_factor_of(qr.R(), W.topRows(at + 100));
    expect_factor_of(qr.R(), W.topRows(at + 100));
  }
}

TEST(StreamingQr, OfNothingIsZero) {
  StreamingQr qr(kColumns);
  qr.push(Eigen::MatrixXd(0, kColumns));
  EXPECT_TRUE(qr.R().isZero(0));
}

}  // namespace
}  // namespace selfcal
