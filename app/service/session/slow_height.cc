#include "app/service/session/slow_height.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "app/service/session/touch_decision.h"

namespace selfcal {
namespace {

constexpr Eigen::Index kFewestOver = 8;  // touches, over what a surface has of numbers
constexpr double kSigmas = 5;
constexpr double kLeast = 0.25;          // of the search
constexpr double kWorth = 0.8;           // of the way: what is less saves no time
constexpr double kSameDirection = 1e-6;  // of the spread of the places: their rank, and what lies
                                         // beside them

/// 1, the coordinates, and with `curved` their squares and products.
Eigen::VectorXd terms_of(const Eigen::Vector3d& x, bool curved) {
  Eigen::VectorXd terms(curved ? 10 : 4);
  terms.head(4) << 1, x;
  if (curved) terms.tail(6) << x.cwiseAbs2(), x[0] * x[1], x[1] * x[2], x[2] * x[0];
  return terms;
}

/// Where a contact is to be expected, out of its nominal place, and one sigma of it (m).
struct Expected {
  double out = 0, sigma = 0;
};

std::optional<Expected> expected_at(const std::vector<FeltContact>& felt, const Eigen::Vector3d& p,
                                    bool curved) {
  const auto count = static_cast<Eigen::Index>(felt.size());
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const FeltContact& each : felt) centre += each.expected / static_cast<double>(count);
  double spread = (p - centre).norm();
  for (const FeltContact& each : felt) spread = std::max(spread, (each.expected - centre).norm());
  if (spread <= 0) spread = 1;
  const Eigen::VectorXd here = terms_of((p - centre) / spread, curved);
  Eigen::MatrixXd A(count, here.size());
  Eigen::VectorXd out(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const FeltContact& each = felt[static_cast<std::size_t>(i)];
    A.row(i) = terms_of((each.expected - centre) / spread, curved);
    out[i] = each.out;
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> seen;
  seen.setThreshold(kSameDirection);
  seen.compute(A);
  const Eigen::Index over = count - seen.rank();
  if (over < kFewestOver) return std::nullopt;
  const Eigen::VectorXd weights = seen.pseudoInverse().transpose() * here;
  if ((A.transpose() * weights - here).norm() > kSameDirection) return std::nullopt;
  const Eigen::VectorXd fit = seen.solve(out);
  const double variance = (out - A * fit).squaredNorm() / static_cast<double>(over);
  return Expected{here.dot(fit), std::sqrt(variance * (1 + weights.squaredNorm()))};
}

}  // namespace

double slow_height(const std::vector<FeltContact>& felt, const Eigen::Vector3d& p, double slow,
                   double search) {
  if (felt.empty()) return slow;
  std::optional<Expected> expected = expected_at(felt, p, false);
  if (const auto curved = expected_at(felt, p, true);
      curved && (!expected || curved->sigma < expected->sigma))
    expected = curved;
  if (!expected) return slow;
  const double open = expected->out + kSigmas * expected->sigma;
  return slow - search + std::clamp(open, kLeast * search, search);
}

std::vector<double> slow_from(const Robot& robot, const Session& session, const Decoding& decoding,
                              const StepRecord& step, double search) {
  const Eigen::Vector3d& outward = decoding.outward[set_index(decoding, step.set)];
  std::vector<FeltContact> felt;
  for (const TouchRecord& touch : session.touches) {
    const StepRecord& other = session.plan[touch.step];
    if (touch.outcome != TouchOutcome::taken || other.set != step.set) continue;
    const Eigen::Vector3d expected = endpoint(robot, vector_of(other.touch));
    const Eigen::Vector3d there = endpoint(robot, reading_of(touch, decoding).q);
    felt.push_back({expected, outward.dot(there - expected)});
  }
  const Eigen::VectorXd start = vector_of(step.start), touch = vector_of(step.touch);
  const Eigen::Vector3d p = endpoint(robot, touch);
  const double slow = outward.dot(endpoint(robot, start) - p);
  const double height = slow_height(felt, p, slow, std::min(search, slow));
  if (height > kWorth * slow) return step.start;
  // On the way of the touch itself, which so meets the surface at the same readings.
  const Eigen::VectorXd end = vector_of(step.end);
  const double all = slow - outward.dot(endpoint(robot, end) - p);
  if (all <= slow - height) return step.start;
  const Eigen::VectorXd from = start + (slow - height) / all * (end - start);
  return {from.begin(), from.end()};
}

}  // namespace selfcal
