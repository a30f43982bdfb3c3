// The kernels against the standard library and Eigen, on every width that this machine has.
#include "kinematics/kernels/kernels.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace selfcal {
namespace {

Eigen::MatrixXd random_numbers(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

/// Runs `check` with each width by itself, then leaves the choice to Highway again.
void on_every_width(const std::function<void()>& check) {
  const auto supported = hwy::SupportedTargets();
  int widths = 0;
  for (auto left = supported; left != 0; left &= left - 1) {
    const auto one = left & ~(left - 1);
    hwy::SetSupportedTargetsForTest(static_cast<decltype(hwy::SupportedTargets())>(one));
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    SCOPED_TRACE(hwy::TargetName(static_cast<decltype(hwy::SupportedTargets())>(one)));
    check();
    ++widths;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  EXPECT_GT(widths, 0);
}

TEST(Kernels, HaveTheSinesAndCosinesOfTheStandardLibrary) {
  on_every_width([] {
    Eigen::ArrayXd angle = 7 * random_numbers(4096, 1, 1).array();
    angle.head<8>() << 0, M_PI, -M_PI, M_PI / 2, 1e-300, -1e-9, 2.9e4, -2.9e4;
    Eigen::ArrayXd sine(angle.size()), cosine(angle.size());
    kernels::sine_cosine(angle.data(), 4096, sine.data(), cosine.data());
    const double last_place = std::numeric_limits<double>::epsilon();
    EXPECT_LE((sine - angle.sin()).abs().maxCoeff(), 2 * last_place);
    EXPECT_LE((cosine - angle.cos()).abs().maxCoeff(), 2 * last_place);
  });
}

TEST(Kernels, HaveTheSineOfAnAngleOfManyTurns) {
  Eigen::ArrayXd angle = Eigen::ArrayXd::Constant(8, 1e9), sine(8), cosine(8);
  kernels::sine_cosine(angle.data(), 8, sine.data(), cosine.data());
  EXPECT_EQ(sine[3], std::sin(1e9));
  EXPECT_EQ(cosine[3], std::cos(1e9));
}

TEST(Kernels, AddProductsLaneByLane) {
  on_every_width([] {
    const Eigen::ArrayXXd factors = random_numbers(32, 2, 2), columns = random_numbers(64, 5, 3);
    const Eigen::ArrayXXd before = random_numbers(96, 5, 4);
    Eigen::ArrayXXd out = before;
    const kernels::LaneProduct products[] = {{&factors(0, 0), &columns(0, 0)},
                                             {&factors(0, 1), &columns(32, 0)}};
    kernels::add_products(products, 2, 32, 5, 64, &out(32, 0), 96);
    for (int k = 0; k < 5; ++k)
      for (int lane = 0; lane < 96; ++lane) {
        double sum = before(lane, k);
        if (lane >= 32 && lane < 64)
          sum += factors(lane - 32, 0) * columns(lane - 32, k) +
                 factors(lane - 32, 1) * columns(lane, k);
        EXPECT_NEAR(out(lane, k), sum, 1e-14);
      }
  });
}

TEST(Kernels, AppendRowsAsAHouseholderDecompositionOfAllDoes) {
  on_every_width([] {
    for (const Eigen::Index columns : {1, 3, 7, 46}) {
      const Eigen::MatrixXd first = random_numbers(64, columns, 5);
      const Eigen::MatrixXd second = random_numbers(16, columns, 6);
      Eigen::MatrixXd R = Eigen::MatrixXd::Zero(columns, columns), A = first, B(24, columns);
      B << second, Eigen::MatrixXd::Zero(8, columns);
      const auto n = static_cast<size_t>(columns);
      kernels::append_rows(R.data(), n, A.data(), 64, 64);
      kernels::append_rows(R.data(), n, B.data(), 16, 24);
      Eigen::MatrixXd all(80, columns);
      all << first, second;
      const Eigen::MatrixXd expected = Eigen::HouseholderQR<Eigen::MatrixXd>(all)
                                           .matrixQR()
                                           .topRows(columns)
                                           .triangularView<Eigen::Upper>();
      EXPECT_TRUE(R.isUpperTriangular(0));
      EXPECT_LT((R.cwiseAbs() - expected.cwiseAbs()).cwiseAbs().maxCoeff(), 1e-12) << columns;
    }
  });
}

TEST(Kernels, StayFiniteWhereColumnsDependOnEachOther) {
  on_every_width([] {
    // Each elimination leaves a rounding of the one before: 24 of them end below the normal
    // numbers.
    const Eigen::Index columns = 24;
    Eigen::MatrixXd R = Eigen::MatrixXd::Zero(columns, columns);
    Eigen::MatrixXd A = random_numbers(64, 1, 7).replicate(1, columns);
    for (Eigen::Index c = 1; c < columns; ++c) A.col(c) *= 1 / (3.0 + static_cast<double>(c));
    for (int block = 0; block < 20; ++block) {
      Eigen::MatrixXd rows = A * (1 + 0.1 * block);
      kernels::append_rows(R.data(), 24, rows.data(), 64, 64);
      ASSERT_TRUE(R.allFinite()) << block;
    }
    for (const double tiny : {1e-150, 1e-158, 1e-161, 1e-163, 1e-300}) {
      Eigen::MatrixXd small = tiny * random_numbers(64, 3, 8), factor = Eigen::MatrixXd::Zero(3, 3);
      kernels::append_rows(factor.data(), 3, small.data(), 64, 64);
      EXPECT_TRUE(factor.allFinite()) << tiny;
    }
  });
}

TEST(Kernels, LeaveTheFactorAsItIsWhereThereAreNoRows) {
  Eigen::MatrixXd R = Eigen::MatrixXd::Identity(3, 3), A = Eigen::MatrixXd::Zero(8, 3);
  kernels::append_rows(R.data(), 3, A.data(), 8, 8);
  EXPECT_EQ(R, (Eigen::MatrixXd::Identity(3, 3)));
}

}  // namespace
}  // namespace selfcal
