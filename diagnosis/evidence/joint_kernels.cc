// What one joint moves, times how alike its errors are: the kernels' roots are a few columns over
// the rows each, at the equations' rows.
#include "diagnosis/evidence/joint_kernels.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "diagnosis/constants.h"
#include "diagnosis/evidence/kernel_basis.h"
#include "diagnosis/evidence/rows.h"

namespace selfcal {
namespace {

constexpr Eigen::Index kKnots = 24;    ///< of a function of one reading
constexpr double kLeastOfWave = 1e-3;  ///< that a wave is worth

/// One function of one or two readings, in two rows.
double likeness(const Eigen::MatrixXd& readings, Eigen::Index a, Eigen::Index b) {
  double sum = 0, squares = 0;
  const Eigen::Index joints = readings.cols();
  for (Eigen::Index j = 0; j < joints; ++j) {
    const double apart = (readings(a, j) - readings(b, j)) / kDiagnosis.structure.turned;
    const double each = (1 + std::exp(-apart * apart / 2)) / 2;
    sum += each;
    squares += each * each;
  }
  const auto pairs = static_cast<double>(joints * (joints - 1));
  return pairs > 0 ? (sum * sum - squares) / pairs : sum;
}

/// How far each row is from the mean temperature, over the spread; zero where that is not told or
/// where the temperature stays.
Eigen::VectorXd warmth(const Observations& data, const std::vector<int>& rows) {
  Eigen::VectorXd from_mean = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rows.size()));
  if (data.temperature.size() == 0) return from_mean;
  std::vector<double> told;
  for (const int row : rows)
    if (std::isfinite(data.temperature[row])) told.push_back(data.temperature[row]);
  if (told.empty()) return from_mean;
  const auto n = static_cast<double>(told.size());
  const double mean = std::accumulate(told.begin(), told.end(), 0.0) / n;
  double squares = 0;
  for (const double t : told) squares += (t - mean) * (t - mean) / n;
  const double spread = std::sqrt(squares);
  if (!(std::ranges::max(told) - std::ranges::min(told) > kDiagnosis.shapes.warms))
    return from_mean;
  for (Eigen::Index i = 0; i < from_mean.size(); ++i)
    if (const double t = data.temperature[rows[static_cast<std::size_t>(i)]]; std::isfinite(t))
      from_mean[i] = (t - mean) / spread;
  return from_mean;
}

/// What an error in the row of each equation moves it, and one in the row before that.
struct Moved {
  Eigen::VectorXd now, before;
};

/// The rows of equations by their places among all that have any.
class Places {
 public:
  Places(const std::vector<int>& row, const std::vector<int>& before)
      : equations_(row.size()), of_(both(row, before)) {}
  const std::vector<int>& rows() const { return of_.rows; }

  /// `of_rows` (by place) at the equations' places, times `moved` brought to a mean square of 1.
  Eigen::MatrixXd root(const Moved& moved, const Eigen::MatrixXd& of_rows) const {
    const double norm = std::hypot(moved.now.norm(), moved.before.norm());
    const double scale = norm > 0 ? std::sqrt(static_cast<double>(equations_)) / norm : 0;
    Eigen::MatrixXd F = Eigen::MatrixXd::Zero(moved.now.size(), of_rows.cols());
    for (Eigen::Index i = 0; i < moved.now.size(); ++i) {
      if (const int at = now(i); at >= 0) F.row(i) += scale * moved.now[i] * of_rows.row(at);
      if (const int at = before(i); at >= 0) F.row(i) += scale * moved.before[i] * of_rows.row(at);
    }
    return F;
  }

  /// `moved` times what `of_rows` has for each row.
  Moved times(Moved moved, const Eigen::VectorXd& of_rows) const {
    for (Eigen::Index i = 0; i < moved.now.size(); ++i) {
      moved.now[i] *= now(i) < 0 ? 0 : of_rows[now(i)];
      moved.before[i] *= before(i) < 0 ? 0 : of_rows[before(i)];
    }
    return moved;
  }

 private:
  static std::vector<int> both(std::vector<int> row, const std::vector<int>& before) {
    row.insert(row.end(), before.begin(), before.end());
    row.resize(2 * (row.size() - before.size()), -1);
    return row;
  }
  int now(Eigen::Index equation) const { return of_.of[static_cast<std::size_t>(equation)]; }
  int before(Eigen::Index equation) const {
    return of_.of[equations_ + static_cast<std::size_t>(equation)];
  }

  std::size_t equations_;
  RowPlaces of_;
};

