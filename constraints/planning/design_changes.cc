// What adding, removing or exchanging a candidate makes of a design, by Woodbury's rule.
#include <algorithm>
#include <cmath>
#include <limits>

#include "constraints/methods/method.h"
#include "constraints/planning/design.h"
#include "kinematics/expects.h"
#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr std::size_t kJudged = 16;  // changes judged exactly of those that are best to first order
// A removal that leaves a smaller part of the determinant rounds too much to go on from.
constexpr double kLeastRemoved = 1e-5;
constexpr double kNever = -std::numeric_limits<double>::infinity();

using Small =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostEquations, kMostEquations>;

/// I + sign B of the k x k block B at row `at`.
Small raised(const Eigen::MatrixXd& blocks, Eigen::Index at, Eigen::Index k, int sign) {
  Small S = sign * blocks.block(at, 0, k, k);
  S.diagonal().array() += 1;
  return S;
}

double determinant(const Small& S) {
  switch (S.rows()) {
    case 1:
      return S(0, 0);
    case 2:
      return S(0, 0) * S(1, 1) - S(0, 1) * S(1, 0);
    case 3:
      return S.topLeftCorner<3, 3>().determinant();
    default:
      return S.determinant();
  }
}

/// trace(S^-1 B) of positive definite S.
double trace_of_quotient(const Small& S, const Eigen::MatrixXd& blocks, Eigen::Index at) {
  const Eigen::Index k = S.rows();
  if (k == 1) return blocks(at, 0) / S(0, 0);
  if (k == 3) return (S.topLeftCorner<3, 3>().inverse() * blocks.block<3, 3>(at, 0)).trace();
  const Small B = blocks.block(at, 0, k, k);
  return Small(S.llt().solve(B)).trace();
}

double log_or_never(double value) { return value > 0 ? std::log(value) : kNever; }

}  // namespace

Design::Rise Design::rise_of(const Eigen::MatrixXd& C, const Eigen::MatrixXd& w, int sign) {
  const Eigen::MatrixXd G = C * w.transpose();
  const Eigen::MatrixXd S = Eigen::MatrixXd::Identity(w.rows(), w.rows()) + sign * (w * G);
  const Eigen::MatrixXd L = cholesky_root(S);
  return {solve_lower(L, G.transpose()).transpose(), 2 * L.diagonal().array().log().sum()};
}

double Design::merit_after(std::size_t i, int sign) const {
  if (widest_ == 1 && objective_.criterion == Criterion::sigma) {
    const double left = 1 + sign * all_.seen(at_[i], 0);
    return left > 0 ? -trace_ + sign * spread_(at_[i], 0) / left : kNever;
  }
  const Small S = raised(all_.seen, at_[i], k_[i], sign);
  const double factor = determinant(S);
  if (!(factor > 0)) return kNever;
  if (objective_.criterion == Criterion::sigma)
    return -trace_ + sign * trace_of_quotient(S, spread_, at_[i]);
  // Logarithms are taken of the best alone.
  return objective_.nuisance > 0 ? factor / determinant(raised(nuisance_.seen, at_[i], k_[i], sign))
                                 : factor;
}

double Design::merit_without(int candidate) const {
  expects(objective_.criterion == Criterion::sigma && has(candidate), "a chosen one, by sigma");
  return merit_after(static_cast<std::size_t>(candidate), -1);
}

std::pair<int, double> Design::best(int sign, int kind) const {
  if (is_spectral(objective_.criterion)) return best_by_spectrum(sign, kind);
  std::pair<int, double> best{-1, kNever};
  for (std::size_t i = 0; i < in_.size(); ++i) {
    if (!may(i, sign, kind)) continue;
    const double merit = merit_after(i, sign);
    if (best.first < 0 || merit > best.second) best = {static_cast<int>(i), merit};
  }
  if (objective_.criterion == Criterion::o1 && best.first >= 0)
    best.second = log_determinant_ + log_or_never(best.second);
  return best;
}

