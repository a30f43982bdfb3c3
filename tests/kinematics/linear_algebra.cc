// Decompositions against their definitions.
#include "kinematics/linear_algebra.h"

#include <gtest/gtest.h>

#include <complex>
#include <cstdlib>
#include <random>
#include <thread>
#include <vector>

#include "kinematics/blas_kernels.h"

extern "C" char* openblas_get_corename();

namespace selfcal {
namespace {

constexpr double kMatrixRounding = 1e-12;  // matrices of 20 x 8 normal numbers, condition below 100

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

Eigen::MatrixXd gram(const Eigen::MatrixXd& A) { return A.transpose() * A; }

TEST(LinearAlgebra, HasNoNumbersWhereThereIsNoRoot) {
  std::mt19937_64 random(45);
  for (const Eigen::Index n : {8, 100}) {
    Eigen::MatrixXd A = gram(random_matrix(2 * n, n, random));
    EXPECT_TRUE(cholesky_root(A).allFinite());
    A(n / 2, n / 2) = -1;
    EXPECT_TRUE(cholesky_root(A).array().isNaN().all()) << n;
    EXPECT_TRUE(inverse_of_positive(A).array().isNaN().all()) << n;
  }
}

TEST(LinearAlgebra, SaysTheSameToSeveralThreadsAtATime) {
  constexpr Eigen::Index kSize = 150;  // large enough for OpenBLAS
  constexpr int kThreads = 4, kTimes = 200;
  std::mt19937_64 random(40);
  std::vector<Eigen::MatrixXd> positive, product, vectors;
  for (int t = 0; t < kThreads; ++t) {
    const Eigen::MatrixXd A = random_matrix(kSize, kSize, random);
    positive.push_back(gram(A));
    product.push_back(transposed_product(positive.back(), positive.back()));
    vectors.push_back(symmetric_eigen(positive.back()).vectors);
  }
  std::vector<int> wrong(kThreads, 0);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < kThreads; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < kTimes; ++i)
        wrong[t] += transposed_product(positive[t], positive[t]) != product[t] ||
                    (i % 20 == 0 && symmetric_eigen(positive[t]).vectors != vectors[t]);
    });
  for (std::thread& each : threads) each.join();
  EXPECT_EQ(wrong, std::vector<int>(kThreads, 0));
}

TEST(Triangularise, LeavesAnUpperTriangleWithTheSameProduct) {
  std::mt19937_64 random(41);
  for (const Eigen::Index rows : {20, 8, 5}) {
    const Eigen::MatrixXd A = random_matrix(rows, 8, random);
    Eigen::MatrixXd R = A;
    triangularise(R);
    EXPECT_TRUE(R.isUpperTriangular(0));
    EXPECT_LT((gram(R) - gram(A)).norm(), kMatrixRounding) << rows;
  }
}

TEST(Triangularise, LosesNothingWhereAColumnSaysNothing) {
  std::mt19937_64 random(47);
  for (const Eigen::Index rows : {20, 8, 5}) {
    Eigen::MatrixXd A = random_matrix(rows, 8, random);
    A.col(0).setZero();
    Eigen::MatrixXd R = A;
    triangularise(R);
    EXPECT_LT((gram(R) - gram(A)).norm(), kMatrixRounding) << rows;
  }
}

TEST(Triangularise, WorksOnTheTopRowsOfALargerMatrix) {
  std::mt19937_64 random(42);
  const Eigen::MatrixXd A = random_matrix(20, 4, random);
  Eigen::MatrixXd B = A;
  triangularise(B.topRows(12));
  EXPECT_LT((gram(B.topRows(12)) - gram(A.topRows(12))).norm(), kMatrixRounding);
  EXPECT_EQ(B.bottomRows(8), A.bottomRows(8));
}

TEST(Eliminate, ReflectsOnlyTheFirstColumnsIntoATriangle) {
  std::mt19937_64 random(43);
  for (const Eigen::Index rows : {20, 3, 2}) {
    const Eigen::MatrixXd A = random_matrix(rows, 8, random);
    Eigen::MatrixXd B = A;
    eliminate(B, 3);
    EXPECT_TRUE(B.leftCols(3).isUpperTriangular(0));
    EXPECT_LT((gram(B) - gram(A)).norm(), kMatrixRounding) << rows;
  }
}

