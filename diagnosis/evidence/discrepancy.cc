// Covariance of two equations: that of their configurations, a Gaussian bell of the distance, times
// the cosine between the directions that they measure in (in time: as the tool sees them; what all
// share in the world's axes is a drift of the base, which is known). Where a joint is off by a
// function of the readings, it is
//   J(1) J(2) mean_ab (1 + bell_a) (1 + bell_b) / 4
// with J what the joint moves the equation (of mean square 1 over all equations) and bell_a that of
// the difference of reading a: functions of one reading and of two, all of them smooth.
#include "diagnosis/evidence/discrepancy.h"

#include <cmath>
#include <iterator>
#include <numbers>
#include <span>

#include "diagnosis/evidence/visits.h"
#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

// What a configuration brings along, over the noise of its repeats: a surface's roughness and the
// robot's own repeatability are noise to a calibration, and hardly ever more than the rest.
constexpr struct {
  double kappa, probability;
} kShared[] = {{0, 0.4}, {0.4, 0.3}, {0.7, 0.2}, {0.9, 0.1}};
constexpr double kUsual = 0.4;
constexpr double kMore[] = {1.4, 2.8, 5.6};              ///< that is structure
constexpr double kSizes[] = {0.35, 0.7, 1.4, 2.8, 5.6};  ///< of smooth structure, over the noise
constexpr double kOfJoint[] = {0.7, 1.4, 2.8, 5.6};      ///< of errors of one joint
constexpr double kJoints = 1.0;                          ///< rad
constexpr double kTurned = 2.0;                          ///< rad, of errors of one joint
constexpr double kPlace = 0.4;                           ///< m
constexpr double kTime = 0.1;                            ///< of the whole
constexpr double kOfVisits[] = {1, 0.5, 0};              ///< shares of a visit's noise

class Kernel {
 public:
  Kernel(const Observations& data, const DenseEquations& rows,
         const std::vector<Eigen::Isometry3d>& ends, Eigen::MatrixXd by_joint,
         const Eigen::MatrixXd& alike)
      : data_(data),
        rows_(rows),
        ends_(ends),
        by_joint_(std::move(by_joint)),
        alike_(alike),
        visit_(visits(data)) {
    std::vector<double> times;  // a row need not have one
    std::ranges::copy_if(data.time, std::back_inserter(times),
                         [](double t) { return std::isfinite(t); });
    if (!times.empty()) span_ = std::ranges::max(times) - std::ranges::min(times);
    direction_ = rows.shift;
    for (auto each : direction_.rowwise())
      if (each.norm() > 0) each /= each.norm();
  }

  bool possible(KernelDomain closeness) const {
    return closeness != KernelDomain::time || span_ > 0;
  }

  /// Covariance of noise of one, of so much of the visits' own noise and of the readings' rounding.
  Eigen::MatrixXd noise(double of_visits) const {
    const Eigen::MatrixXd rounding = by_joint_ * (reading_steps(data_.q) / 2).asDiagonal();
    const auto n = static_cast<Eigen::Index>(rows_.row.size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) {
        const int a = rows_.row[i], b = rows_.row[j];
        if (a < 0 || b < 0 || !repeats(a, b)) continue;
        double shared = 0;
        for (Eigen::Index k = 0; k < rounding.cols(); ++k)
          if (data_.q(a, k) == data_.q(b, k)) shared += rounding(i, k) * rounding(j, k);
        K(i, j) += shared / 3;  // uniform within half a digit either way
        if (visit_[a] == visit_[b])
          K(i, j) += of_visits * of_visits * direction_.row(i).dot(direction_.row(j));
        if (i != j) K(j, i) = K(i, j);
      }
    return K;
  }

