// Decompositions by Eigen; large triangles by OpenBLAS (blas_kernels.h), from one thread at a time:
// its builds without threads, Debian's serial one among them, hand one buffer to two callers.
#include "kinematics/linear_algebra.h"

#include <cblas.h>

#include <cmath>
#include <complex>
#include <limits>
#include <mutex>
#include <vector>

#include "kinematics/expects.h"
#include "kinematics/kernels/kernels.h"

extern "C" void dpotrf_(const char* triangle, const int* n, double* A, const int* stride,
                        int* info);
extern "C" void dgeqrf_(const int* rows, const int* columns, double* A, const int* stride,
                        double* factors, double* work, const int* work_size, int* info);
extern "C" void dsyevd_(const char* vectors, const char* triangle, const int* n, double* A,
                        const int* stride, double* values, double* work, const int* work_size,
                        int* integers, const int* integers_size, int* info);

extern "C" void zgeev_(const char* left, const char* right, const int* n, std::complex<double>* A,
                       const int* stride, std::complex<double>* values,
                       std::complex<double>* left_vectors, const int* left_stride,
                       std::complex<double>* right_vectors, const int* right_stride,
                       std::complex<double>* work, const int* work_size, double* real_work,
                       int* info);

namespace selfcal {
namespace {

constexpr Eigen::Index kLarge = 64;  ///< rows from which a call of OpenBLAS is worth its start
constexpr Eigen::Index kReflectedTogether = 128;  ///< columns from which LAPACK's QR is in blocks
constexpr double kWorthACall = 1e5;               ///< multiplications from which it is

int width(Eigen::Index n) { return static_cast<int>(n); }

/// To be held during a call; of nothing where OpenBLAS takes care of its callers itself.
std::unique_lock<std::mutex> turn_of_one() {
  static std::mutex one;
  static const bool alone = openblas_get_parallel() == OPENBLAS_SEQUENTIAL;
  return alone ? std::unique_lock(one) : std::unique_lock<std::mutex>();
}

/// op(T)^-1 B in place, of the triangle T that lies in that half.
void solve_in_place(CBLAS_UPLO half, CBLAS_TRANSPOSE op, const Eigen::Ref<const Eigen::MatrixXd>& T,
                    Eigen::MatrixXd& B) {
  const auto turn = turn_of_one();
  cblas_dtrsm(CblasColMajor, CblasLeft, half, op, CblasNonUnit, width(B.rows()), width(B.cols()), 1,
              T.data(), width(T.outerStride()), B.data(), width(B.rows()));
}

/// op(A) B.
Eigen::MatrixXd large_product(CBLAS_TRANSPOSE op, const Eigen::MatrixXd& A,
                              const Eigen::MatrixXd& B) {
  Eigen::MatrixXd AB(op == CblasTrans ? A.cols() : A.rows(), B.cols());
  const auto turn = turn_of_one();
  cblas_dgemm(CblasColMajor, op, CblasNoTrans, width(AB.rows()), width(B.cols()), width(B.rows()),
              1, A.data(), width(A.rows()), B.data(), width(B.rows()), 0, AB.data(),
              width(AB.rows()));
  return AB;
}

/// By divide and conquer.
Symmetric large_symmetric_eigen(const Eigen::MatrixXd& A) {
  Symmetric eigen{Eigen::VectorXd(A.rows()), A};
  const int n = width(A.rows());
  const int work_size = 1 + 6 * n + 2 * n * n, integers_size = 3 + 5 * n;
  std::vector<double> work(static_cast<std::size_t>(work_size));
  std::vector<int> integers(static_cast<std::size_t>(integers_size));
  int info = 0;
  const auto turn = turn_of_one();
  dsyevd_("V", "L", &n, eigen.vectors.data(), &n, eigen.values.data(), work.data(), &work_size,
          integers.data(), &integers_size, &info);
  expects(info == 0, "the eigenvalues of a finite symmetric matrix are found");
  return eigen;
}

/// QR in blocks, R on and above the diagonal.
void large_qr(Eigen::Ref<Eigen::MatrixXd> A) {
  constexpr Eigen::Index kBlock = 64;  // columns that are reflected together
  const int rows = width(A.rows()), columns = width(A.cols()), stride = width(A.outerStride());
  Eigen::VectorXd factors(std::min(A.rows(), A.cols())), work(kBlock * A.cols());
  const int work_size = width(work.size());
  int info = 0;
  const auto turn = turn_of_one();
  dgeqrf_(&rows, &columns, A.data(), &stride, factors.data(), work.data(), &work_size, &info);
  expects(info == 0, "every matrix has a QR decomposition");
}

/// The rows of `A`, no fewer than its columns, appended to a triangle of nothing.
void small_qr(Eigen::Ref<Eigen::MatrixXd> A) {
  constexpr auto kStep = static_cast<Eigen::Index>(kernels::kMultiple);
  const Eigen::Index columns = A.cols();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero((A.rows() + kStep - 1) / kStep * kStep, columns);
  rows.topRows(A.rows()) = A;
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(columns, columns);
  kernels::append_rows(R.data(), static_cast<std::size_t>(columns), rows.data(),
                       static_cast<std::size_t>(rows.rows()),
                       static_cast<std::size_t>(rows.rows()));
  A.setZero();
  A.topRows(columns) = R;
}

/// What everything that is made of it shows.
Eigen::MatrixXd no_root(Eigen::Index n) {
  return Eigen::MatrixXd::Constant(n, n, std::numeric_limits<double>::quiet_NaN());
}

bool large(const Eigen::MatrixXd& L, const Eigen::MatrixXd& B) {
  return B.cols() > 1 && static_cast<double>(L.size() * B.cols()) >= kWorthACall;
}

}  // namespace

void triangularise(Eigen::Ref<Eigen::MatrixXd> A) {
  if (A.cols() < kReflectedTogether && A.rows() >= A.cols()) return small_qr(A);
  large_qr(A);
  A.triangularView<Eigen::StrictlyLower>().setZero();
}

std::vector<Eigen::Index> eliminate(Eigen::Ref<Eigen::MatrixXd> A, Eigen::Index columns) {
  constexpr double kNothing = 1e-12;  // of a column's length: rounding of what hangs on others
  const Eigen::VectorXd length = A.leftCols(columns).colwise().norm();
  std::vector<Eigen::Index> steps;
  Eigen::VectorXd reflector(A.rows()), work(A.cols());
  for (Eigen::Index c = 0; c < columns; ++c) {
    const auto row = static_cast<Eigen::Index>(steps.size());
    const Eigen::Index below = A.rows() - row;
    auto column = A.col(c).tail(below);
    if (column.norm() <= kNothing * length[c]) {
      column.setZero();
      continue;
    }
    double factor = 0, diagonal = 0;
    auto essential = reflector.head(below - 1);
    column.makeHouseholder(essential, factor, diagonal);
    A.bottomRightCorner(below, A.cols() - c - 1)
        .applyHouseholderOnTheLeft(essential, factor, work.data());
    column.setZero();
    column[0] = diagonal;
    steps.push_back(c);
  }
  return steps;
}

Eigen::MatrixXd inverse_of_triangle(const Eigen::Ref<const Eigen::MatrixXd>& R) {
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(R.rows(), R.rows());
  if (R.rows() < kLarge) return R.triangularView<Eigen::Upper>().solve(inverse);
  solve_in_place(CblasUpper, CblasNoTrans, R, inverse);  // LAPACK's dtrtri here goes by columns
  return inverse;
}

Eigen::MatrixXd inverse_of_square(const Eigen::Ref<const Eigen::MatrixXd>& R) {
  const Eigen::MatrixXd inverse = inverse_of_triangle(R);
  if (R.rows() < kLarge) return inverse * inverse.transpose();
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(R.rows(), R.rows());
  const int n = width(R.rows());
  const auto turn = turn_of_one();
  cblas_dsyrk(CblasColMajor, CblasUpper, CblasNoTrans, n, n, 1, inverse.data(), n, 0, C.data(), n);
  C.triangularView<Eigen::StrictlyLower>() = C.transpose();
  return C;
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  if (A.cols() == 0) return {};
  expects(A.rows() == b.size(), "a right side of as many rows");
  return A.completeOrthogonalDecomposition().solve(b);
}

Eigen::MatrixXd least_squares_of_all(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  if (A.cols() == 0 || B.cols() == 0) return Eigen::MatrixXd::Zero(A.cols(), B.cols());
  if (A.rows() <= A.cols()) return A.completeOrthogonalDecomposition().solve(B);
  const Eigen::Index n = A.cols();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(A);
  const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(A.rows(), n);
  const Eigen::MatrixXd R = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  return R.completeOrthogonalDecomposition().solve(transposed_product(Q, B));
}

Eigen::MatrixXd beyond(const Eigen::MatrixXd& onto, const Eigen::MatrixXd& M) {
  if (onto.cols() == 0) return M;
  expects(onto.rows() == M.rows(), "columns of one space");
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(onto);
  Eigen::MatrixXd left = M;
  left.applyOnTheLeft(qr.householderQ().adjoint());
  left.topRows(qr.rank()).setZero();
  left.applyOnTheLeft(qr.householderQ());
  return left;
}

OrthogonalColumns orthogonal_columns(const Eigen::MatrixXd& A) {
  OrthogonalColumns result;
  const Eigen::VectorXd length = A.colwise().norm().cwiseMax(1e-300);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A * length.cwiseInverse().asDiagonal());
  result.Q = qr.householderQ() * Eigen::MatrixXd::Identity(A.rows(), qr.rank());
  for (Eigen::Index i = 0; i < qr.rank(); ++i)
    result.log_volume +=
        std::log(std::abs(qr.matrixQR()(i, i)) * length[qr.colsPermutation().indices()[i]]);
  return result;
}