TEST(Eliminate, LeavesBelowTheTriangleTheSchurComplement) {
  std::mt19937_64 random(44);
  const Eigen::MatrixXd A = random_matrix(20, 8, random);
  Eigen::MatrixXd B = A;
  eliminate(B, 3);
  const Eigen::MatrixXd N = gram(A);
  const Eigen::MatrixXd schur = N.bottomRightCorner(5, 5) - N.bottomLeftCorner(5, 3) *
                                                                N.topLeftCorner(3, 3).inverse() *
                                                                N.topRightCorner(3, 5);
  EXPECT_LT((gram(B.bottomRightCorner(17, 5)) - schur).norm(), kMatrixRounding);
}

TEST(Eliminate, LosesNothingOfTheRestWhereAColumnFollowsFromThoseBeforeIt) {
  std::mt19937_64 random(46);
  Eigen::MatrixXd A = random_matrix(20, 8, random);
  A.col(1) = 3 * A.col(0);
  Eigen::MatrixXd B = A;
  const std::vector<Eigen::Index> steps = eliminate(B, 3);
  ASSERT_EQ(steps, (std::vector<Eigen::Index>{0, 2}));
  EXPECT_TRUE(B.bottomLeftCorner(18, 3).isZero(0));
  const Eigen::MatrixXd known = A(Eigen::all, steps), rest = A.rightCols(5);
  const Eigen::MatrixXd left =
      gram(rest) - rest.transpose() * known * gram(known).inverse() * known.transpose() * rest;
  EXPECT_LT((gram(B.bottomRightCorner(18, 5)) - left).norm(), kMatrixRounding);
}

TEST(InverseOfTriangle, TimesTheTriangleIsTheIdentity) {
  std::mt19937_64 random(45);
  Eigen::MatrixXd R = random_matrix(6, 6, random).triangularView<Eigen::Upper>();
  R.diagonal().array() += 5.0;
  EXPECT_TRUE((inverse_of_triangle(R) * R).isIdentity(kMatrixRounding));
}

TEST(LeastSquares, LeavesAResidualNormalToEveryColumn) {
  std::mt19937_64 random(46);
  const Eigen::MatrixXd A = random_matrix(20, 5, random);
  const Eigen::VectorXd b = random_matrix(20, 1, random);
  const Eigen::VectorXd x = least_squares(A, b);
  EXPECT_LT((A.transpose() * (A * x - b)).norm(), kMatrixRounding);
}

TEST(LeastSquares, IsTheShortestWhereManySolve) {
  std::mt19937_64 random(47);
  Eigen::MatrixXd A = random_matrix(20, 4, random);
  A.col(3) = 2 * A.col(0);
  const Eigen::VectorXd x = least_squares(A, A.col(0));
  // x0 + 2 x3 = 1 with the least x0^2 + x3^2.
  EXPECT_LT((x - Eigen::Vector4d(0.2, 0, 0, 0.4)).norm(), kMatrixRounding);
  const Eigen::MatrixXd wide = random_matrix(2, 5, random);
  const Eigen::VectorXd b = random_matrix(2, 1, random);
  const Eigen::VectorXd y = least_squares(wide, b);
  EXPECT_LT((y - wide.transpose() * gram(wide.transpose()).inverse() * b).norm(), kMatrixRounding);
}

TEST(Beyond, IsNormalToWhatIsProjectedOutAndDiffersByItsCombinations) {
  std::mt19937_64 random(48);
  Eigen::MatrixXd onto = random_matrix(20, 4, random);
  onto.col(3) = onto.col(1) - onto.col(2);  // a dependent column must do no harm
  const Eigen::MatrixXd M = random_matrix(20, 3, random);
  const Eigen::MatrixXd rest = beyond(onto, M);
  EXPECT_LT((onto.transpose() * rest).norm(), kMatrixRounding);
  EXPECT_LT((beyond(onto, M - rest)).norm(), kMatrixRounding);
  EXPECT_EQ(beyond(Eigen::MatrixXd(20, 0), M), M);
  EXPECT_EQ(beyond(Eigen::MatrixXd::Zero(20, 2), M), M);
}

