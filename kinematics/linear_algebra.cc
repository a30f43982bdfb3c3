// Decompositions by Eigen.
#include "kinematics/linear_algebra.h"

#include <cmath>

namespace selfcal {

void triangularise(Eigen::Ref<Eigen::MatrixXd> A) {
  const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> in_place(A);
  A.triangularView<Eigen::StrictlyLower>().setZero();
}

void eliminate(Eigen::Ref<Eigen::MatrixXd> A, Eigen::Index columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(A.leftCols(columns));
  A.rightCols(A.cols() - columns).applyOnTheLeft(qr.householderQ().adjoint());
  A.leftCols(columns).setZero();
  const Eigen::Index rows = std::min(columns, A.rows());
  A.topLeftCorner(rows, columns) = qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
}

Eigen::MatrixXd inverse_of_triangle(const Eigen::Ref<const Eigen::MatrixXd>& R) {
  return R.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(R.rows(), R.rows()));
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  if (A.cols() == 0) return {};
  return A.completeOrthogonalDecomposition().solve(b);
}

Eigen::MatrixXd beyond(const Eigen::MatrixXd& onto, const Eigen::MatrixXd& M) {
  if (onto.cols() == 0) return M;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(onto);
  const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(onto.rows(), qr.rank());
  return M - Q * (Q.transpose() * M);
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

Eigen::MatrixXd cholesky_root(const Eigen::MatrixXd& A) {
  return Eigen::LLT<Eigen::MatrixXd>(A).matrixL();
}

Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& L, const Eigen::MatrixXd& B) {
  return L.triangularView<Eigen::Lower>().solve(B);
}

Eigen::MatrixXd inverse_of_positive(const Eigen::MatrixXd& A) {
  return Eigen::LLT<Eigen::MatrixXd>(A).solve(Eigen::MatrixXd::Identity(A.rows(), A.cols()));
}

SingularValues singular_values(const Eigen::MatrixXd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinV);
  return {svd.singularValues(), svd.matrixV()};
}

Symmetric symmetric_eigen(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

}  // namespace selfcal