Eigen::MatrixXd cholesky_root(Eigen::MatrixXd A) {
  if (A.rows() < kLarge) {
    const Eigen::LLT<Eigen::MatrixXd> factor(A);
    if (factor.info() != Eigen::Success) return no_root(A.rows());
    return factor.matrixL();
  }
  const int n = width(A.rows());
  int info = 0;
  const auto turn = turn_of_one();
  dpotrf_("L", &n, A.data(), &n, &info);
  if (info != 0) return no_root(A.rows());
  A.triangularView<Eigen::StrictlyUpper>().setZero();
  return A;
}

Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& L, const Eigen::MatrixXd& B) {
  if (B.size() == 0) return B;
  expects(L.rows() == L.cols() && L.rows() == B.rows(), "a triangle and a right side of it");
  if (!large(L, B)) return L.triangularView<Eigen::Lower>().solve(B);
  Eigen::MatrixXd X = B;
  solve_in_place(CblasLower, CblasNoTrans, L, X);
  return X;
}

Eigen::MatrixXd solve_lower_transposed(const Eigen::MatrixXd& L, const Eigen::MatrixXd& B) {
  if (B.size() == 0) return B;
  expects(L.rows() == L.cols() && L.rows() == B.rows(), "a triangle and a right side of it");
  if (!large(L, B)) return L.transpose().triangularView<Eigen::Upper>().solve(B);
  Eigen::MatrixXd X = B;
  solve_in_place(CblasLower, CblasTrans, L, X);
  return X;
}

Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  expects(A.cols() == B.rows(), "as many columns as rows");
  if (static_cast<double>(A.size() * B.cols()) < kWorthACall) return A * B;
  return large_product(CblasNoTrans, A, B);
}

