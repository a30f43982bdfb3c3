// With C = (WᵀW)^-1 of the chosen, a candidate w (k x m) changes the determinant by the factor
//   det(I + w C wᵀ) when added,   det(I - w C wᵀ) when removed,
// and C by  -+ G S^-1 Gᵀ,  G = C wᵀ,  S = I +- w G. Of every candidate only its w C wᵀ is kept, and
// updated by the same rule: an exchange costs m k² for each candidate.
#include "constraints/planning/detmax.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constraints/identifiability/observability.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

// Of the columns' mean square: lets a start that does not see everything be exchanged away.
constexpr double kRidge = 1e-10;
constexpr double kGain = 1e-9;  // a smaller gain of the determinant is rounding
constexpr int kAfresh = 50;     // exchanges after which C is made anew

class Search {
 public:
  Search(const std::vector<Eigen::MatrixXd>& candidates, int count, std::mt19937_64& random)
      : rows_(candidates), in_(candidates.size(), 0) {
    scale_columns();
    std::vector<int> order(candidates.size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    for (int i = 0; i < count; ++i) in_[order[i]] = 1;
  }

  int run() {
    for (int exchanges = 0;; ++exchanges) {
      if (exchanges % kAfresh == 0) start_afresh();
      const auto [added, gain] = best(+1);
      if (added < 0) return exchanges;
      change(added, +1);
      const auto [removed, loss] = best(-1);
      const bool better = gain * loss > 1 + kGain;
      change(better ? removed : added, -1);
      if (!better) return exchanges;
    }
  }

  std::vector<int> chosen() const {
    std::vector<int> list;
    for (size_t i = 0; i < in_.size(); ++i)
      if (in_[i]) list.push_back(static_cast<int>(i));
    return list;
  }

 private:
  /// Units of the columns do not change the order of determinants, but the rounding.
  void scale_columns() {
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(rows_.front().cols());
    for (const Eigen::MatrixXd& w : rows_) squares += w.colwise().squaredNorm().transpose();
    for (Eigen::MatrixXd& w : rows_)
      for (Eigen::Index c = 0; c < squares.size(); ++c)
        if (squares[c] > 0) w.col(c) /= std::sqrt(squares[c] / static_cast<double>(rows_.size()));
  }

  void start_afresh() {
    const Eigen::Index m = rows_.front().cols();
    Eigen::MatrixXd information = kRidge * Eigen::MatrixXd::Identity(m, m);
    for (const int i : chosen()) information += rows_[i].transpose() * rows_[i];
    C_ = inverse_of_positive(information);
    seen_.clear();
    for (const Eigen::MatrixXd& w : rows_) seen_.push_back(w * C_ * w.transpose());
  }

  /// The candidate outside whose addition (+1), or inside whose removal (-1), leaves the largest
  /// determinant, and the factor by which it changes; -1 without one.
  std::pair<int, double> best(double sign) const {
    std::pair<int, double> best{-1, 0};
    for (size_t i = 0; i < rows_.size(); ++i) {
      if (in_[i] == (sign > 0)) continue;
      const double factor = changed(i, sign).determinant();
      if (best.first < 0 || factor > best.second) best = {static_cast<int>(i), factor};
    }
    return best;
  }

  Eigen::MatrixXd changed(size_t i, double sign) const {
    return Eigen::MatrixXd::Identity(seen_[i].rows(), seen_[i].cols()) + sign * seen_[i];
  }

  void change(int which, double sign) {
    const Eigen::MatrixXd G = C_ * rows_[which].transpose();
    const Eigen::MatrixXd root = solve_lower(cholesky_root(changed(which, sign)), G.transpose());
    C_ -= sign * root.transpose() * root;
    for (size_t i = 0; i < rows_.size(); ++i) {
      const Eigen::MatrixXd by = root * rows_[i].transpose();
      seen_[i] -= sign * by.transpose() * by;
    }
    in_[which] = sign > 0;
  }

  std::vector<Eigen::MatrixXd> rows_;  ///< columns of mean square 1
  std::vector<char> in_;
  Eigen::MatrixXd C_;
  std::vector<Eigen::MatrixXd> seen_;  ///< w C wᵀ
};

}  // namespace

Exchange detmax(const std::vector<Eigen::MatrixXd>& candidates, int count,
                std::mt19937_64& random) {
  Search search(candidates, count, random);
  Exchange result;
  result.exchanges = search.run();
  result.chosen = search.chosen();
  Eigen::Index at = 0;
  for (const int i : result.chosen) at += candidates[i].rows();
  Eigen::MatrixXd W(at, candidates.front().cols());
  at = 0;
  for (const int i : result.chosen) {
    W.middleRows(at, candidates[i].rows()) = candidates[i];
    at += candidates[i].rows();
  }
  if (W.rows() >= W.cols()) result.o1 = observability(W, count).o1;
  return result;
}

}  // namespace selfcal
