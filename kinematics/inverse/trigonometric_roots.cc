#include "kinematics/inverse/trigonometric_roots.h"

#include <cmath>
#include <complex>
#include <numbers>

#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

using Complex = std::complex<double>;

constexpr double kNoPart = 1e-9;     // of an equation's norm, that counts as nothing
constexpr double kBesideOne = 1e-9;  // of a cosine beyond one, that rounding explains
constexpr double kOffCircle = 1e-4;  // of a root from the unit circle, where two are nearly one
constexpr double kSolved = 1e-10;    // of equations of norm one
constexpr double kSamePair = 1e-7;   // rad, between two that are one
constexpr int kDegree = 4, kSamples = 2 * kDegree + 1;
constexpr int kPolishing = 6;

Eigen::Vector3d u_of(double t) { return {1, std::cos(t), std::sin(t)}; }
Eigen::Vector3d slope_of(double t) { return {0, -std::sin(t), std::cos(t)}; }

using Both = std::array<Eigen::Matrix3d, 2>;

/// Newton's steps of both equations.
void polish(const Both& M, Eigen::Vector2d& ab) {
  for (int i = 0; i < kPolishing; ++i) {
    const Eigen::Vector3d ua = u_of(ab[0]), ub = u_of(ab[1]);
    Eigen::Vector2d f;
    Eigen::Matrix2d J;
    for (int k = 0; k < 2; ++k) {
      f[k] = ua.dot(M[k] * ub);
      J(k, 0) = slope_of(ab[0]).dot(M[k] * ub);
      J(k, 1) = ua.dot(M[k] * slope_of(ab[1]));
    }
    const Eigen::Vector2d step =
        (J.transpose() * J + 1e-18 * Eigen::Matrix2d::Identity()).ldlt().solve(J.transpose() * f);
    if (!step.allFinite() || step.norm() > 0.1) return;
    ab -= step;
  }
}

class PairList {
 public:
  explicit PairList(const Both& M) : M_(M) {}

  /// The pair once polished, if it solves both and is no other's twin.
  void add(double a, double b) {
    Eigen::Vector2d ab(a, b);
    polish(M_, ab);
    for (const Eigen::Matrix3d& each : M_)
      if (std::abs(u_of(ab[0]).dot(each * u_of(ab[1]))) > kSolved) return;
    for (double& angle : ab) angle = std::remainder(angle, 2 * std::numbers::pi);
    for (const Eigen::Vector2d& other : list)
      if (std::abs(std::remainder(ab[0] - other[0], 2 * std::numbers::pi)) < kSamePair &&
          std::abs(std::remainder(ab[1] - other[1], 2 * std::numbers::pi)) < kSamePair)
        return;
    list.push_back(ab);
  }

  /// Every b that goes with `a`.
  void complete(double a) {
    const Eigen::Vector3d u = M_[0].transpose() * u_of(a), v = M_[1].transpose() * u_of(a);
    const double cross = u[1] * v[2] - u[2] * v[1];
    const double size = u.tail<2>().norm() * v.tail<2>().norm();
    if (std::abs(cross) > kNoPart * size && size > kNoPart * kNoPart)
      add(a, std::atan2(u[1] * -v[0] + u[0] * v[1], u[2] * v[0] - u[0] * v[2]) +
                 (cross < 0 ? std::numbers::pi : 0));
    for (const double b : roots_of(u.tail<2>().norm() > v.tail<2>().norm() ? u : v)) add(a, b);
  }

  std::vector<Eigen::Vector2d> list;

 private:
  const Both& M_;
};

/// What a combination of both is that is free of the second angle, u(a)^T c; nothing where none is.
bool free_of_second(const Both& M, Eigen::Vector3d& c) {
  Eigen::Matrix<double, 2, 6> parts;
  for (int k = 0; k < 2; ++k) parts.row(k) = M[k].rightCols<2>().reshaped().transpose();
  const SingularValues svd = singular_values(parts.transpose());
  if (svd.values[1] > kNoPart) return false;
  const Eigen::Vector2d by = svd.directions.col(1);
  c = by[0] * M[0].col(0) + by[1] * M[1].col(0);
  return true;
}

