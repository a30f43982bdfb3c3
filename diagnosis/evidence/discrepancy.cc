// Covariance of two equations: that of their configurations, a Gaussian bell of the distance, times
// the cosine between the directions that they measure in. A row's only equation, where no shift of
// the world changes it (a distance), has the direction of its set; of the angles of a pose none is
// another's. What comes and goes in time jumps or wanders: it is as alike as exp(-|t1 - t2| / span)
// says, as the tool sees it, or as a motion of the base would have it,
//   d1 . d2 + (c1 x d1) . (c2 x d2),   c from the middle of all places, over the robot's size.
// Errors of one joint: joint_kernels.h.
#include "diagnosis/evidence/discrepancy.h"

#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <span>

#include "diagnosis/constants.h"
#include "diagnosis/evidence/rows.h"
#include "diagnosis/evidence/visits.h"

namespace selfcal {
namespace {

class Kernel {
 public:
  Kernel(const Observations& data, const DenseEquations& rows,
         const std::vector<Eigen::Isometry3d>& ends, double size, const JointErrors& joints)
      : data_(data),
        rows_(rows),
        ends_(ends),
        near_(kDiagnosis.structure.place * size),
        readings_(joints.readings),
        alike_(joints.alike),
        places_(rows.row),
        visit_(visits(data)) {
    std::vector<double> times;  // a row need not have one
    std::ranges::copy_if(data.time, std::back_inserter(times),
                         [](double t) { return std::isfinite(t); });
    if (!times.empty()) span_ = std::ranges::max(times) - std::ranges::min(times);
    number();
    find_directions();
  }

  bool possible(KernelDomain domain) const {
    if (domain == KernelDomain::base) return span_ > 0 && !direction_.leftCols<3>().isZero();
    return domain != KernelDomain::time || span_ > 0;
  }

  /// Noise of one, of so much of the visits' own, of the readings' rounding, and of variance `same`
  /// that a configuration brings along.
  std::shared_ptr<const NoiseBlocks> noise(double of_visits, double same) const {
    const Eigen::MatrixXd rounding = readings_.by_joint * (readings_.steps / 2).asDiagonal();
    return std::make_shared<const NoiseBlocks>(blocks_, [&](int i, int j) {
      const double alone = i == j ? 1 : 0;
      const int a = rows_.row[i], b = rows_.row[j];
      if (a < 0 || b < 0) return alone;
      double shared = 0;
      for (Eigen::Index k = 0; k < rounding.cols(); ++k)
        if (data_.q(a, k) == data_.q(b, k)) shared += rounding(i, k) * rounding(j, k);
      const double alike = direction_.row(i).dot(direction_.row(j));
      // Uniform within half a digit either way.
      return alone + shared / 3 + alike * same +
             (visit_[a] == visit_[b] ? of_visits * of_visits * alike : 0);
    });
  }

  Eigen::MatrixXd of(KernelDomain domain) const {
    const auto n = static_cast<Eigen::Index>(rows_.row.size());
    const auto used = static_cast<Eigen::Index>(places_.rows.size());
    Eigen::MatrixXd near(used, used);
    for (Eigen::Index i = 0; i < used; ++i)
      for (Eigen::Index j = 0; j <= i; ++j)
        near(i, j) = near(j, i) = close(domain, places_.rows[i], places_.rows[j]);
    Eigen::MatrixXd directions = direction_;
    if (domain == KernelDomain::base) directions = motions_of_base();
    if (domain == KernelDomain::time)
      for (Eigen::Index i = 0; i < n; ++i)
        if (rows_.row[i] >= 0) directions.row(i).head<3>() = seen_by_tool(i).transpose();
    Eigen::MatrixXd K = directions * directions.transpose();
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index i = 0; i < n; ++i)
        K(i, j) *= places_.of[i] < 0 || places_.of[j] < 0 ? 0 : near(places_.of[i], places_.of[j]);
    return K;
  }