TEST(SingularValues, DescendAndComeWithTheirDirections) {
  std::mt19937_64 random(49);
  Eigen::MatrixXd A = random_matrix(20, 4, random);
  A.col(3).setZero();
  const SingularValues found = singular_values(A);
  ASSERT_EQ(found.values.size(), 4);
  for (int i = 0; i < 4; ++i) {
    if (i > 0) {
      EXPECT_GE(found.values[i - 1], found.values[i]);
    }
    EXPECT_NEAR((A * found.directions.col(i)).norm(), found.values[i], kMatrixRounding);
  }
  EXPECT_TRUE(gram(found.directions).isIdentity(kMatrixRounding));
  EXPECT_NEAR(std::abs(found.directions(3, 3)), 1, kMatrixRounding);
  EXPECT_NEAR(found.values[3], 0, kMatrixRounding);
}

TEST(SymmetricEigen, AscendsAndRebuildsTheMatrix) {
  std::mt19937_64 random(50);
  const Eigen::MatrixXd A = gram(random_matrix(6, 4, random));
  const Symmetric found = symmetric_eigen(A);
  EXPECT_LT((found.vectors * found.values.asDiagonal() * found.vectors.transpose() - A).norm(),
            kMatrixRounding);
  for (int i = 1; i < 4; ++i) EXPECT_LE(found.values[i - 1], found.values[i]);
}

TEST(Eigenvalues, AreTheRootsOfTheCompanionsPolynomial) {
  // (z - 2)(z - i)(z + 3i) = z^3 + (2i - 2) z^2 + (3 - 4i) z - 6
  using namespace std::complex_literals;
  Eigen::Matrix3cd companion = Eigen::Matrix3cd::Zero();
  companion(1, 0) = companion(2, 1) = 1;
  companion.col(2) << 6, 4i - 3.0, 2.0 - 2i;
  const Eigen::VectorXcd found = eigenvalues(companion);
  ASSERT_EQ(found.size(), 3);
  for (const std::complex<double> root : {2.0 + 0i, 1i, -3i})
    EXPECT_LT((found.array() - root).abs().minCoeff(), kMatrixRounding) << root;
  EXPECT_EQ(eigenvalues(Eigen::MatrixXcd()).size(), 0);
}

TEST(Triangles, AreSolvedAlikeOnBothSidesOfTheSizeFromWhichALibraryDoes) {
  std::mt19937_64 random(47);
  for (const Eigen::Index n : {5, 63, 64, 200})
    for (const Eigen::Index columns : {1, 2, 7}) {
      const Eigen::MatrixXd A =
          gram(random_matrix(n + 10, n, random)) + Eigen::MatrixXd::Identity(n, n);
      const Eigen::MatrixXd L = cholesky_root(A);
      const double rounding = 1e-13 * static_cast<double>(n) * A.norm();
      EXPECT_TRUE(L.isLowerTriangular(0));
      EXPECT_LT((L * L.transpose() - A).norm(), rounding) << n;
      const Eigen::MatrixXd B = random_matrix(n, columns, random);
      EXPECT_LT((L * solve_lower(L, B) - B).norm(), rounding) << n;
      EXPECT_LT((L.transpose() * solve_lower_transposed(L, B) - B).norm(), rounding) << n;
      EXPECT_LT((transposed_product(A, B) - A.transpose() * B).norm(), rounding * B.norm()) << n;
    }
}

#ifdef __x86_64__
TEST(LinearAlgebra, MultipliesByWhatTheProcessorHas) {
  if (std::getenv("OPENBLAS_CORETYPE")) GTEST_SKIP() << "OPENBLAS_CORETYPE is set";
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
    GTEST_SKIP() << "the processor has no AVX2";
  suit_blas_to_processor();
  EXPECT_STRNE(openblas_get_corename(), "Prescott");
  EXPECT_FALSE(suit_blas_to_processor()) << "it has been done";
  EXPECT_EQ(std::getenv("OPENBLAS_CORETYPE"), nullptr);
}
#endif

TEST(LinearAlgebra, SolvesForNoColumnsAtAll) {
  for (const int n : {3, 300}) {
    const Eigen::MatrixXd L = Eigen::MatrixXd::Identity(n, n), none(n, 0);
    EXPECT_EQ(solve_lower(L, none).size(), 0);
    EXPECT_EQ(solve_lower_transposed(L, none).cols(), 0);
    EXPECT_EQ(transposed_product(L, none).rows(), n);
  }
}

}  // namespace
}  // namespace selfcal