std::pair<int, double> Design::best_by_spectrum(int sign, int kind) const {
  const Eigen::Index a = interest();
  const Eigen::VectorXd unit = scale_.head(a).cwiseInverse();
  const Symmetric eigen =
      symmetric_eigen(unit.asDiagonal() * all_.C.topLeftCorner(a, a) * unit.asDiagonal());
  Eigen::VectorXd slope;
  spectral_merit(objective_.criterion, eigen.values, &slope);
  const Eigen::MatrixXd turned = W_ * (all_.C.leftCols(a) * (unit.asDiagonal() * eigen.vectors));
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < in_.size(); ++i) {
    if (!may(i, sign, kind)) continue;
    const Small S = raised(all_.seen, at_[i], k_[i], sign);
    if (!(determinant(S) > 0)) continue;
    const auto t = turned.middleRows(at_[i], k_[i]);
    const Small B = t * slope.asDiagonal() * t.transpose();
    order.emplace_back(sign * Small(S.llt().solve(B)).trace(), i);
  }
  const std::size_t judged = std::min(kJudged, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(judged),
                    order.end());
  std::pair<int, double> best{-1, kNever};
  for (std::size_t n = 0; n < judged; ++n) {
    const std::size_t i = order[n].second;
    const Eigen::MatrixXd U = rise_of(all_.C, rows_of(i), sign).U;
    const double merit = merit_of_spectrum(all_.C - sign * U * U.transpose());
    if (best.first < 0 || merit > best.second) best = {static_cast<int>(i), merit};
  }
  return best;
}

void Design::update(Moments& at, const Stretch& these, const Rise& rise, const Eigen::MatrixXd& by,
                    int sign) const {
  at.C -= sign * rise.U * rise.U.transpose();
  const Eigen::Index first = at_[these.first];
  if (widest_ == 1) {
    at.seen.col(0).segment(first, by.rows()) -= sign * by.rowwise().squaredNorm();
    return;
  }
  for (std::size_t i = these.first; i < these.end; ++i)
    if (k_[i] == 3 && by.cols() == 3) {
      const Eigen::Matrix3d mine = by.block<3, 3>(at_[i] - first, 0);
      at.seen.block<3, 3>(at_[i], 0) -= sign * (mine * mine.transpose());
    } else {
      const auto mine = by.middleRows(at_[i] - first, k_[i]);
      at.seen.block(at_[i], 0, k_[i], k_[i]).noalias() -= sign * mine.lazyProduct(mine.transpose());
    }
}

void Design::change(int candidate, int sign) {
  change_within({0, in_.size()}, static_cast<std::size_t>(candidate), sign);
}

bool Design::change_within(const Stretch& these, std::size_t which, int sign) {
  in_[which] = sign > 0;
  if (sign < 0 && !(determinant(raised(all_.seen, at_[which], k_[which], -1)) > kLeastRemoved)) {
    refresh();
    return false;
  }
  const Eigen::MatrixXd w = rows_of(which);
  const Rise rise = rise_of(all_.C, w, sign);
  const Eigen::MatrixXd& U = rise.U;
  const Eigen::Index first = at_[these.first], k = U.cols();
  const auto W = W_.middleRows(first, rows_in(these));
  Eigen::MatrixXd by;
  if (objective_.criterion == Criterion::sigma) {
    const Eigen::MatrixXd AU = objective_.weight * U, T = U.transpose() * AU;
    trace_ -= sign * T.trace();
    Eigen::MatrixXd both(U.rows(), 2 * k);
    both << U, all_.C * AU;
    const Eigen::MatrixXd of_both = W * both;
    by = of_both.leftCols(k);
    const Eigen::MatrixXd half = 0.5 * by * T - sign * of_both.rightCols(k);
    if (widest_ == 1) {
      spread_.col(0).segment(first, by.rows()) += 2 * by.cwiseProduct(half);
    } else {
      for (std::size_t i = these.first; i < these.end; ++i) {
        const Small cross = by.middleRows(at_[i] - first, k_[i])
                                .lazyProduct(half.middleRows(at_[i] - first, k_[i]).transpose());
        spread_.block(at_[i], 0, k_[i], k_[i]) += cross + cross.transpose();
      }
    }
  } else {
    by = W * U;
  }
  log_determinant_ += rise.log_determinant;
  update(all_, these, rise, by, sign);
  if (objective_.criterion == Criterion::o1 && objective_.nuisance > 0) {
    const Rise of_nuisance = rise_of(nuisance_.C, w.rightCols(objective_.nuisance), sign);
    log_determinant_ -= of_nuisance.log_determinant;
    update(nuisance_, these, of_nuisance, W.rightCols(objective_.nuisance) * of_nuisance.U, sign);
  }
  return true;
}

