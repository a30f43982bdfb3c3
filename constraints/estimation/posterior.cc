// C = (W^T W + Lambda)^-1 over free unknowns x and considered ones p together. The estimate keeps p
// where it was given, while the rows put it d_p = (S / t + Lambda_p)^-1 W_p^T Delta Y / t from
// there (S: C_pp^-1 - Lambda_p; t: by how much the rows' errors are more than their noise and than
// p would explain, for structure speaks against anything), and has moved x to make up for that: it
// errs by C + d d^T, d = C_.p C_pp^-1 d_p. Where the rows agree with what was given d is nothing. A
// given place of a set may be off by a motion of it all: columns of the world's motions, of the
// rows of that set alone.
#include "constraints/estimation/posterior.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "constraints/identifiability/given_doubt.h"
#include "constraints/methods/plane.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr int kMotionColumns = 6;
constexpr double kExact = 1e-12;  ///< of the robot's size, or rad: of what is exact

/// A set whose place is given: the system of its rows, and 1 over the sigma of each motion of it.
struct GivenPlace {
  Eigen::VectorXd weight;
  Eigen::MatrixXd R;
};

/// W^T W of the columns asked for, and the precision that is known of each beforehand.
class Information {
 public:
  Information(const Equations& equations, const Adjusted& adjusted, const Eigen::MatrixXd& R)
      : equations_(equations), adjusted_(adjusted), R_(R) {
    for (const int c : free_columns(equations, adjusted.prior))
      add(c, prior_weight(equations, adjusted.prior, c));
    free_ = columns_.size();
  }

  /// Parameters of links and gears that are fixed. Where base and tool are put is then what they
  /// are called by.
  void add_fixed() {
    const auto& parameters = equations_.robot().parameters();
    for (int i = 0; i < equations_.robot_columns(); ++i) {
      const Parameter& p = parameters[static_cast<size_t>(i)];
      const bool held = adjusted_.candidate[i] && !adjusted_.prior.free[i];
      const double doubt = doubt_of_fixed(p);
      if (!adjusted_.prior.free[i] && !held && doubt > 0) add(i, 1 / doubt);
    }
  }

  void add_known() {
    const auto& sets = equations_.data().sets;
    for (int s = 0; s < static_cast<int>(sets.size()); ++s) {
      if (equations_.plan(s).items.empty()) continue;
      const std::vector<KnownLength> known = sets[s].method->known_lengths();
      const bool opposite = touched_from_other_side(s);
      for (size_t i = 0; i < known.size(); ++i) {
        const double sigma =
            std::hypot(doubt_of_length(sets[s], known[i], opposite), form_between(s));
        if (sigma > 0)
          add(static_cast<int>(R_.cols()) - 1 - equations_.known_lengths() +
                  equations_.known_at(s) + static_cast<int>(i),
              1 / sigma);
      }
      if (sets[s].method->place_known()) add_place(s);
    }
  }

  /// Of columns(); the one held for the scale with what follows it.
  Eigen::MatrixXd covariance(const Structure& structure) const {
    const auto n = static_cast<Eigen::Index>(columns_.size());
    const auto m = n + kMotionColumns * static_cast<Eigen::Index>(places_.size());
    const Eigen::MatrixXd T = triangle(m);
    const auto root = T.topLeftCorner(m, m);
    const Eigen::VectorXd off = spread_rows(given_off(T, structure));
    const Eigen::MatrixXd all = spread(inverse_of_square(root)) + off * off.transpose();
    if (adjusted_.scale < 0) return all;
    Eigen::VectorXd follow =
        spread_rows(-root.triangularView<Eigen::Upper>().solve(T.col(m).head(m)));
    follow[adjusted_.scale] = 1;
    return all + std::pow(adjusted_.scale_sigma, 2) * follow * follow.transpose();
  }

 private:
  /// Of a plane that is a known distance from another one, by a probe that has a size.
  bool touched_from_other_side(int set) const {
    const Set& of = equations_.data().sets[static_cast<size_t>(set)];
    return of.reference >= 0 && probe_radius(*of.method) > 0 &&
           mean_normal(set).dot(mean_normal(of.reference)) < 0;
  }