 private:
  /// The equations of each configuration.
  void number() {
    const std::vector<int> configuration = configurations(data_);
    std::map<std::pair<int, int>, int> block;  // of a configuration, or of an equation of no row
    for (int i = 0; i < static_cast<int>(rows_.row.size()); ++i) {
      const int row = rows_.row[i];
      const std::pair<int, int> key =
          row < 0 ? std::pair(-1, i) : std::pair(configuration[row], -1);
      const auto [at, first] = block.try_emplace(key, static_cast<int>(blocks_.size()));
      if (first) blocks_.emplace_back();
      blocks_[at->second].push_back(i);
    }
  }

  /// The directions that equations measure in, in the world's axes, with one more for each set:
  /// that of rows of one equation that no shift changes.
  void find_directions() {
    const Eigen::Index n = rows_.shift.rows();
    std::vector<int> equations(places_.rows.empty() ? 0 : 1 + std::ranges::max(places_.rows));
    for (const int row : rows_.row)
      if (row >= 0) ++equations[row];
    const int sets = data_.set.empty() ? 0 : 1 + std::ranges::max(data_.set);
    direction_.setZero(n, 3 + sets);
    for (Eigen::Index i = 0; i < n; ++i) {
      const int row = rows_.row[i];
      if (const double norm = rows_.shift.row(i).norm(); norm > 0)
        direction_.row(i).head<3>() = rows_.shift.row(i) / norm;
      else if (row >= 0 && equations[row] == 1)
        direction_(i, 3 + data_.set[row]) = 1;
    }
  }

  /// The direction that an equation measures in, in the tool's axes.
  Eigen::Vector3d seen_by_tool(Eigen::Index equation) const {
    return ends_[static_cast<size_t>(rows_.row[equation])].linear().transpose() *
           direction_.row(equation).head<3>().transpose();
  }

  /// What small motions of the base make of every equation, of mean square 1.
  Eigen::MatrixXd motions_of_base() const {
    const auto place = [&](Eigen::Index i) -> Eigen::Vector3d {
      const int row = rows_.row[static_cast<size_t>(i)];
      return row < 0 ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                     : Eigen::Vector3d(ends_[static_cast<size_t>(row)].translation());
    };
    const Eigen::Index n = direction_.rows();
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < n; ++i) middle += place(i) / static_cast<double>(n);
    const double size = near_ / kDiagnosis.structure.place;
    Eigen::MatrixXd motions(n, 6);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Vector3d d = direction_.row(i).head<3>().transpose();
      motions.row(i) << d.transpose(), ((place(i) - middle) / size).cross(d).transpose();
    }
    return motions / std::sqrt(motions.rowwise().squaredNorm().mean());
  }

  static double bell(double squared) { return std::exp(-squared / 2); }

  double close(KernelDomain domain, int a, int b) const {
    // Repeats that lie minutes apart are as far from each other as that: no kernel knows of
    // another one, or the covariance would be none.
    switch (domain) {
      case KernelDomain::joints:
        return bell((alike_.row(a) - alike_.row(b)).squaredNorm() /
                    (kDiagnosis.structure.joints * kDiagnosis.structure.joints));
      case KernelDomain::place:
        return bell((ends_[a].translation() - ends_[b].translation()).squaredNorm() /
                    (near_ * near_));
      case KernelDomain::same:    // noise()
      case KernelDomain::turned:  // and joint_kernels()
      case KernelDomain::kinked:
      case KernelDomain::load:
      case KernelDomain::warmth:
        return 0;
      case KernelDomain::time:
      case KernelDomain::base:
        if (!std::isfinite(data_.time[a] + data_.time[b])) return 0;
        return std::exp(-std::abs(data_.time[a] - data_.time[b]) /
                        (kDiagnosis.structure.time * span_));
    }
    return 0;
  }

  const Observations& data_;
  const DenseEquations& rows_;
  const std::vector<Eigen::Isometry3d>& ends_;
  const double near_;  ///< m, over which places are alike
  const ReadingErrors& readings_;
  const Eigen::MatrixXd& alike_;
  const RowPlaces places_;
  const std::vector<int> visit_;
  Eigen::MatrixXd direction_;
  double span_ = 0;
  std::vector<std::vector<int>> blocks_;  ///< equations of each configuration
};

}  // namespace