  /// Of errors of one joint.
  Eigen::MatrixXd of_joint(Eigen::Index joint) const {
    const auto n = static_cast<Eigen::Index>(rows_.row.size());
    Eigen::VectorXd J = by_joint_.col(joint);
    if (J.norm() > 0) J *= std::sqrt(static_cast<double>(n)) / J.norm();
    Eigen::MatrixXd K = J * J.transpose();
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) {
        const int a = rows_.row[i], b = rows_.row[j];
        K(i, j) = K(j, i) = a < 0 || b < 0 ? 0 : K(i, j) * alike(a, b);
      }
    return K;
  }

  Eigen::MatrixXd of(KernelDomain closeness) const {
    const auto n = static_cast<Eigen::Index>(rows_.row.size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) {
        const int a = rows_.row[i], b = rows_.row[j];
        if (a < 0 || b < 0) continue;
        const double alike = closeness == KernelDomain::time
                                 ? seen_by_tool(i).dot(seen_by_tool(j))
                                 : direction_.row(i).dot(direction_.row(j));
        K(i, j) = K(j, i) = alike == 0 ? 0 : alike * close(closeness, a, b);
      }
    return K;
  }

 private:
  bool repeats(int a, int b) const {
    return a == b || (!data_.repeat.empty() && data_.repeat[a] >= 0 &&
                      data_.repeat[a] == data_.repeat[b] && data_.set[a] == data_.set[b]);
  }

  /// The direction that an equation measures in, in the tool's axes.
  Eigen::Vector3d seen_by_tool(Eigen::Index equation) const {
    return ends_[static_cast<size_t>(rows_.row[equation])].linear().transpose() *
           direction_.row(equation).transpose();
  }

  static double bell(double squared) { return std::exp(-squared / 2); }

  /// Covariance of one function of one or two readings, the mean over all pairs of joints.
  double alike(int a, int b) const {
    double sum = 0, squares = 0;
    const Eigen::Index joints = alike_.cols();
    for (Eigen::Index j = 0; j < joints; ++j) {
      const double each = (1 + bell(std::pow((alike_(a, j) - alike_(b, j)) / kTurned, 2))) / 2;
      sum += each;
      squares += each * each;
    }
    const auto pairs = static_cast<double>(joints * (joints - 1));
    return pairs > 0 ? (sum * sum - squares) / pairs : sum;
  }

  double close(KernelDomain closeness, int a, int b) const {
    // Repeats that lie minutes apart are as far from each other as that: no closeness knows of
    // another one, or the covariance would be none.
    switch (closeness) {
      case KernelDomain::same:
        return repeats(a, b) ? 1 : 0;
      case KernelDomain::joints:
        return bell((alike_.row(a) - alike_.row(b)).squaredNorm() / (kJoints * kJoints));
      case KernelDomain::place:
        return bell((ends_[a].translation() - ends_[b].translation()).squaredNorm() /
                    (kPlace * kPlace));
      case KernelDomain::turned:
        return 0;  // of one joint: of_joint()
      case KernelDomain::time:
        if (!std::isfinite(data_.time[a] + data_.time[b])) return 0;
        return bell(std::pow((data_.time[a] - data_.time[b]) / (kTime * span_), 2));
    }
    return 0;
  }

  const Observations& data_;
  const DenseEquations& rows_;
  const std::vector<Eigen::Isometry3d>& ends_;
  const Eigen::MatrixXd by_joint_;
  const Eigen::MatrixXd& alike_;
  const std::vector<int> visit_;
  Eigen::MatrixXd direction_;
  double span_ = 0;
};

/// Its lower Cholesky factor.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance) {
  Eigen::MatrixXd root = cholesky_root(covariance);
  const Eigen::VectorXd missing = root.rowwise().squaredNorm() - covariance.diagonal();
  expects((missing.array().abs() <= 1e-6 * covariance.diagonal().array()).all(),
          "what rows share is a covariance");
  return root;
}

}  // namespace

std::string_view to_string(KernelDomain closeness) {
  switch (closeness) {
    case KernelDomain::same:
      return "configuration";
    case KernelDomain::joints:
      return "joint angles";
    case KernelDomain::place:
      return "place";
    case KernelDomain::time:
      return "time";
    case KernelDomain::turned:
      return "joint errors";
  }
  return "";
}

Eigen::VectorXd reading_steps(const Eigen::MatrixXd& q) {
  Eigen::VectorXd steps = Eigen::VectorXd::Zero(q.cols());
  for (Eigen::Index j = 0; j < q.cols(); ++j)
    for (double power = 1e-2; power > 0.9e-9 && steps[j] == 0; power /= 10)
      for (const double step : {5 * power, 2 * power, power}) {
        const Eigen::ArrayXd multiple = q.col(j).array() / step;
        if (((multiple - multiple.round()).abs() > 1e-3).any()) continue;
        steps[j] = step;
        break;
      }
  return steps;
}

