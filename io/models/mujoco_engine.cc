// Static balance, at no velocity and no acceleration, over the coordinates x that may give way:
//   r(x) = tau_inverse(x) - tau_actuator(x) - J(x)^T f = 0,    x <- x - (dr/dx)^-1 r
// tau_inverse: what MuJoCo's inverse dynamics asks for beside gravity, springs and contacts
// (Todorov, Convex and analytically-invertible dynamics with contacts and constraints, ICRA 2014).
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "io/models/mujoco_model.h"

namespace selfcal {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kDifference = 1e-7;  // rad or m, of the derivative
constexpr double kMostStep = 0.05;    // rad or m, of one of Newton's
constexpr double kAtRest = 1e-10;     // rad or m: the last step's
constexpr int kMostSteps = 60, kMostHalvings = 12, kMostSides = 10;
constexpr double kNoTorque = 1e-9;  // N m, N: that keeps a joint on no side of its play
/// Of a play's range, where it lies: at its end, where the model's own soft limit does not act yet.
constexpr double kWithin = 1 - 1e-9;

class Balance {
 public:
  explicit Balance(MujocoModel& model) : model_(model), m_(model.model()), data_(model.data()) {}

  /// The tool at rest, or nothing: joints at the readings, or those with a position actuator as far
  /// as it brings them when it is told the readings.
  std::optional<Location> settle(const MujocoLoad& load, bool told) {
    free_ = model_.springy();
    if (told) free_.insert(free_.end(), model_.driven().begin(), model_.driven().end());
    model_.stand(load.q);
    for (int i = 0; i < kMostSides; ++i) {
      if (!balance(load)) return std::nullopt;
      if (!change_sides()) break;
    }
    model_.follow();
    mj_fwdPosition(&m_, &data_);
    const Isometry3d X = model_.tool_pose();
    return Location{X.linear(), X.translation()};
  }

  bool touches() const { return data_.ncon > 0; }

 private:
  /// Moves what may give way until nothing pulls; false where it comes to no rest.
  bool balance(const MujocoLoad& load) {
    VectorXd r = imbalance(load);
    double step = free_.empty() ? 0 : 1;
    for (int i = 0; i < kMostSteps && step > kAtRest; ++i) {
      const VectorXd change = newton(load, r);
      if (!change.allFinite()) return false;
      step = descend(load, change, r);
    }
    return step <= kAtRest && r.allFinite();
  }

  /// Puts each joint with play where the load of the last balance drives it; false where all are.
  bool change_sides() {
    bool changed = false;
    for (const int joint : model_.plays()) {
      const double torque = -force_missing_[m_.jnt_dofadr[joint]];
      const mjtNum* range = m_.jnt_range + 2 * joint;
      const double side = std::abs(torque) < kNoTorque ? model_.zero(joint)
                          : torque > 0                 ? kWithin * range[1]
                                                       : kWithin * range[0];
      changed = changed || model_.position(joint) != side;
      model_.position(joint) = side;
    }
    return changed;
  }

  /// Of the coordinates that may give way (N m, N).
  VectorXd imbalance(const MujocoLoad& load) {
    model_.follow();
    mj_fwdPosition(&m_, &data_);
    mj_fwdVelocity(&m_, &data_);
    mj_fwdActuation(&m_, &data_);
    VectorXd applied = VectorXd::Zero(m_.nv);
    const Isometry3d X = model_.tool_pose();
    const Vector3d force = X.linear() * load.force, moment = X.linear() * load.moment;
    mj_applyFT(&m_, &data_, force.data(), moment.data(), X.translation().data(), model_.tool().body,
               applied.data());
    mju_zero(data_.qacc, m_.nv);
    mj_inverse(&m_, &data_);
    force_missing_ = VectorXd::Zero(m_.nv);
    for (int dof = 0; dof < m_.nv; ++dof)
      force_missing_[dof] = data_.qfrc_inverse[dof] - data_.qfrc_actuator[dof] - applied[dof];
    for (const MujocoFollower& each : model_.followers())  // by virtual work
      force_missing_[m_.jnt_dofadr[each.leader]] +=
          model_.slope(each) * force_missing_[m_.jnt_dofadr[each.id]];
    VectorXd r(static_cast<Eigen::Index>(free_.size()));
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      r[i] = force_missing_[free_[static_cast<std::size_t>(i)]];
    }
    return r;
  }

