// Every given length D is tried with an error e of its own: D - e in its place. With the unknowns x
// eliminated from [W | K | Delta Y], K the columns of the errors, what is left is B e = c, and
//   e_k alone     b_k . c / |b_k|^2,  sigma 1 / |b_k|:   D_k against all else (Baarda's test)
//   all e free    B^-1 c:                                what is expected where none is given
//   e = D epsilon one for all:                           their excess over the maker's lengths
// The maker's lengths speak through the priors: links of tolerance t say the scale to
// (sum (nominal / t)^2)^-1/2. These are the maker's own tolerances, wider only where the robot's
// shape alone, no length being given, is beyond them.
#include "constraints/estimation/robot_scale.h"

#include <algorithm>
#include <cmath>

#include "constraints/estimation/shrinkage.h"
#include "constraints/fitting/instrument_scale.h"
#include "constraints/identifiability/gauge.h"
#include "constraints/statistics.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

/// A healthy robot is doubted once in so many times, all tests together.
constexpr double kFalseAlarm = 0.01;
/// A length of N that carries less of the scale than this over N is no matter of it.
constexpr double kLeastShare = 0.05;

/// [W | K | Delta Y] and the priors' rows, triangular: the unknowns' part and what it leaves.
struct Eliminated {
  Eigen::MatrixXd x, x_known;  ///< of the unknowns: their own columns and those of the errors
  Eigen::VectorXd x_right;
  Eigen::MatrixXd B;
  Eigen::VectorXd c;
};

class ScaleTest {
 public:
  ScaleTest(const Equations& equations, const Adjusted& adjusted, Eigen::MatrixXd R,
            Eigen::MatrixXd weight)
      : equations_(equations),
        adjusted_(adjusted),
        R_(std::move(R)),
        weight_(std::move(weight)),
        prior_(as_the_maker_says(equations.robot(), adjusted)),
        columns_(free_columns(equations, prior_)) {}

  ScaleJudgement run() {
    compare_instrument();
    find_lengths();
    if (lengths().empty()) return std::move(result_);
    if (!reads_lengths()) leave_scale_to_lengths();
    Eliminated at = eliminated();
    const double widening = shape_widening(at);
    for (size_t i = 0; widening > 1 && i < equations_.robot().parameters().size(); ++i)
      if (is_own(equations_.robot().parameters()[i])) prior_.sigma[i] *= widening;
    if (widening > 1) at = eliminated();
    expect(at);
    compare_with_maker(at);
    if (lengths().size() > 1) compare_with_others(at);
    const double least = kLeastShare / static_cast<double>(lengths().size());
    const bool elsewhere = adjusted_.prior.free != prior_.free;  // on the length that is not free
    std::erase_if(lengths(), [&](const ScaleLength& each) {
      return elsewhere || std::abs(each.share) < least;
    });
    return std::move(result_);
  }

 private:
  /// Lengths that are held or fixed are free here, within their tolerance: so much they may be off.
  static Prior as_the_maker_says(const Robot& robot, const Adjusted& adjusted) {
    Prior prior = adjusted.prior;
    for (size_t i = 0; i < robot.parameters().size(); ++i) {
      const Parameter& p = robot.parameters()[i];
      if (is_own(p)) prior.sigma[static_cast<Eigen::Index>(i)] = p.tolerance;
      if (p.link_length) prior.free[i] = 1;
    }
    return prior;
  }

  std::vector<ScaleLength>& lengths() { return result_.scale.stands_on; }

  /// The given lengths that rows speak of; the place of a known plane where it carries the scale.
  void find_lengths() {
    const auto& sets = equations_.data().sets;
    for (int s = 0; s < static_cast<int>(sets.size()); ++s) {
      if (equations_.plan(s).items.empty()) continue;
      const std::vector<KnownLength> known = sets[s].method->known_lengths();
      for (size_t i = 0; i < known.size(); ++i) {
        const int column = static_cast<int>(R_.cols()) - 1 - equations_.known_lengths() +
                           equations_.known_at(s) + static_cast<int>(i);
        if (!(known[i].value > 0) || R_.col(column).isZero(0)) continue;
        known_.push_back(column);
        place_.push_back(sets[s].method->touches() == TouchedSurface::plane && known[i].by_row);
        lengths().push_back({sets[s].name, known[i].what, known[i].value, known[i].sigma});
      }
    }
    if (known_.empty()) return;
    const Eliminated at = eliminated();
    std::vector<int> kept;
    std::vector<ScaleLength> carrying;
    for (size_t k = 0; k < known_.size(); ++k) {
      const Eigen::VectorXd follows = follow(at, static_cast<Eigen::Index>(k));
      ScaleLength& length = lengths()[k];
      length.share = length.value * growth(equations_.robot(), prior_.free, follows);
      const double carried = std::abs(length.share) * static_cast<double>(known_.size());
      if (place_[k] && carried < kLeastShare) continue;
      length.moves = end_position(follows);
      kept.push_back(known_[k]);
      carrying.push_back(length);
      follows_.push_back(follows);
    }
    known_ = kept;
    lengths() = carrying;
  }

