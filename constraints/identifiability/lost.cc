// The directions are a basis N of the null space of what is left of the robot's columns beyond
// those of the sets' unknowns. A family of changes M that is known by name shares with N the
// directions along which the two enclose no angle: the singular values 1 of Q_M^T N.
#include "constraints/identifiability/lost.h"

#include <algorithm>
#include <cmath>

#include "kinematics/linear_algebra.h"

namespace selfcal {
namespace {

constexpr double kAlong = 1e-6;  // sine of an angle that is none, for directions of length 1

/// An orthonormal basis of the columns of `A`, those shorter than kAlong beyond the others left
/// out.
Eigen::MatrixXd basis_of(const Eigen::MatrixXd& A) {
  Eigen::MatrixXd Q(A.rows(), 0);
  for (Eigen::Index j = 0; j < A.cols(); ++j) {
    Eigen::VectorXd v = A.col(j);
    for (int twice = 0; twice < 2; ++twice) v -= Q * (Q.transpose() * v);
    if (v.norm() < kAlong * std::max(A.col(j).norm(), 1e-300)) continue;
    Q.conservativeResize(Eigen::NoChange, Q.cols() + 1);
    Q.rightCols(1) = v.normalized();
  }
  return Q;
}

class Finder {
 public:
  Finder(const Equations& equations, const std::vector<int>& columns, Eigen::MatrixXd N)
      : equations_(equations), columns_(columns), N_(std::move(N)), known_(N_.rows(), 0) {}

  std::vector<Lost> find(const State& state) {
    const Robot& robot = equations_.robot();
    for (const FrameMotions& each : robot.frame_motions(state.xi)) add_frame(each);
    Eigen::MatrixXd scale = Eigen::MatrixXd::Zero(N_.rows(), 1);
    for (size_t i = 0; i < columns_.size(); ++i)
      if (parameter(i).quantity == Quantity::length)
        scale(static_cast<Eigen::Index>(i), 0) = state.xi[columns_[i]];
    if (const Eigen::MatrixXd found = newly(scale); found.cols() > 0)
      lost_.push_back({1, "the size: everything larger", {}});
    std::vector<std::string> frames;
    for (size_t i = 0; i < columns_.size(); ++i)
      if (std::ranges::find(frames, parameter(i).frame) == frames.end())
        frames.push_back(parameter(i).frame);
    for (const std::string& frame : frames) add_part(frame);
    if (const Eigen::Index left = N_.cols() - known_.cols(); left > 0)
      lost_.push_back({static_cast<int>(left),
                       "changes of several parts that make up for each other",
                       names(beyond(known_, N_))});
    return std::move(lost_);
  }

 private:
  const Parameter& parameter(size_t i) const {
    return equations_.robot().parameters()[columns_[i]];
  }

  /// Directions of N within the span of M that no reason has been found for; they have one then.
  Eigen::MatrixXd newly(const Eigen::MatrixXd& M) {
    const Eigen::MatrixXd Q = basis_of(M);
    if (Q.cols() == 0) return Q;
    const SingularValues svd = singular_values(Q.transpose() * N_);
    Eigen::MatrixXd shared(N_.rows(), 0);
    for (Eigen::Index i = 0; i < svd.values.size(); ++i) {
      if (1 - svd.values[i] > kAlong * kAlong) continue;
      shared.conservativeResize(Eigen::NoChange, shared.cols() + 1);
      shared.rightCols(1) = N_ * svd.directions.col(i);
    }
    Eigen::MatrixXd fresh(N_.rows(), 0);
    for (Eigen::Index i = 0; i < shared.cols(); ++i) {
      Eigen::VectorXd v = shared.col(i);
      for (int twice = 0; twice < 2; ++twice) v -= known_ * (known_.transpose() * v);
      if (v.norm() < std::sqrt(kAlong)) continue;
      known_.conservativeResize(Eigen::NoChange, known_.cols() + 1);
      known_.rightCols(1) = v.normalized();
      fresh.conservativeResize(Eigen::NoChange, fresh.cols() + 1);
      fresh.rightCols(1) = shared.col(i);
    }
    return fresh;
  }