  /// Hinges and slides have one place in qpos for their one in qvel.
  double& coordinate(std::size_t i) { return data_.qpos[m_.jnt_qposadr[m_.dof_jntid[free_[i]]]]; }

  void move(const VectorXd& change) {
    for (std::size_t i = 0; i < free_.size(); ++i)
      coordinate(i) += change[static_cast<Eigen::Index>(i)];
  }

  VectorXd newton(const MujocoLoad& load, const VectorXd& r) {
    Eigen::MatrixXd J(r.size(), r.size());
    for (std::size_t i = 0; i < free_.size(); ++i) {
      const double before = coordinate(i);
      coordinate(i) = before + kDifference;
      J.col(static_cast<Eigen::Index>(i)) = (imbalance(load) - r) / kDifference;
      coordinate(i) = before;
    }
    VectorXd change = -J.fullPivLu().solve(r);
    const double most = change.cwiseAbs().maxCoeff();
    if (most > kMostStep) change *= kMostStep / most;
    return change;
  }

  /// Moves by `change`, or by less of it where that balances worse; how far (rad or m).
  double descend(const MujocoLoad& load, VectorXd change, VectorXd& r) {
    const double before = r.norm();
    for (int halving = 0; halving < kMostHalvings; ++halving, change /= 2) {
      move(change);
      const VectorXd now = imbalance(load);
      if (now.norm() <= before || change.cwiseAbs().maxCoeff() < kAtRest) {
        r = now;
        return change.cwiseAbs().maxCoeff();
      }
      move(-change);
    }
    return std::numeric_limits<double>::infinity();
  }

  MujocoModel& model_;
  const mjModel& m_;
  mjData& data_;
  std::vector<int> free_;   ///< degrees of freedom that settle
  VectorXd force_missing_;  ///< N m, N: by degree of freedom, in the last imbalance
};

}  // namespace

Result<MujocoChain> read_mujoco(const std::filesystem::path& file, const std::string& tool) {
  auto model = MujocoModel::load(file, tool);
  if (!model) return tl::unexpected(model.error());
  MujocoChain read;
  read.chain = model->chain();
  read.bodies = model->bodies();
  read.every_body = model->every_body();
  read.tool = model->tool().name;
  read.tool_is_site = model->tool().site >= 0;
  if (!model->followers().empty())
    return bad_input(file.string() + ": " + std::to_string(model->followers().size()) +
                     " joints on the way to '" + model->tool().name +
                     "' follow others by an equality, which is not read");
  if (!model->springs().empty())
    read.notices.push_back(std::to_string(model->springs().size()) +
                           " joints that springs hold are taken at their rest: a robot file has "
                           "them as effects (joint_compliance)");
  return read;
}

Result<MujocoPoses> settled_poses(const std::filesystem::path& file, const std::string& tool,
                                  const std::vector<MujocoLoad>& loads, const std::string& text) {
  auto model =
      text.empty() ? MujocoModel::load(file, tool) : MujocoModel::load_text(file, text, tool);
  if (!model) return tl::unexpected(model.error());
  MujocoPoses poses;
  poses.driven = static_cast<int>(model->driven().size());
  Balance balance(*model);
  double squares = 0;
  int compared = 0;
  for (const MujocoLoad& load : loads) {
    if (load.q.size() != static_cast<Eigen::Index>(model->joints().size()))
      return bad_input(file.string() + ": " + std::to_string(model->joints().size()) +
                       " joints of a robot move '" + model->tool().name + "', and the rows have " +
                       std::to_string(load.q.size()));
    poses.tool.push_back(balance.settle(load, false));
    poses.touching += balance.touches();
    if (poses.driven == 0 || !poses.tool.back()) continue;
    if (const auto told = balance.settle(load, true)) {
      squares += (told->p - poses.tool.back()->p).squaredNorm();
      ++compared;
    }
  }
  if (compared > 0) poses.sag = std::sqrt(squares / compared);
  return poses;
}

}  // namespace selfcal