Eigen::MatrixXd comparable_readings(const Robot& robot, Eigen::MatrixXd q) {
  for (Eigen::Index j = 0; j < q.cols(); ++j) {
    if (robot.joints()[static_cast<size_t>(j)].quantity == Quantity::angle) continue;
    const double moved = q.col(j).maxCoeff() - q.col(j).minCoeff();
    if (moved > 0) q.col(j) *= std::numbers::pi / moved;
  }
  return q;
}

std::vector<DiscrepancyCovariance> noise_alone(const Observations& data, const DenseEquations& rows,
                                               const Eigen::MatrixXd& by_joint, double of_visits) {
  const Kernel kernel(data, rows, {}, by_joint, data.q);
  return {{0, of_visits, root_of(kernel.noise(of_visits)), 1, 1}};
}

namespace {

/// Noise, and what a configuration's repeats share of it; where visits have a noise of their own,
/// all of that, half of it and none: some of what lies between two visits may have a cause.
void add_noise(const Kernel& kernel, double of_visits, std::vector<DiscrepancyCovariance>& list) {
  const Eigen::MatrixXd same = kernel.of(KernelDomain::same);
  for (const double share : kOfVisits) {
    const double visits = share * of_visits;
    const Eigen::MatrixXd noise = kernel.noise(visits);
    const double once = 1 + visits * visits;  // variance of one visit
    for (const auto& [kappa, probability] : kShared)
      list.push_back({0, std::sqrt(visits * visits + kappa * kappa * once),
                      root_of(noise + kappa * kappa * once * same), 1,
                      of_visits > 0 ? probability / std::size(kOfVisits) : probability});
    if (of_visits == 0) return;
  }
}

/// What no known effect explains, beside the noise.
void add_unknowns(const Kernel& kernel, double of_visits, Eigen::Index joints,
                  std::vector<DiscrepancyCovariance>& list) {
  const Eigen::MatrixXd noise = kernel.noise(of_visits);
  const double once = 1 + of_visits * of_visits;
  const Eigen::MatrixXd same = once * kernel.of(KernelDomain::same);
  const Eigen::MatrixXd usual = noise + kUsual * kUsual * same;
  for (const KernelDomain closeness :
       {KernelDomain::same, KernelDomain::joints, KernelDomain::place, KernelDomain::time}) {
    if (!kernel.possible(closeness)) continue;
    const bool alone = closeness == KernelDomain::same;
    const Eigen::MatrixXd K = once * kernel.of(closeness);
    const auto sizes = alone ? std::span<const double>(kMore) : std::span<const double>(kSizes);
    for (const double kappa : sizes)
      list.push_back({static_cast<int>(closeness), kappa,
                      root_of((alone ? noise : usual) + kappa * kappa * K), 1, 1});
  }
  for (Eigen::Index joint = 0; joint < joints; ++joint) {
    const Eigen::MatrixXd K = once * kernel.of_joint(joint);
    for (const double kappa : kOfJoint)
      list.push_back({static_cast<int>(KernelDomain::turned), kappa,
                      root_of(usual + kappa * kappa * K), 1, 1});
  }
}

}  // namespace

std::vector<DiscrepancyCovariance> structures(const Observations& data, const DenseEquations& rows,
                                              const std::vector<Eigen::Isometry3d>& ends,
                                              const Eigen::MatrixXd& by_joint,
                                              const Eigen::MatrixXd& alike, double of_visits) {
  const Kernel kernel(data, rows, ends, by_joint, alike);
  std::vector<DiscrepancyCovariance> list;
  add_noise(kernel, of_visits, list);
  add_unknowns(kernel, of_visits, by_joint.cols(), list);
  double unknown = 0;
  for (const DiscrepancyCovariance& each : list) unknown += each.kind > 0;
  for (DiscrepancyCovariance& each : list)
    if (each.kind > 0) each.probability = 1 / unknown;
  return list;
}

}  // namespace selfcal
