// The few matrix decompositions that the project needs, compiled once: Eigen's templates take
// minutes where every file makes its own. Several threads may call them at a time.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace selfcal {

/// Overwrites `A` by R of its QR decomposition (Householder): upper triangular, zeros below; as
/// many rows as before.
void triangularise(Eigen::Ref<Eigen::MatrixXd> A);

/// Reflects the rows of `A` so that its first `columns` columns become a staircase: a row for each
/// that does not follow from those before it, which are returned, and zeros below.
std::vector<Eigen::Index> eliminate(Eigen::Ref<Eigen::MatrixXd> A, Eigen::Index columns);

/// Inverse of the upper triangular `R`.
Eigen::MatrixXd inverse_of_triangle(const Eigen::Ref<const Eigen::MatrixXd>& R);

/// (R^T R)^-1 of the upper triangular `R`.
Eigen::MatrixXd inverse_of_square(const Eigen::Ref<const Eigen::MatrixXd>& R);

/// x of least length that minimises |A x - b| (complete orthogonal decomposition).
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// The same of every column of `B`.
Eigen::MatrixXd least_squares_of_all(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// What is left of the columns of `M` after projecting the column space of `onto` out.
Eigen::MatrixXd beyond(const Eigen::MatrixXd& onto, const Eigen::MatrixXd& M);

/// An orthonormal basis of the columns of `A`, as many as its rank, and the log of the product of
/// the diagonal of its triangle.
struct OrthogonalColumns {
  Eigen::MatrixXd Q;
  double log_volume = 0;
};
OrthogonalColumns orthogonal_columns(const Eigen::MatrixXd& A);

/// Lower Cholesky factor of the positive definite `A`; not a number where it is none.
Eigen::MatrixXd cholesky_root(Eigen::MatrixXd A);
/// L^-1 B of the lower triangular `L`.
Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& L, const Eigen::MatrixXd& B);
/// L^-T B.
Eigen::MatrixXd solve_lower_transposed(const Eigen::MatrixXd& L, const Eigen::MatrixXd& B);
/// A B, of large ones too.
Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
/// A^T B.
Eigen::MatrixXd transposed_product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
/// Adds A^T A to the lower triangle of `H`.
void add_square(const Eigen::Ref<const Eigen::MatrixXd>& A, Eigen::MatrixXd& H);
/// Inverse of the positive definite `A`; not a number where it is none.
Eigen::MatrixXd inverse_of_positive(const Eigen::MatrixXd& A);

struct SingularValues {
  Eigen::VectorXd values;      ///< descending
  Eigen::MatrixXd directions;  ///< right singular vectors, one a column
};
SingularValues singular_values(const Eigen::MatrixXd& A);

struct Symmetric {
  Eigen::VectorXd values;   ///< ascending
  Eigen::MatrixXd vectors;  ///< one a column
};
/// Eigenvalues and vectors of a symmetric matrix.
Symmetric symmetric_eigen(const Eigen::MatrixXd& A);
/// Eigenvalues of a finite square matrix, in no order.
Eigen::VectorXcd eigenvalues(Eigen::MatrixXcd A);

}  // namespace selfcal