/// What errors of a joint's readings do.
Moved moved_by(const JointErrors& joints, int joint) {
  Moved moved{joints.readings.by_joint.col(joint), {}};
  moved.before.setZero(moved.now.size());
  if (joints.by_before.cols() > joint) moved.before = joints.by_before.col(joint);
  moved.now -= moved.before;
  return moved;
}

}  // namespace

Eigen::MatrixXd comparable_readings(const Robot& robot, Eigen::MatrixXd q) {
  for (Eigen::Index j = 0; j < q.cols(); ++j) {
    if (robot.joints()[static_cast<size_t>(j)].quantity == Quantity::angle) continue;
    const double moved = q.col(j).maxCoeff() - q.col(j).minCoeff();
    if (moved > 0) q.col(j) *= std::numbers::pi / moved;
  }
  return q;
}

std::vector<JointKernel> joint_kernels(const Observations& data, const DenseEquations& rows,
                                       const JointErrors& joints) {
  const Places places(rows.row, joints.before);
  const Eigen::MatrixXd readings = joints.alike(places.rows(), Eigen::all);
  const Eigen::VectorXd warm = warmth(data, places.rows());
  const Eigen::MatrixXd smooth = smooth_in_two_readings(readings);
  std::vector<JointKernel> list;
  for (int j = 0; j < static_cast<int>(readings.cols()); ++j) {
    const Moved by_reading = moved_by(joints, j);
    if (by_reading.now.isZero(0) && by_reading.before.isZero(0)) continue;
    const Eigen::MatrixXd with_mean = periodic_in_reading(readings.col(j));
    const Eigen::MatrixXd uneven = with_mean.rightCols(with_mean.cols() - 1);
    list.push_back({KernelDomain::turned, j, places.root(by_reading, smooth)});
    list.push_back(
        {KernelDomain::kinked, j, places.root(by_reading, kinked_in_reading(readings.col(j)))});
    if (joints.by_load.cols() > j && !joints.by_load.col(j).isZero()) {
      const Moved by_load{joints.by_load.col(j), Eigen::VectorXd::Zero(joints.by_load.rows())};
      list.push_back({KernelDomain::load, j, places.root(by_load, uneven)});
    }
    if (!warm.isZero())
      list.push_back(
          {KernelDomain::warmth, j, places.root(places.times(by_reading, warm), uneven)});
  }
  return list;
}

Eigen::MatrixXd smooth_in_two_readings(const Eigen::MatrixXd& readings) {
  const Eigen::Index n = readings.rows();
  Eigen::MatrixXd K(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) K(i, j) = K(j, i) = likeness(readings, i, j);
  return *low_rank_root(K, n);
}

Eigen::MatrixXd kinked_in_reading(const Eigen::VectorXd& reading) {
  const Eigen::Index n = reading.size();
  if (n == 0) return Eigen::MatrixXd(0, 0);
  const double from = reading.minCoeff(), range = reading.maxCoeff() - from;
  const double step = range / static_cast<double>(kKnots - 1);
  const double kept = std::exp(-step / kDiagnosis.structure.kinked),
               fresh = std::sqrt(1 - kept * kept);
  // Each knot has what the one before keeps, and something of its own.
  Eigen::MatrixXd at_knots = Eigen::MatrixXd::Zero(kKnots, kKnots);
  at_knots(0, 0) = 1;
  for (Eigen::Index k = 1; k < kKnots; ++k) {
    at_knots.row(k) = kept * at_knots.row(k - 1);
    at_knots(k, k) = fresh;
  }
  Eigen::MatrixXd F(n, kKnots);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double at = step > 0 ? (reading[i] - from) / step : 0;
    const auto k = std::min(static_cast<Eigen::Index>(at), kKnots - 2);
    const double beyond = at - static_cast<double>(k);
    F.row(i) = (1 - beyond) * at_knots.row(k) + beyond * at_knots.row(k + 1);
  }
  return F;
}

Eigen::MatrixXd periodic_in_reading(const Eigen::VectorXd& reading) {
  const double z = 1 / (kDiagnosis.structure.periodic * kDiagnosis.structure.periodic);
  const auto variance = [z](int waves) {
    return (waves > 0 ? 2 : 1) * std::cyl_bessel_i(waves, z) * std::exp(-z);
  };
  int most = 0;
  while (variance(most + 1) > kLeastOfWave) ++most;
  Eigen::MatrixXd F(reading.size(), 2 * most + 1);
  F.col(0).setConstant(std::sqrt(variance(0)));
  for (int waves = 1; waves <= most; ++waves) {
    F.col(2 * waves - 1) = std::sqrt(variance(waves)) * (waves * reading.array()).cos();
    F.col(2 * waves) = std::sqrt(variance(waves)) * (waves * reading.array()).sin();
  }
  return F;
}

}  // namespace selfcal