std::vector<DiscrepancyCovariance> noise_alone(const Observations& data, const DenseEquations& rows,
                                               const ReadingErrors& readings, double of_visits) {
  const JointErrors joints{readings, data.q};
  const Kernel kernel(data, rows, {}, 1, joints);
  return {{.kappa = of_visits, .blocks = kernel.noise(of_visits, 0)}};
}

namespace {

/// Noise, and what a configuration's repeats share of it; where visits have a noise of their own,
/// all of that, half of it and none: some of what lies between two visits may have a cause.
void add_noise(const Kernel& kernel, double of_visits, std::vector<DiscrepancyCovariance>& list) {
  for (const double share : kDiagnosis.structure.of_visits) {
    const double visits = share * of_visits;
    const double once = 1 + visits * visits;  // variance of one visit
    for (const auto& [kappa, probability] : kDiagnosis.structure.shared)
      list.push_back({.kappa = std::sqrt(visits * visits + kappa * kappa * once),
                      .blocks = kernel.noise(visits, kappa * kappa * once),
                      .probability = of_visits > 0
                                         ? probability / std::size(kDiagnosis.structure.of_visits)
                                         : probability});
    if (of_visits == 0) return;
  }
}

/// As `like`, with this kernel, of several sizes.
void add_kernel(DiscrepancyCovariance like, KernelBasis basis, std::span<const double> sizes,
                std::vector<DiscrepancyCovariance>& list) {
  like.kernel = std::make_shared<const KernelBasis>(std::move(basis));
  for (const double kappa : sizes) {
    like.kappa = kappa;
    list.push_back(like);
  }
}

/// What no known effect explains, beside the noise.
void add_unknowns(const Kernel& kernel, double of_visits, const std::vector<JointKernel>& of_joints,
                  std::vector<DiscrepancyCovariance>& list) {
  const double once = 1 + of_visits * of_visits;
  for (const double kappa : kDiagnosis.structure.more)
    list.push_back({.kind = static_cast<int>(KernelDomain::same),
                    .kappa = kappa,
                    .blocks = kernel.noise(of_visits, kappa * kappa * once)});
  const auto usual =
      kernel.noise(of_visits, kDiagnosis.structure.usual * kDiagnosis.structure.usual * once);
  for (const KernelDomain domain :
       {KernelDomain::joints, KernelDomain::place, KernelDomain::time, KernelDomain::base})
    if (kernel.possible(domain))
      add_kernel({.kind = static_cast<int>(domain), .blocks = usual},
                 basis_of_kernel(*usual, once * kernel.of(domain)), kDiagnosis.structure.smooth,
                 list);
  for (const JointKernel& each : of_joints)
    add_kernel({.kind = static_cast<int>(each.domain), .joint = each.joint, .blocks = usual},
               basis_of_root(*usual, std::sqrt(once) * each.root), kDiagnosis.structure.of_joint,
               list);
}

}  // namespace

std::vector<DiscrepancyCovariance> structures(const Observations& data, const DenseEquations& rows,
                                              const std::vector<Eigen::Isometry3d>& ends,
                                              double size, const JointErrors& joints,
                                              double of_visits) {
  const Kernel kernel(data, rows, ends, size, joints);
  std::vector<DiscrepancyCovariance> list;
  add_noise(kernel, of_visits, list);
  add_unknowns(kernel, of_visits, joint_kernels(data, rows, joints), list);
  double unknown = 0;
  for (const DiscrepancyCovariance& each : list) unknown += each.kind > 0;
  for (DiscrepancyCovariance& each : list)
    if (each.kind > 0) each.probability = 1 / unknown;
  return list;
}

}  // namespace selfcal