  /// What the surfaces of a length between two may be uneven by (m): what their rows scatter by
  /// beyond those of the quietest of its kind. It does not average out.
  double form_between(int set) const {
    const int reference = equations_.data().sets[static_cast<size_t>(set)].reference;
    return reference < 0 ? 0 : std::hypot(unevenness(set), unevenness(reference));
  }

  double unevenness(int set) const {
    const auto& sets = equations_.data().sets;
    const auto& left = adjusted_.fitted.noise.estimated;
    const auto of = static_cast<size_t>(set);
    double quietest = left[of].length;
    for (size_t s = 0; s < sets.size(); ++s)
      if (sets[s].method->touches() == sets[of].method->touches() &&
          !equations_.plan(static_cast<int>(s)).items.empty())
        quietest = std::min(quietest, left[s].length);
    const double quiet = std::max(quietest, equations_.stated(set).length);
    return std::sqrt(std::max(0.0, std::pow(left[of].length, 2) - std::pow(quiet, 2)));
  }

  Eigen::Vector3d mean_normal(int set) const {
    const Observations& rows = equations_.data().rows;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int row = 0; row < rows.rows(); ++row)
      if (rows.set[static_cast<size_t>(row)] == set) sum += rows.normal.row(row).transpose();
    return sum.normalized();
  }

  /// Triangular [W | w | Delta Y] of the rows and of all that is known beforehand, W of the `m`
  /// unknowns, w of the parameter that is held for the scale (zero without one).
  Eigen::MatrixXd triangle(Eigen::Index m) const {
    const auto n = static_cast<Eigen::Index>(columns_.size());
    const Eigen::MatrixXd others = places_.empty() ? R_ : rows_without_place();
    Eigen::Index rows = others.rows() + m;
    for (const GivenPlace& place : places_) rows += place.R.rows();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows, m + 2);
    Eigen::Index at = 0;
    const auto put = [&](const Eigen::MatrixXd& R, Eigen::Index motions) {
      auto of = A.middleRows(at, R.rows());
      of.leftCols(n) = R(Eigen::all, columns_);
      if (motions > 0)
        of.middleCols(motions, kMotionColumns) = R.middleCols(equations_.columns(), kMotionColumns);
      if (adjusted_.scale >= 0) of.col(m) = R.col(adjusted_.scale);
      of.col(m + 1) = R.rightCols<1>();
      at += R.rows();
    };
    put(others, 0);
    Eigen::Index motions = n;
    for (const GivenPlace& place : places_) {
      put(place.R, motions);
      A.block(rows - m + motions, motions, kMotionColumns, kMotionColumns) =
          place.weight.asDiagonal();
      motions += kMotionColumns;
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      const int c = columns_[static_cast<size_t>(i)];
      A(rows - m + i, i) = weights_[i];
      if (i < static_cast<Eigen::Index>(free_) && c < equations_.robot_columns())
        A(rows - m + i, m + 1) =
            weights_[i] * (adjusted_.prior.centre[c] - adjusted_.fitted.state.xi[c]);
    }
    triangularise(A);
    return A.topRows(m + 2);
  }

  /// The system of the rows of sets whose places are not given.
  Eigen::MatrixXd rows_without_place() const {
    Weighting rest{adjusted_.fitted.noise.used, adjusted_.fitted.noise.outlier};
    rest.passed_over = true;
    const Observations& rows = equations_.data().rows;
    for (int row = 0; row < rows.rows(); ++row)
      if (equations_.data().sets[rows.set[static_cast<size_t>(row)]].method->place_known())
        rest.outlier[static_cast<size_t>(row)] = 1;
    return equations_.linearise(adjusted_.fitted.state, rest, true).R;
  }

  /// The precision of what is considered beforehand.
  Eigen::VectorXd given_precision() const {
    const auto of_columns = static_cast<Eigen::Index>(columns_.size() - free_);
    Eigen::VectorXd known(of_columns + kMotionColumns * static_cast<Eigen::Index>(places_.size()));
    known.head(of_columns) = weights_.tail(of_columns).cwiseAbs2();
    Eigen::Index at = of_columns;
    for (const GivenPlace& place : places_) {
      known.segment(at, kMotionColumns) = place.weight.cwiseAbs2();
      at += kMotionColumns;
    }
    return known;
  }

  /// d of all unknowns. Below the free ones T has the root of C_pp^-1 and what the rows and they
  /// ask of p.
  Eigen::VectorXd given_off(const Eigen::MatrixXd& T, const Structure& structure) const {
    const Eigen::Index m = T.cols() - 2;
    const auto free = static_cast<Eigen::Index>(free_), k = m - free;
    Eigen::VectorXd d = Eigen::VectorXd::Zero(m);
    if (k == 0) return d;
    const Eigen::MatrixXd root = T.block(free, free, k, k).triangularView<Eigen::Upper>();
    const Eigen::MatrixXd precision = transposed_product(root, root);
    const Eigen::VectorXd unit = precision.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::VectorXd explained = T.col(m + 1).segment(free, k);
    const double left = 1 - explained.squaredNorm() / adjusted_.fitted.at.equations;
    const double t = std::max(structure.halves, structure.stated * left);
    Eigen::MatrixXd H = precision / t;
    H.diagonal() += (1 - 1 / t) * given_precision();
    const Eigen::VectorXd asked = root.transpose() * explained / t;
    d.tail(k) = unit.cwiseProduct(inverse_of_positive(unit.asDiagonal() * H * unit.asDiagonal()) *
                                  unit.cwiseProduct(asked));
    d.head(free) = -T.topLeftCorner(free, free)
                        .triangularView<Eigen::Upper>()
                        .solve(T.block(0, free, free, k) * d.tail(k));
    return d;
  }

  Eigen::VectorXd spread_rows(const Eigen::VectorXd& x) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(equations_.columns());
    for (size_t i = 0; i < columns_.size(); ++i)
      if (columns_[i] < all.size()) all[columns_[i]] = x[static_cast<Eigen::Index>(i)];
    return all;
  }

  void add(int column, double weight) {
    columns_.push_back(column);
    weights_.conservativeResize(weights_.size() + 1);
    weights_[weights_.size() - 1] = weight;
  }

  /// The system of the rows of one set alone: what a motion of it would look like beside the rest.
  void add_place(int set) {
    Weighting alone{adjusted_.fitted.noise.used, adjusted_.fitted.noise.outlier};
    alone.passed_over = true;
    const Observations& rows = equations_.data().rows;
    for (int row = 0; row < rows.rows(); ++row)
      if (rows.set[static_cast<size_t>(row)] != set) alone.outlier[static_cast<size_t>(row)] = 1;
    const Set& at = equations_.data().sets[static_cast<size_t>(set)];
    const double place = doubt_of_centre(at, distance(set)), turn = doubt_of_turn(at);
    GivenPlace given{Eigen::VectorXd(kMotionColumns),
                     equations_.linearise(adjusted_.fitted.state, alone, true).R};
    for (int i = 0; i < kMotionColumns; ++i) {
      given.weight[i] = i < 3 ? 1 / std::max(place, kExact * size_of(equations_.robot()))
                              : 1 / std::max(turn, kExact);
    }
    places_.push_back(std::move(given));
  }

  /// Of the endpoint from the world's origin, on average over the rows of a set.
  double distance(int set) const {
    const auto& items = equations_.plan(set).items;
    double sum = 0;
    for (const SetPlan::Item& item : items)
      sum += locate(equations_.robot(), adjusted_.fitted.state.xi,
                    equations_.data().rows.q.row(item.row).transpose())
                 .p.norm();
    return sum / static_cast<double>(items.size());
  }

  Eigen::MatrixXd spread(const Eigen::MatrixXd& C) const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(equations_.columns(), equations_.columns());
    for (size_t i = 0; i < columns_.size(); ++i)
      for (size_t j = 0; j < columns_.size(); ++j)
        if (columns_[i] < all.rows() && columns_[j] < all.rows())
          all(columns_[i], columns_[j]) =
              C(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    return all;
  }

  const Equations& equations_;
  const Adjusted& adjusted_;
  const Eigen::MatrixXd& R_;
  std::vector<int> columns_;
  std::size_t free_ = 0;  ///< so many of them are free, the others considered
  Eigen::VectorXd weights_;
  std::vector<GivenPlace> places_;
};

}  // namespace

Eigen::MatrixXd posterior(const Equations& equations, const Adjusted& adjusted,
                          const Eigen::MatrixXd& R, bool considered, const Structure& structure) {
  Information information(equations, adjusted, R);
  if (considered) {
    information.add_fixed();
    information.add_known();
  }
  return information.covariance(structure);
}

}  // namespace selfcal