Eigen::MatrixXd transposed_product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  expects(A.rows() == B.rows(), "two of as many rows");
  if (static_cast<double>(A.size() * B.cols()) < kWorthACall) return A.transpose() * B;
  return large_product(CblasTrans, A, B);
}

void add_square(const Eigen::Ref<const Eigen::MatrixXd>& A, Eigen::MatrixXd& H) {
  expects(H.rows() == A.cols() && H.cols() == A.cols(), "as many sums as columns");
  const auto turn = turn_of_one();
  cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, width(A.cols()), width(A.rows()), 1, A.data(),
              width(A.outerStride()), 1, H.data(), width(H.rows()));
}

Eigen::MatrixXd inverse_of_positive(const Eigen::MatrixXd& A) {
  if (A.rows() < kLarge) {
    const Eigen::LLT<Eigen::MatrixXd> factor(A);
    if (factor.info() != Eigen::Success) return no_root(A.rows());
    return factor.solve(Eigen::MatrixXd::Identity(A.rows(), A.cols()));
  }
  return inverse_of_square(cholesky_root(A).transpose());
}

SingularValues singular_values(const Eigen::MatrixXd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinV);
  return {svd.singularValues(), svd.matrixV()};
}

Symmetric symmetric_eigen(const Eigen::MatrixXd& A) {
  if (A.size() == 0) return {};
  if (A.rows() >= kLarge) return large_symmetric_eigen(A);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

Eigen::VectorXcd eigenvalues(Eigen::MatrixXcd A) {
  expects(A.rows() == A.cols(), "a square matrix");
  Eigen::VectorXcd values(A.rows());
  if (values.size() == 0) return values;
  const int n = width(A.rows()), none = 1, work_size = 4 * n;
  Eigen::VectorXcd work(work_size);
  Eigen::VectorXd real_work(2 * n);
  int info = 0;
  const auto turn = turn_of_one();
  zgeev_("N", "N", &n, A.data(), &n, values.data(), nullptr, &none, nullptr, &none, work.data(),
         &work_size, real_work.data(), &info);
  expects(info == 0, "the eigenvalues of a finite matrix are found");
  return values;
}

}  // namespace selfcal