  /// Touches say nothing of the scale: that what they leave shrinks with the robot is no evidence
  /// of a smaller one. What the rows say of all given lengths changed alike is taken out of R_.
  void leave_scale_to_lengths() {
    const Eliminated at = eliminated();
    Eigen::VectorXd x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(columns_.size()));
    Eigen::VectorXd rows = Eigen::VectorXd::Zero(R_.rows());
    double shares = 0;
    for (size_t k = 0; k < known_.size(); ++k) {
      const ScaleLength& length = lengths()[k];
      x += length.value *
           at.x.triangularView<Eigen::Upper>().solve(at.x_known.col(static_cast<Eigen::Index>(k)));
      rows += length.value * R_.col(known_[k]);
      shares += length.share;
    }
    rows -= R_(Eigen::all, columns_) * x;
    for (size_t k = 0; k < known_.size(); ++k)
      R_.col(known_[k]) -= lengths()[k].share / shares / lengths()[k].value * rows;
  }

  Eliminated eliminated() const {
    const auto n = static_cast<Eigen::Index>(columns_.size()), K = R_.rows();
    const auto m = static_cast<Eigen::Index>(known_.size());
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(K + n, n + m + 1);
    A.topRows(K) << R_(Eigen::all, columns_), R_(Eigen::all, known_), R_.rightCols(1);
    for (Eigen::Index i = 0; i < n; ++i) {
      const int column = columns_[i];
      A(K + i, i) = prior_weight(equations_, prior_, column);
      if (column < equations_.robot_columns())
        A(K + i, n + m) = A(K + i, i) * (prior_.centre[column] - adjusted_.fitted.state.xi[column]);
    }
    triangularise(A);
    return {A.topLeftCorner(n, n), A.block(0, n, n, m), A.col(n + m).head(n), A.block(n, n, m, m),
            A.col(n + m).segment(n, m)};
  }

  Eigen::VectorXd spread(const Eigen::VectorXd& of_free) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(equations_.columns());
    for (size_t i = 0; i < columns_.size(); ++i)
      all[columns_[i]] = of_free[static_cast<Eigen::Index>(i)];
    return all;
  }

  /// How the unknowns follow the length, one of it for one.
  Eigen::VectorXd follow(const Eliminated& at, Eigen::Index k) const {
    return spread(at.x.triangularView<Eigen::Upper>().solve(at.x_known.col(k)));
  }

  double end_position(const Eigen::VectorXd& step) const {
    const Eigen::VectorXd moved = step.head(equations_.robot_columns());
    return endpoint_rms(weight_, moved * moved.transpose());
  }

  /// By how much the robot's shape, no length being given, is beyond the maker's tolerances: the
  /// test of the priors, which the contradiction of a length must not widen for itself.
  double shape_widening(const Eliminated& at) const {
    const Eigen::MatrixXd x = inverse_of_triangle(at.x);
    const Eigen::MatrixXd by_errors = x * at.x_known * inverse_of_triangle(at.B);
    const Eigen::VectorXd e = at.B.triangularView<Eigen::Upper>().solve(at.c);
    const Eigen::VectorXd step = x * (at.x_right - at.x_known * e);
    const Eigen::VectorXd variance = x.rowwise().squaredNorm() + by_errors.rowwise().squaredNorm();
    return widening(
        prior_chi2(equations_.robot(), prior_,
                   adjusted_.fitted.state.xi + spread(step).head(equations_.robot_columns()),
                   spread(variance)));
  }

  void expect(const Eliminated& at) {
    const Eigen::VectorXd e = at.B.triangularView<Eigen::Upper>().solve(at.c);
    const Eigen::VectorXd sigma = inverse_of_triangle(at.B).rowwise().norm();
    for (size_t k = 0; k < lengths().size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      lengths()[k].expected = lengths()[k].value - e[i];
      lengths()[k].expected_sigma = sigma[i];
    }
  }

  void compare_with_maker(const Eliminated& at) {
    const auto m = static_cast<double>(lengths().size());
    Eigen::VectorXd D(at.c.size());
    for (Eigen::Index k = 0; k < D.size(); ++k) D[k] = lengths()[k].value;
    const Eigen::VectorXd b = at.B * D;
    RobotScale& scale = result_.scale;
    scale.excess_sigma = 1 / b.norm();
    scale.excess = b.dot(at.c) / b.squaredNorm();
    const double most = chi_quantile(1, 1 - (m > 1 ? kFalseAlarm / 2 : kFalseAlarm));
    for (ScaleLength& each : lengths()) each.unseen = most * scale.excess_sigma * each.value;
    const double sigmas = std::abs(scale.excess) / scale.excess_sigma;
    if (!(sigmas > most)) return;
    scale.against_maker = !reads_lengths();
    scale.contradictions.push_back(in_words(sigmas));
    Eigen::VectorXd doubt = Eigen::VectorXd::Zero(equations_.columns());
    for (size_t k = 0; k < lengths().size(); ++k)
      doubt += scale.excess * lengths()[k].value * follows_[k];
    result_.doubts.push_back(doubt);
  }

  /// What is measured is all of another size than the maker says.
  void compare_instrument() {
    const auto found = instrument_scale(equations_, prior_, adjusted_.fitted.state.xi, R_);
    if (!found || !found->beyond()) return;
    result_.scale.against_maker = true;
    result_.scale.contradictions.push_back(
        with_figures("the robot is measured %.2g %%", 100 * std::abs(found->excess)) +
        (found->excess > 0 ? " larger" : " smaller") +
        with_figures(" all over than the maker's lengths say, which tell the scale to %.2g %% "
                     "(%.2g sigma): check the instrument's scale, its units and its correction for "
                     "the temperature, or the lengths in the robot's file",
                     100 * found->sigma, std::abs(found->excess) / found->sigma));
  }

  std::string in_words(double sigmas) {
    const RobotScale& scale = result_.scale;
    const auto m = static_cast<double>(lengths().size());
    const ScaleLength& one = lengths().front();
    return (m == 1 ? one.what + " of set " + one.set +
                         with_figures(" is given as %.6g mm, ", 1e3 * one.value)
                   : with_figures("the %.0f lengths given are ", m)) +
           with_figures("%.2g %%", 100 * std::abs(scale.excess)) +
           (scale.excess > 0 ? " more" : " less") + " than the maker's lengths " +
           (reads_lengths()                  ? "and the other rows "
            : has_slides(equations_.robot()) ? "and the readings of its slides "
                                             : "") +
           with_figures("say, which tell the scale to %.2g %% (%.2g sigma): ",
                        100 * scale.excess_sigma, sigmas) +
           "check the length given and the lengths in the robot's file";
  }

  /// Where an instrument reads lengths, too, a length given does not carry the robot alone.
  bool reads_lengths() const {
    const auto& sets = equations_.data().sets;
    for (size_t s = 0; s < sets.size(); ++s)
      if (!equations_.plan(static_cast<int>(s)).items.empty() &&
          !sets[s].method->may_leave_scale_free())
        return true;
    return false;
  }

  /// Each against the others and the maker's lengths; the one that is contradicted most is named.
  void compare_with_others(const Eliminated& at) {
    const auto m = static_cast<double>(lengths().size());
    const double most = chi_quantile(1, 1 - kFalseAlarm / 2 / m);
    size_t worst = 0;
    double worst_sigmas = 0;
    for (size_t k = 0; k < lengths().size(); ++k) {
      const auto b = at.B.col(static_cast<Eigen::Index>(k));
      const double error = b.dot(at.c) / b.squaredNorm();
      lengths()[k].by_others = lengths()[k].value - error;
      lengths()[k].by_others_sigma = 1 / b.norm();
      lengths()[k].unseen = most * lengths()[k].by_others_sigma;
      if (std::abs(error) * b.norm() <= worst_sigmas) continue;
      worst = k;
      worst_sigmas = std::abs(error) * b.norm();
    }
    if (!(worst_sigmas > most)) return;
    ScaleLength& odd = lengths()[worst];
    odd.odd = true;
    result_.scale.contradictions.push_back(
        odd.what + " of set " + odd.set +
        with_figures(
            " is given as %.6g mm, where the other lengths given and the maker's say %.6g mm "
            "(%.2g sigma); the maker's alone say %.6g",
            1e3 * odd.value, 1e3 * odd.by_others, worst_sigmas, 1e3 * odd.expected) +
        with_figures(" +- %.2g mm", 1e3 * odd.expected_sigma));
    result_.doubts.emplace_back((odd.value - odd.by_others) * follows_[worst]);
  }

  const Equations& equations_;
  const Adjusted& adjusted_;
  Eigen::MatrixXd R_;       ///< of [W | K | Delta Y]
  Eigen::MatrixXd weight_;  ///< of the end position
  Prior prior_;             ///< with the maker's own tolerances
  std::vector<int> columns_;
  std::vector<int> known_;   ///< columns of R_, by length
  std::vector<char> place_;  ///< by length found: the distance of a known plane from the origin
  std::vector<Eigen::VectorXd> follows_;
  ScaleJudgement result_;
};

}  // namespace

ScaleJudgement judge_scale(const Equations& equations, const Adjusted& adjusted,
                           const Eigen::MatrixXd& R, const Eigen::MatrixXd& weight) {
  if (!adjusted.prior.use) return {};
  return ScaleTest(equations, adjusted, R, weight).run();
}

}  // namespace selfcal
