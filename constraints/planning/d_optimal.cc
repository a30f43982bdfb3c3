#include "constraints/planning/d_optimal.h"

#include <algorithm>
#include <map>

#include "constraints/methods/unit_normal.h"

namespace selfcal {
namespace {

constexpr double kNoise = 2e-5;  // m, where a set does not say its own

/// What is unknown of a surface or a socket.
struct PlaceUnknowns {
  int column = 0;          ///< first of three
  Eigen::Vector3d normal;  ///< that the plane's unknowns belong to
};

/// Columns of the surfaces and sockets, after those of the robot.
class Columns {
 public:
  Columns(int first, const std::vector<Set>& sets) : next_(first), sets_(sets) {}

  /// That of the candidate's surface or socket; two faces that are a known distance apart are one
  /// place, and have one normal though their ways out are opposite.
  const PlaceUnknowns& of(const PossibleTouch& candidate) {
    const int reference = sets_[candidate.set].reference;
    const auto [found, added] =
        at_.try_emplace({reference < 0 ? candidate.set : reference, candidate.group},
                        PlaceUnknowns{next_, candidate.outward});
    if (added) next_ += 3;
    return found->second;
  }
  int end() const { return next_; }

 private:
  int next_;
  const std::vector<Set>& sets_;
  std::map<std::pair<int, int>, PlaceUnknowns> at_;
};

/// Whitened rows of the candidates, one matrix each (1 row for a surface, 3 for a socket).
std::vector<Eigen::MatrixXd> rows_of(const Robot& robot, const Eigen::VectorXd& xi,
                                     const std::vector<Set>& sets,
                                     const std::vector<PossibleTouch>& candidates,
                                     Columns& columns) {
  for (const PossibleTouch& each : candidates) columns.of(each);
  const auto parameters = static_cast<Eigen::Index>(robot.parameters().size());
  std::vector<Eigen::MatrixXd> rows;
  ConfigurationBlock block{Eigen::ArrayXXd(kLanes, static_cast<int>(robot.joints().size())), 0};
  Locations X;
  PsiBlock psi;
  for (std::size_t first = 0; first < candidates.size(); first += kLanes) {
    block.count = static_cast<int>(std::min<std::size_t>(kLanes, candidates.size() - first));
    for (int lane = 0; lane < kLanes; ++lane)
      block.q.row(lane) = candidates[first + std::min(lane, block.count - 1)].q.transpose().array();
    robot.locate(block, xi, Body::endpoint, X, &psi);
    for (int lane = 0; lane < block.count; ++lane) {
      const PossibleTouch& each = candidates[first + lane];
      Eigen::MatrixXd moves(3, parameters);
      for (int c = 0; c < 3; ++c) moves.row(c) = psi.row(c * kLanes + lane);
      const PlaceUnknowns& nuisance = columns.of(each);
      const bool socket = each.group >= 0;
      Eigen::MatrixXd W = Eigen::MatrixXd::Zero(socket ? 3 : 1, columns.end());
      W.leftCols(parameters) =
          socket ? moves : Eigen::MatrixXd(nuisance.normal.transpose() * moves);
      if (socket)
        W.middleCols(nuisance.column, 3) = -Eigen::Matrix3d::Identity();
      else
        W.middleCols(nuisance.column, 3) << X.p(lane).transpose() * tangents(nuisance.normal), -1;
      rows.push_back(W / touch_noise(sets[each.set]));
    }
  }
  return rows;
}

Eigen::MatrixXd prior(const Robot& robot, int columns) {
  Eigen::VectorXd variance = Eigen::VectorXd::Constant(columns, kPlaceVariance);
  for (std::size_t i = 0; i < robot.parameters().size(); ++i) {
    const Parameter& each = robot.parameters()[i];
    variance[static_cast<Eigen::Index>(i)] = each.free ? each.tolerance * each.tolerance : 0;
  }
  return variance.asDiagonal();
}

}  // namespace

double touch_noise(const Set& set) { return set.noise > 0 ? set.noise : kNoise; }

std::vector<int> d_optimal_touches(const Robot& robot, const Eigen::VectorXd& xi,
                                   const std::vector<Set>& sets,
                                   const std::vector<PossibleTouch>& candidates,
                                   std::vector<int> counts) {
  Columns columns(static_cast<int>(robot.parameters().size()), sets);
  const std::vector<Eigen::MatrixXd> rows = rows_of(robot, xi, sets, candidates, columns);
  Eigen::MatrixXd C = prior(robot, columns.end());
  // C w of every row, kept up to date: a candidate then costs one product of vectors.
  std::vector<Eigen::MatrixXd> Cw;
  for (const Eigen::MatrixXd& W : rows) Cw.push_back(C * W.transpose());
  std::vector<char> used(rows.size(), 0);
  std::vector<int> chosen;
  for (;;) {
    int best = -1;
    double most = -1;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (used[i] || counts[candidates[i].set] <= 0) continue;
      const double variance = rows[i].cwiseProduct(Cw[i].transpose()).sum();
      if (variance <= most) continue;
      most = variance;
      best = static_cast<int>(i);
    }
    if (best < 0) return chosen;
    chosen.push_back(best);
    used[best] = 1;
    --counts[candidates[best].set];
    for (Eigen::Index a = 0; a < rows[best].rows(); ++a) {
      const Eigen::VectorXd w = rows[best].row(a).transpose();
      const Eigen::VectorXd gain = Cw[best].col(a);
      const double scale = 1 / (1 + w.dot(gain));
      for (std::size_t i = 0; i < rows.size(); ++i)
        if (!used[i] || static_cast<int>(i) == best)
          Cw[i] -= gain * (scale * (rows[i] * gain).transpose());
    }
  }
}

Eigen::MatrixXd covariance_after(const Robot& robot, const Eigen::VectorXd& xi,
                                 const std::vector<Set>& sets,
                                 const std::vector<PossibleTouch>& touches) {
  Columns columns(static_cast<int>(robot.parameters().size()), sets);
  const std::vector<Eigen::MatrixXd> rows = rows_of(robot, xi, sets, touches, columns);
  Eigen::MatrixXd C = prior(robot, columns.end());
  for (const Eigen::MatrixXd& W : rows)
    for (Eigen::Index a = 0; a < W.rows(); ++a) {
      const Eigen::VectorXd gain = C * W.row(a).transpose();
      C -= gain * gain.transpose() / (1 + W.row(a).dot(gain));
    }
  const auto parameters = static_cast<Eigen::Index>(robot.parameters().size());
  return C.topLeftCorner(parameters, parameters);
}

}  // namespace selfcal