std::pair<int, double> Design::best_instead_of(int candidate) {
  const auto which = static_cast<std::size_t>(candidate);
  // Only those of its kind are asked what they would be worth then.
  const Stretch& own = of_kind_[static_cast<std::size_t>(kinds_[which])];
  const auto rows = [&](Eigen::MatrixXd& blocks) {
    return blocks.rows() > 0 ? blocks.middleRows(at_[own.first], rows_in(own))
                             : blocks.middleRows(0, 0);
  };
  const Eigen::MatrixXd C = all_.C, seen = rows(all_.seen), of_nuisance = nuisance_.C,
                        seen_of_nuisance = rows(nuisance_.seen), spread = rows(spread_);
  const double trace = trace_, log_determinant = log_determinant_;
  const bool followed = change_within(own, which, -1);
  const std::pair<int, double> found = best(+1, kinds_[which]);
  in_[which] = 1;
  if (!followed) {
    refresh();
    return found;
  }
  all_.C = C;
  rows(all_.seen) = seen;
  nuisance_.C = of_nuisance;
  rows(nuisance_.seen) = seen_of_nuisance;
  rows(spread_) = spread;
  trace_ = trace;
  log_determinant_ = log_determinant;
  return found;
}

double Design::merit_besides(const Eigen::MatrixXd& w) const {
  const Rise rise = rise_of(all_.C, w, +1);
  if (objective_.criterion != Criterion::o1)
    return merit_of_spectrum(all_.C - rise.U * rise.U.transpose());
  double merit = log_determinant_ + rise.log_determinant;
  if (objective_.nuisance > 0)
    merit -= rise_of(nuisance_.C, w.rightCols(objective_.nuisance), +1).log_determinant;
  return merit;
}

std::vector<double> Design::merits_with(const std::vector<Eigen::MatrixXd>& measurements) const {
  std::vector<double> merits;
  const auto scaled = [&](const Eigen::MatrixXd& w) {
    return Eigen::MatrixXd(w * scale_.cwiseInverse().asDiagonal());
  };
  if (objective_.criterion != Criterion::sigma) {
    for (const Eigen::MatrixXd& each : measurements) merits.push_back(merit_besides(scaled(each)));
    return merits;
  }
  Eigen::Index rows = 0, at = 0;
  for (const Eigen::MatrixXd& each : measurements) rows += each.rows();
  Eigen::MatrixXd W(rows, W_.cols());
  for (const Eigen::MatrixXd& each : measurements) {
    W.middleRows(at, each.rows()) = scaled(each);
    at += each.rows();
  }
  const Eigen::MatrixXd G = all_.C * W.transpose(), AG = objective_.weight * G;
  at = 0;
  for (const Eigen::MatrixXd& each : measurements) {
    const Eigen::Index k = each.rows();
    const auto g = G.middleCols(at, k);
    const Eigen::MatrixXd seen = W.middleRows(at, k) * g,
                          spread = g.transpose() * AG.middleCols(at, k);
    merits.push_back(-trace_ + trace_of_quotient(raised(seen, 0, k, +1), spread, 0));
    at += k;
  }
  return merits;
}

void Design::replace(int candidate, const Eigen::MatrixXd& w) {
  const auto which = static_cast<std::size_t>(candidate);
  expects(!in_[which] && w.rows() == k_[which], "the candidate is not chosen");
  auto W = W_.middleRows(at_[which], k_[which]);
  W = w * scale_.cwiseInverse().asDiagonal();
  const auto block = [&](Eigen::MatrixXd& blocks) {
    return blocks.block(at_[which], 0, k_[which], k_[which]);
  };
  const Eigen::MatrixXd WC = W * all_.C;
  block(all_.seen) = WC * W.transpose();
  if (objective_.criterion == Criterion::sigma)
    block(spread_) = WC * objective_.weight * WC.transpose();
  if (objective_.criterion == Criterion::o1 && objective_.nuisance > 0) {
    const auto own = W.rightCols(objective_.nuisance);
    block(nuisance_.seen) = own * nuisance_.C * own.transpose();
  }
}

}  // namespace selfcal