/// cos² + sin² - 1 of b, times the square of the determinant.
double resultant(const Both& M, double a) {
  const Eigen::Vector3d u = M[0].transpose() * u_of(a), v = M[1].transpose() * u_of(a);
  const double c = u[2] * v[0] - u[0] * v[2], s = u[0] * v[1] - u[1] * v[0];
  const double cross = u[1] * v[2] - u[2] * v[1];
  return c * c + s * s - cross * cross;
}

/// Angles of the roots of the resultant that lie on the unit circle.
std::vector<double> roots_of_resultant(const Both& M) {
  // z^4 times the polynomial: its coefficients from -4 to 4 by the discrete Fourier transform.
  std::array<Complex, kSamples> c{};
  for (int i = 0; i < kSamples; ++i) {
    const double a = 2 * std::numbers::pi * i / kSamples, value = resultant(M, a);
    for (int k = 0; k < kSamples; ++k)
      c[k] += value / kSamples * std::polar(1.0, -a * (k - kDegree));
  }
  double most = 0;
  for (const Complex& each : c) most = std::max(most, std::abs(each));
  int drop = 0;  // on either side: the coefficients are conjugate
  while (drop < kDegree && std::abs(c[kSamples - 1 - drop]) < 1e-13 * most) ++drop;
  const int degree = 2 * (kDegree - drop);
  if (degree == 0 || most == 0) return {};
  Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(degree, degree);
  for (int k = 0; k < degree; ++k) {
    companion(k, degree - 1) = -c[drop + k] / c[drop + degree];
    if (k > 0) companion(k, k - 1) = 1;
  }
  std::vector<double> list;
  for (const Complex& z : eigenvalues(companion))
    if (std::abs(std::abs(z) - 1) < kOffCircle) list.push_back(std::arg(z));
  return list;
}

}  // namespace

std::vector<double> roots_of(const Eigen::Vector3d& c) {
  const double size = c.tail<2>().norm();
  if (!(size > kNoPart * std::max(c.norm(), 1e-300))) return {};
  const double cosine = -c[0] / size;
  if (std::abs(cosine) > 1 + kBesideOne) return {};
  const double middle = std::atan2(c[2], c[1]), half = std::acos(std::clamp(cosine, -1.0, 1.0));
  if (half < kBesideOne || std::numbers::pi - half < kBesideOne)
    return {std::remainder(middle + half, 2 * std::numbers::pi)};
  return {std::remainder(middle + half, 2 * std::numbers::pi),
          std::remainder(middle - half, 2 * std::numbers::pi)};
}

Eigen::Matrix3d coefficients(const std::function<double(double, double)>& f) {
  // Three samples of each angle determine its three coefficients.
  Eigen::Matrix3d value, to;
  for (int i = 0; i < 3; ++i) {
    const double t = 2 * std::numbers::pi * i / 3;
    to.col(i) = u_of(t).cwiseProduct(Eigen::Vector3d(1, 2, 2)) / 3;
    for (int j = 0; j < 3; ++j) value(i, j) = f(t, 2 * std::numbers::pi * j / 3);
  }
  return to * value * to.transpose();
}

std::vector<Eigen::Vector2d> common_roots(const Eigen::Matrix3d& M_1, const Eigen::Matrix3d& M_2) {
  if (!(M_1.norm() > 0) || !(M_2.norm() > 0)) return {};
  const Both M{Eigen::Matrix3d(M_1 / M_1.norm()), Eigen::Matrix3d(M_2 / M_2.norm())};
  const Both turned{Eigen::Matrix3d(M[0].transpose()), Eigen::Matrix3d(M[1].transpose())};
  PairList pairs(M);
  Eigen::Vector3d c;
  if (free_of_second(M, c)) {
    for (const double a : roots_of(c)) pairs.complete(a);
  } else if (free_of_second(turned, c)) {
    PairList other(turned);
    for (const double b : roots_of(c)) other.complete(b);
    for (const Eigen::Vector2d& each : other.list) pairs.add(each[1], each[0]);
  } else {
    for (const double a : roots_of_resultant(M)) pairs.complete(a);
  }
  return pairs.list;
}

}  // namespace selfcal
