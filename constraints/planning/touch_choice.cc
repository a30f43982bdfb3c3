#include "constraints/planning/d_optimal.h"

#include <algorithm>
#include <map>

#include "constraints/methods/unit_normal.h"

namespace selfcal {
namespace {

constexpr double kNoise = 2e-5;       // m, where a set does not say its own
constexpr double kAngleNoise = 2e-5;  // rad, as well

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

/// Rows of a candidate in the unknowns of its surface or socket, and of the robot, whose body moves
/// with `psi`.
Eigen::MatrixXd touch_row(const PossibleTouch& each, const PlaceUnknowns& nuisance, int columns,
                          const Eigen::MatrixXd& psi, const Eigen::Vector3d& p) {
  const bool socket = each.group >= 0;
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(socket ? 3 : 1, columns);
  const Eigen::MatrixXd moves = psi.topRows<3>();
  W.leftCols(moves.cols()) = socket ? moves : Eigen::MatrixXd(nuisance.normal.transpose() * moves);
  if (socket)
    W.middleCols(nuisance.column, 3) = -Eigen::Matrix3d::Identity();
  else
    W.middleCols(nuisance.column, 3) << p.transpose() * tangents(nuisance.normal), -1;
  return W;
}

/// Of a lock: the leg's direction turns off the unknown one, dr_a = (u x e_a) . turn.
Eigen::MatrixXd lock_rows(const PlaceUnknowns& nuisance, int columns, const Eigen::MatrixXd& psi) {
  const auto E = tangents(nuisance.normal);
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(2, columns);
  for (int a = 0; a < 2; ++a) {
    const Eigen::Vector3d turn = nuisance.normal.cross(E.col(a));
    W.row(a).head(psi.cols()) = turn.transpose() * psi.bottomRows<3>();
    W(a, nuisance.column + a) = -1;
  }
  return W;
}

/// Whitened rows of the candidates, one matrix each (1 row for a surface, 3 for a socket, 2 for a
/// lock).
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
  for (std::size_t first = 0; first < candidates.size(); first += block.count) {
    const Body body = sets[candidates[first].set].method->body();
    block.count = 0;
    while (block.count < kLanes && first + block.count < candidates.size() &&
           sets[candidates[first + block.count].set].method->body() == body)
      ++block.count;
    for (int lane = 0; lane < kLanes; ++lane)
      block.q.row(lane) = candidates[first + std::min(lane, block.count - 1)].q.transpose().array();
    robot.locate(block, xi, body, X, &psi);
    for (int lane = 0; lane < block.count; ++lane) {
      const PossibleTouch& each = candidates[first + lane];
      Eigen::MatrixXd moves(6, parameters);
      for (int c = 0; c < 6; ++c) moves.row(c) = psi.row(c * kLanes + lane);
      const Set& set = sets[each.set];
      if (set.method->planned() == Planned::lock)
        rows.push_back(lock_rows(columns.of(each), columns.end(), moves) / angle_noise(set));
      else
        rows.push_back(touch_row(each, columns.of(each), columns.end(), moves, X.p(lane)) /
                       touch_noise(set));
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

double angle_noise(const Set& set) { return set.noise_angle > 0 ? set.noise_angle : kAngleNoise; }

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
