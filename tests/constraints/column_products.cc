// Products of all columns, few of them and many, against Eigen's own.
#include "constraints/equations/column_products.h"

#include <gtest/gtest.h>

namespace selfcal {
namespace {

TEST(ColumnProducts, AreThoseOfAllRowsHoweverTheyCome) {
  for (const int columns : {1, 9, 127, 128, 203}) {
    SCOPED_TRACE(columns);
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(1337, columns);
    ColumnProducts products(columns);
    products.add(A.topRows(96));
    products.push(A.middleRows(96, 3));
    products.push(A.bottomRows(1337 - 99));
    const Eigen::MatrixXd H = products.sum();
    EXPECT_LT((H - A.transpose() * A).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_EQ(H, H.transpose());
  }
}

}  // namespace
}  // namespace selfcal
