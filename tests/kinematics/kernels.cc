// The kernels against the standard library and Eigen, on every width that this machine has.
#include "kinematics/kernels/kernels.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

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

TEST(Kernels, HaveTheSinesOfCountsThatFillNoRegister) {
  on_every_width([] {
    const Eigen::ArrayXd angle = random_numbers(13, 1, 11).array();
    Eigen::ArrayXd sine(13), cosine(13);
    kernels::sine_cosine(angle.data(), 13, sine.data(), cosine.data());
    EXPECT_LE((sine - angle.sin()).abs().maxCoeff(), 5e-16);
    EXPECT_LE((cosine - angle.cos()).abs().maxCoeff(), 5e-16);
  });
}

/// Rot(y, beta) Rot(x, alpha) Trans(x, d) Rot(z, theta) Trans(z, r).
Eigen::Isometry3d step_of(double beta, double alpha, double d, double theta, double r) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.rotate(Eigen::AngleAxisd(beta, Eigen::Vector3d::UnitY()));
  T.rotate(Eigen::AngleAxisd(alpha, Eigen::Vector3d::UnitX()));
  T.translate(Eigen::Vector3d(d, 0, 0));
  T.rotate(Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitZ()));
  T.translate(Eigen::Vector3d(0, 0, r));
  return T;
}

TEST(Kernels, FollowAChainWithItsDerivativesInEveryLane) {
  // Two frames that turn and slide and a whole pose between them, as a product of their poses; of
  // each parameter the differences of step 1e-6, of rounding 2e-10 and cut off 1e-12.
  static constexpr size_t kLanesHere = 16, kColumns = 16;
  using Numbers = Eigen::Matrix<double, 5, 1>;  // alpha d theta r beta
  on_every_width([] {
    const Eigen::MatrixXd numbers = random_numbers(5, 2, 12), turns = random_numbers(16, 2, 13);
    const Eigen::ArrayXd slide = random_numbers(16, 1, 14).array();
    const Eigen::Vector3d shift = random_numbers(3, 1, 15);
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const auto put = [&](size_t lane, const Numbers& a, const Eigen::Vector3d& p,
                         const Eigen::Vector3d& turn, const Numbers& b) {
      const auto at = static_cast<Eigen::Index>(lane);
      Eigen::Isometry3d whole = Eigen::Isometry3d::Identity();
      whole.translation() = p;
      whole.linear() =
          Eigen::AngleAxisd(turn.norm(), turn.norm() > 0 ? Eigen::Vector3d(turn.normalized())
                                                         : Eigen::Vector3d::UnitX()) *
          R;
      return step_of(a[4], a[0], a[1], a[2] + turns(at, 0), a[3]) * whole *
             step_of(b[4], b[0], b[1], b[2] + turns(at, 1), b[3] + slide[at]);
    };
    for (const size_t lanes : {size_t{1}, kLanesHere}) {
      std::array<kernels::ChainFrame, 3> frames;
      Eigen::ArrayXXd sine(kLanesHere, 2), cosine(kLanesHere, 2);
      for (size_t k = 0; k < 2; ++k) {
        const Numbers v = numbers.col(static_cast<Eigen::Index>(k));
        kernels::ChainFrame& f = frames[2 * k];
        f.column = 11 * k;
        f.cos_alpha = std::cos(v[0]), f.sin_alpha = std::sin(v[0]);
        f.cos_beta = std::cos(v[4]), f.sin_beta = std::sin(v[4]);
        f.d = v[1], f.r = v[3];
        const Eigen::ArrayXd theta = v[2] + turns.col(static_cast<Eigen::Index>(k)).array();
        sine.col(static_cast<Eigen::Index>(k)) = theta.sin();
        cosine.col(static_cast<Eigen::Index>(k)) = theta.cos();
        f.lanes_turn = true;
        f.sine = sine.col(static_cast<Eigen::Index>(k)).data();
        f.cosine = cosine.col(static_cast<Eigen::Index>(k)).data();
      }
      frames[2].slide = slide.data();
      frames[1].whole = true;
      frames[1].column = 5;
      Eigen::Map<Eigen::Vector3d>(frames[1].pose) = shift;
      Eigen::Map<Eigen::Matrix3d>(frames[1].pose + 3) = R;
      Eigen::Map<Eigen::Matrix3d>(frames[1].pose + 12) = Eigen::Matrix3d::Identity();
      const auto rows = static_cast<Eigen::Index>(lanes);
      Eigen::ArrayXXd rotation(rows, 9), position(rows, 3), psi(6 * rows, kColumns);
      kernels::follow_chain(frames.data(), 3, lanes, rotation.data(), position.data(), psi.data());
      for (size_t lane = 0; lane < lanes; ++lane) {
        const auto at = static_cast<Eigen::Index>(lane);
        const auto location = [&](int column, double h) {
          Numbers a = numbers.col(0), b = numbers.col(1);
          Eigen::Vector3d p = shift, turn = Eigen::Vector3d::Zero();
          if (column < 5) a[column] += h;
          if (column >= 5 && column < 8) p[column - 5] += h;
          if (column >= 8 && column < 11) turn[column - 8] += h;
          if (column >= 11) b[column - 11] += h;
          return put(lane, a, p, turn, b);
        };
        const Eigen::Isometry3d T = location(0, 0);
        EXPECT_LT((position.row(at).matrix().transpose() - T.translation()).norm(), 1e-14);
        EXPECT_LT((rotation.row(at).matrix().transpose() - T.linear().reshaped()).norm(), 1e-14);
        for (int column = 0; column < static_cast<int>(kColumns); ++column) {
          constexpr double h = 1e-6;
          const Eigen::Isometry3d plus = location(column, h), minus = location(column, -h);
          const Eigen::AngleAxisd turn(plus.linear() * minus.linear().transpose());
          Eigen::Matrix<double, 6, 1> expected;
          expected << (plus.translation() - minus.translation()) / (2 * h),
              turn.angle() * turn.axis() / (2 * h);
          for (int c = 0; c < 6; ++c)
            EXPECT_NEAR(psi(c * rows + at, column), expected[c], 1e-8) << column << " " << c;
        }
      }
      kernels::follow_chain(frames.data(), 3, lanes, rotation.data(), position.data(), nullptr);
      EXPECT_TRUE(rotation.isFinite().all());
    }
  });
}

TEST(Kernels, AddTheProductsOfColumns) {
  on_every_width([] {
    for (const Eigen::Index columns : {1, 2, 5, 8, 47}) {
      const Eigen::MatrixXd A = random_numbers(96, columns, 16);
      const auto n = static_cast<size_t>(columns), padded = kernels::padded_columns(n);
      std::vector<double> sums(padded * padded * kernels::kMultiple, 0.0);
      for (int pass = 0; pass < 2; ++pass)
        kernels::add_column_products(A.data(), n, 96, 96, sums.data());
      for (Eigen::Index i = 0; i < columns; ++i)
        for (Eigen::Index j = 0; j <= i; ++j) {
          const double* const from =
              sums.data() +
              (static_cast<size_t>(j) * padded + static_cast<size_t>(i)) * kernels::kMultiple;
          EXPECT_NEAR(std::accumulate(from, from + kernels::kMultiple, 0.0),
                      2 * A.col(i).dot(A.col(j)), 1e-12);
        }
    }
  });
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