  void add_frame(const FrameMotions& frame) {
    Eigen::MatrixXd M(N_.rows(), frame.moves.cols());
    for (size_t i = 0; i < columns_.size(); ++i)
      M.row(static_cast<Eigen::Index>(i)) = frame.moves.row(columns_[i]);
    const auto found = static_cast<int>(newly(M).cols());
    if (found == 0) return;
    static constexpr const char* kMotionNames[] = {"shift along x", "shift along y",
                                                   "shift along z", "turn about x",
                                                   "turn about y",  "turn about z"};
    std::string which;
    for (Eigen::Index k = 0; k < M.cols(); ++k)
      if (const Eigen::VectorXd m = M.col(k).normalized();
          (m - N_ * (N_.transpose() * m)).norm() < std::sqrt(kAlong))
        which += (which.empty() ? "" : ", ") + std::string(kMotionNames[k]);
    const bool all = found == static_cast<int>(M.cols());
    lost_.push_back({found,
                     frame.what + (all             ? " may be put anywhere"
                                   : which.empty() ? " may be moved"
                                                   : " may be moved: " + which),
                     {}});
  }

  void add_part(const std::string& frame) {
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(N_.rows(), 0);
    for (size_t i = 0; i < columns_.size(); ++i) {
      if (parameter(i).frame != frame) continue;
      M.conservativeResize(Eigen::NoChange, M.cols() + 1);
      M.rightCols(1) = Eigen::VectorXd::Unit(N_.rows(), static_cast<Eigen::Index>(i));
    }
    const Eigen::MatrixXd found = newly(M);
    if (found.cols() == 0) return;
    lost_.push_back(
        {static_cast<int>(found.cols()), "within " + frame + why_within(frame), names(found)});
  }

  /// Why a part that is locked has a change of its own that no row shows.
  std::string why_within(const std::string& frame) const {
    const Robot& robot = equations_.robot();
    for (int s = 0; s < static_cast<int>(equations_.data().sets.size()); ++s) {
      const int joint = passive_index(robot, equations_.data().sets[s].method->body());
      if (equations_.plan(s).items.empty() || joint < 0) continue;
      const PassiveJoint& locked = robot.passive_joints()[static_cast<size_t>(joint)];
      if (locked.name.substr(0, locked.name.find('.')) != frame) continue;
      const bool base = locked.kind == PassiveKind::universal;
      return std::string(": locked, it keeps its direction in the ") +
             (base ? "base" : "platform") +
             ", so that its far joint moves along one line there; a shift of its near joint along "
             "that line and one of its reading are the same";
    }
    return {};
  }

  std::vector<std::string> names(const Eigen::MatrixXd& directions) const {
    std::vector<std::string> list;
    for (size_t i = 0; i < columns_.size(); ++i)
      if (directions.row(static_cast<Eigen::Index>(i)).norm() > std::sqrt(kAlong))
        list.push_back(parameter(i).name);
    return list;
  }

  const Equations& equations_;
  const std::vector<int>& columns_;
  Eigen::MatrixXd N_, known_;  ///< orthonormal; parameters in the order of columns_
  std::vector<Lost> lost_;
};

}  // namespace

std::vector<Lost> lost_directions(const Equations& equations, const Eigen::MatrixXd& R,
                                  const State& state, const std::vector<char>& free_mask,
                                  int count) {
  std::vector<int> columns;
  for (size_t i = 0; i < free_mask.size(); ++i)
    if (free_mask[i]) columns.push_back(static_cast<int>(i));
  if (count <= 0 || columns.empty()) return {};
  const Eigen::MatrixXd nuisance =
      R.middleCols(equations.robot_columns(), equations.nuisance_columns());
  const SingularValues svd = singular_values(beyond(nuisance, R(Eigen::all, columns)));
  return Finder(equations, columns, svd.directions.rightCols(count)).find(state);
}

}  // namespace selfcal
