// Static balance, at no velocity and no acceleration, over the coordinates x that may give way:
//   r(x) = tau_inverse(x) - tau_actuator(x) - J(x)^T f = 0,    x <- x - (dr/dx)^-1 r
// tau_inverse: what MuJoCo's inverse dynamics asks for beside gravity, springs and contacts
// (Todorov, Convex and analytically-invertible dynamics with contacts and constraints, ICRA 2014).
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>

#include "io/models/mujoco.h"

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

struct ModelEnd {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DataEnd {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

/// MuJoCo writes its warnings to a file in the current folder unless somebody takes them.
void take_warning(const char*) {}

Vector3d vector_at(const mjtNum* from) { return Eigen::Map<const Vector3d>(from); }

Isometry3d pose_at(const mjtNum* p, const mjtNum* R) {
  Isometry3d X = Isometry3d::Identity();
  X.translation() = vector_at(p);
  X.linear() = Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>>(R);
  return X;
}

/// What is measured: a site, or a body where there is none of the name.
struct Tool {
  std::string name;
  int site = -1, body = -1;
};

struct ModelJoint {
  int id = 0, actuator = -1;  ///< actuator: one that holds a position; -1 without
};

/// A joint that an equality ties to one of the robot's: y = y0 + sum of a_k (x - x0)^k.
struct Follower {
  int id = 0, leader = 0;        ///< leader: its joint
  std::array<double, 5> a = {};  ///< rad or m
};

class Model {
 public:
  static Result<Model> load(const std::filesystem::path& file, const std::string& tool) {
    return load(file, nullptr, tool);
  }

  /// The model whose text is `text`, with the file's folder for what it names.
  static Result<Model> load_text(const std::filesystem::path& file, const std::string& text,
                                 const std::string& tool) {
    const auto files = std::make_unique<mjVFS>();  // large
    mj_defaultVFS(files.get());
    const std::string name = file.filename().string();
    if (mj_makeEmptyFileVFS(files.get(), name.c_str(), static_cast<int>(text.size())) != 0)
      return bad_input(file.string() + ": MuJoCo takes no model of this size or name");
    const int place = mj_findFileVFS(files.get(), name.c_str());
    std::memcpy(files->filedata[place], text.data(), text.size());
    auto loaded = load(file, files.get(), tool);
    mj_deleteVFS(files.get());
    return loaded;
  }

  static Result<Model> load(const std::filesystem::path& file, const mjVFS* files,
                            const std::string& tool) {
    mju_user_warning = take_warning;
    std::array<char, 1000> error{};
    Model loaded;
    loaded.file_ = file.string();
    loaded.model_.reset(mj_loadXML(file.c_str(), files, error.data(), error.size()));
    if (!loaded.model_) return bad_input(loaded.file_ + ": MuJoCo: " + in_one_line(error.data()));
    loaded.data_.reset(mj_makeData(loaded.model_.get()));
    if (auto found = loaded.find_tool(tool); !found) return tl::unexpected(found.error());
    if (auto found = loaded.find_joints(); !found) return tl::unexpected(found.error());
    return loaded;
  }

  const Tool& tool() const { return tool_; }
  int driven() const { return static_cast<int>(driven_.size()); }
  std::size_t joints() const { return joints_.size(); }
  std::size_t springs() const { return springs_.size(); }
  bool touches() const { return data_->ncon > 0; }

  JointChain chain() {
    stand(VectorXd::Zero(static_cast<Eigen::Index>(joints_.size())));
    mj_kinematics(model_.get(), data_.get());
    JointChain chain;
    chain.name = name_for(model_->names, "robot");
    chain.X_WT = tool_pose();
    for (const ModelJoint& joint : joints_) chain.joints.push_back(chain_joint(joint.id));
    add_masses(chain);
    return chain;
  }

  std::size_t followers() const { return followers_.size(); }
  int every_body() const { return model_->nbody - 1; }

  /// Where chain() has them.
  std::vector<MujocoBody> bodies() const {
    std::vector<MujocoBody> list;
    for (int id = tool_.body; id > 0; id = model_->body_parentid[id]) {
      const char* name = mj_id2name(model_.get(), mjOBJ_BODY, id);
      MujocoBody body{id - 1, name ? name : "",
                      pose_at(data_->xpos + 3 * id, data_->xmat + 9 * id)};
      for (std::size_t j = 0; j < joints_.size(); ++j)
        if (model_->jnt_bodyid[joints_[j].id] == id) body.joints.push_back(static_cast<int>(j));
      list.push_back(std::move(body));
    }
    std::ranges::reverse(list);
    return list;
  }

  /// The tool at rest, or nothing: joints at the readings, or those with a position actuator as far
  /// as it brings them when it is told the readings.
  std::optional<Location> settle(const MujocoLoad& load, bool told) {
    free_ = springy_;
    if (told) free_.insert(free_.end(), driven_.begin(), driven_.end());
    stand(load.q);
    for (int i = 0; i < kMostSides; ++i) {
      if (!balance(load)) return std::nullopt;
      if (!change_sides()) break;
    }
    follow();
    mj_fwdPosition(model_.get(), data_.get());
    const Isometry3d X = tool_pose();
    return Location{X.linear(), X.translation()};
  }

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
    for (const int joint : plays_) {
      const double torque = -force_missing_[model_->jnt_dofadr[joint]];
      const mjtNum* range = model_->jnt_range + 2 * joint;
      const double side = std::abs(torque) < kNoTorque ? zero(joint)
                          : torque > 0                 ? kWithin * range[1]
                                                       : kWithin * range[0];
      changed = changed || position(joint) != side;
      position(joint) = side;
    }
    return changed;
  }

  static std::string in_one_line(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    while (text.ends_with(' ')) text.pop_back();
    return text;
  }

  ChainJoint chain_joint(int id) const {
    const mjModel& m = *model_;
    ChainJoint joint;
    joint.name = joint_name(id);
    joint.motion =
        m.jnt_type[id] == mjJNT_SLIDE ? serial::Motion::prismatic : serial::Motion::revolute;
    joint.X_WJ = pose_at(data_->xanchor + 3 * id, data_->xmat + 9 * m.jnt_bodyid[id]);
    joint.axis = joint.X_WJ.linear().transpose() * vector_at(data_->xaxis + 3 * id);
    if (m.jnt_limited[id]) {
      joint.lower = m.jnt_range[2 * id];
      joint.upper = m.jnt_range[2 * id + 1];
    }
    return joint;
  }

  /// A name as a robot file allows it.
  static std::string name_for(const char* given, const std::string& otherwise) {
    std::string name = given ? given : "";
    for (char& c : name)
      if (std::string_view(".* \t").find(c) != std::string_view::npos) c = '_';
    return name.empty() ? otherwise : name;
  }

  std::string joint_name(int id) const {
    return name_for(mj_id2name(model_.get(), mjOBJ_JOINT, id), "joint" + std::to_string(id));
  }

  /// Names of the sites, or of the bodies that carry no other.
  std::vector<std::string> ends(bool sites) const {
    std::vector<std::string> names;
    const int count = sites ? model_->nsite : model_->nbody;
    for (int i = sites ? 0 : 1; i < count; ++i) {
      const bool carries =
          !sites && std::find(model_->body_parentid + 1, model_->body_parentid + model_->nbody,
                              i) != model_->body_parentid + model_->nbody;
      const char* name = mj_id2name(model_.get(), sites ? mjOBJ_SITE : mjOBJ_BODY, i);
      if (!carries && name) names.emplace_back(name);
    }
    return names;
  }

  Result<void> find_tool(std::string name) {
    if (name.empty()) {
      const std::vector<std::string> all = ends(model_->nsite > 0);
      std::string list;
      for (const std::string& each : all) list += (list.empty() ? "" : ", ") + each;
      if (all.size() != 1)
        return bad_input(file_ + ": which site or body is the tool? It has " +
                         (list.empty() ? "none with a name" : list));
      name = all.front();
    }
    tool_.name = name;
    tool_.site = mj_name2id(model_.get(), mjOBJ_SITE, name.c_str());
    tool_.body = tool_.site >= 0 ? model_->site_bodyid[tool_.site]
                                 : mj_name2id(model_.get(), mjOBJ_BODY, name.c_str());
    if (tool_.body < 0) return bad_input(file_ + ": has no site and no body '" + name + "'");
    return {};
  }

  /// The actuator that brings the joint to what it is told, in proportion to what it is off.
  int position_actuator(int joint) const {
    const mjModel& m = *model_;
    for (int a = 0; a < m.nu; ++a) {
      const double gain = m.actuator_gainprm[mjNGAIN * a];
      if (m.actuator_trntype[a] == mjTRN_JOINT && m.actuator_trnid[2 * a] == joint &&
          m.actuator_dyntype[a] == mjDYN_NONE && m.actuator_biastype[a] == mjBIAS_AFFINE &&
          gain > 0 && m.actuator_biasprm[mjNBIAS * a + 1] == -gain)
        return a;
    }
    return -1;
  }

  bool is_driven(int joint) const {
    for (int a = 0; a < model_->nu; ++a)
      if (model_->actuator_trntype[a] == mjTRN_JOINT && model_->actuator_trnid[2 * a] == joint)
        return true;
    return false;
  }

  std::optional<Follower> follower_of(int joint) const {
    const mjModel& m = *model_;
    for (int e = 0; e < m.neq; ++e) {
      if (m.eq_type[e] != mjEQ_JOINT || !m.eq_active[e] || m.eq_obj1id[e] != joint ||
          m.eq_obj2id[e] < 0)
        continue;
      Follower follower{joint, m.eq_obj2id[e], {}};
      std::copy_n(m.eq_data + mjNEQDATA * e, follower.a.size(), follower.a.begin());
      return follower;
    }
    return std::nullopt;
  }

  /// On one axis with the body's first joint, free within a range: what that joint has play by.
  bool is_play(int joint) const {
    const mjModel& m = *model_;
    const int first = m.body_jntadr[m.jnt_bodyid[joint]];
    return joint != first && m.jnt_type[joint] == m.jnt_type[first] && m.jnt_limited[joint] &&
           m.jnt_stiffness[joint] == 0 && !is_driven(joint) &&
           vector_at(m.jnt_axis + 3 * joint) == vector_at(m.jnt_axis + 3 * first) &&
           vector_at(m.jnt_pos + 3 * joint) == vector_at(m.jnt_pos + 3 * first);
  }

  Result<void> find_joints() {
    const mjModel& m = *model_;
    std::vector<int> bodies;
    for (int body = tool_.body; body > 0; body = m.body_parentid[body]) bodies.push_back(body);
    for (auto body = bodies.rbegin(); body != bodies.rend(); ++body)
      for (int i = 0; i < m.body_jntnum[*body]; ++i) {
        const int joint = m.body_jntadr[*body] + i;
        if (m.jnt_type[joint] != mjJNT_HINGE && m.jnt_type[joint] != mjJNT_SLIDE)
          return bad_input(file_ + ": joint '" + joint_name(joint) + "' between the world and '" +
                           tool_.name + "' is neither a hinge nor a slide");
        if (const auto follower = follower_of(joint)) {
          followers_.push_back(*follower);
          continue;
        }
        if (is_play(joint)) {
          plays_.push_back(joint);
          continue;
        }
        const bool spring = m.jnt_stiffness[joint] > 0 && !is_driven(joint);
        if (spring)
          springs_.push_back(joint);
        else
          joints_.push_back({joint, position_actuator(joint)});
        if (spring) springy_.push_back(m.jnt_dofadr[joint]);
        if (!spring && joints_.back().actuator >= 0) driven_.push_back(m.jnt_dofadr[joint]);
      }
    for (const Follower& each : followers_)
      if (std::ranges::find(joints_, each.leader, &ModelJoint::id) == joints_.end())
        return bad_input(file_ + ": joint '" + joint_name(each.id) + "' follows '" +
                         joint_name(each.leader) +
                         "', which is no joint of the robot between the "
                         "world and '" +
                         tool_.name + "'");
    if (joints_.empty())
      return bad_input(file_ + ": no joint of a robot moves '" + tool_.name + "'");
    return {};
  }

  Isometry3d tool_pose() const {
    return tool_.site >= 0
               ? pose_at(data_->site_xpos + 3 * tool_.site, data_->site_xmat + 9 * tool_.site)
               : pose_at(data_->xpos + 3 * tool_.body, data_->xmat + 9 * tool_.body);
  }

  /// Joints at their readings and commanded to stay there, springs at their rest.
  void stand(const VectorXd& q) {
    const mjModel& m = *model_;
    mj_resetData(model_.get(), data_.get());
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const double reading = q[static_cast<Eigen::Index>(j)];
      data_->qpos[m.jnt_qposadr[joints_[j].id]] = reading;
      if (const int a = joints_[j].actuator; a >= 0)
        data_->ctrl[a] = m.actuator_gear[6 * a] * reading;
    }
    for (const int joint : springs_)
      data_->qpos[m.jnt_qposadr[joint]] = m.qpos_spring[m.jnt_qposadr[joint]];
    follow();
  }

  double& position(int joint) { return data_->qpos[model_->jnt_qposadr[joint]]; }
  double zero(int joint) const { return model_->qpos0[model_->jnt_qposadr[joint]]; }

  /// An equality of MuJoCo's is soft; here it holds.
  void follow() {
    for (const Follower& each : followers_) {
      const double x = position(each.leader) - zero(each.leader);
      double y = 0;
      for (std::size_t k = each.a.size(); k-- > 0;) y = y * x + each.a[k];
      position(each.id) = zero(each.id) + y;
    }
  }

  /// How far the follower goes as its leader does.
  double slope(const Follower& follower) {
    const double x = position(follower.leader) - zero(follower.leader);
    double slope = 0;
    for (std::size_t k = follower.a.size(); k-- > 1;)
      slope = slope * x + static_cast<double>(k) * follower.a[k];
    return slope;
  }

  /// Of the coordinates that may give way (N m, N).
  VectorXd imbalance(const MujocoLoad& load) {
    follow();
    mj_fwdPosition(model_.get(), data_.get());
    mj_fwdVelocity(model_.get(), data_.get());
    mj_fwdActuation(model_.get(), data_.get());
    VectorXd applied = VectorXd::Zero(model_->nv);
    const Isometry3d X = tool_pose();
    const Vector3d force = X.linear() * load.force, moment = X.linear() * load.moment;
    mj_applyFT(model_.get(), data_.get(), force.data(), moment.data(), X.translation().data(),
               tool_.body, applied.data());
    mju_zero(data_->qacc, model_->nv);
    mj_inverse(model_.get(), data_.get());
    force_missing_ = VectorXd::Zero(model_->nv);
    for (int dof = 0; dof < model_->nv; ++dof)
      force_missing_[dof] = data_->qfrc_inverse[dof] - data_->qfrc_actuator[dof] - applied[dof];
    for (const Follower& each : followers_)  // by virtual work
      force_missing_[model_->jnt_dofadr[each.leader]] +=
          slope(each) * force_missing_[model_->jnt_dofadr[each.id]];
    VectorXd r(static_cast<Eigen::Index>(free_.size()));
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      r[i] = force_missing_[free_[static_cast<std::size_t>(i)]];
    }
    return r;
  }

  /// Hinges and slides have one place in qpos for their one in qvel.
  double& coordinate(std::size_t i) {
    return data_->qpos[model_->jnt_qposadr[model_->dof_jntid[free_[i]]]];
  }

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

  /// The masses that no joint of the robot parts from what a joint moves, springs at rest.
  void add_masses(JointChain& chain) const {
    const mjModel& m = *model_;
    std::vector<Vector3d> moments(joints_.size(), Vector3d::Zero());
    for (int body = 1; body < m.nbody; ++body) {
      const int carrier = carrier_of(body);
      if (carrier < 0 || !(m.body_mass[body] > 0)) continue;
      ChainJoint& joint = chain.joints[static_cast<std::size_t>(carrier)];
      joint.mass = joint.mass.value_or(0) + m.body_mass[body];
      moments[static_cast<std::size_t>(carrier)] +=
          m.body_mass[body] * vector_at(data_->xipos + 3 * body);
    }
    for (std::size_t j = 0; j < joints_.size(); ++j)
      if (ChainJoint& joint = chain.joints[j]; joint.mass)
        joint.com = joint.X_WJ.inverse() * Vector3d(moments[j] / *joint.mass);
  }

  /// The last joint of the robot that moves `body`; -1 where none does.
  int carrier_of(int body) const {
    for (; body > 0; body = model_->body_parentid[body])
      for (std::size_t j = joints_.size(); j-- > 0;)
        if (model_->jnt_bodyid[joints_[j].id] == body) return static_cast<int>(j);
    return -1;
  }

  std::string file_;
  std::unique_ptr<mjModel, ModelEnd> model_;
  std::unique_ptr<mjData, DataEnd> data_;
  Tool tool_;
  std::vector<ModelJoint> joints_;  ///< of the robot, from the world to the tool
  std::vector<Follower> followers_;
  std::vector<int> springs_;  ///< joints between them that give way
  std::vector<int> plays_;    ///< joints between them that lie where their load puts them
  std::vector<int> springy_;  ///< degrees of freedom of the springs
  std::vector<int> driven_;   ///< and of the joints that a position actuator drives
  std::vector<int> free_;     ///< of these, that settle
  VectorXd force_missing_;    ///< N m, N: by degree of freedom, in the last imbalance
};

}  // namespace

Result<MujocoChain> read_mujoco(const std::filesystem::path& file, const std::string& tool) {
  auto model = Model::load(file, tool);
  if (!model) return tl::unexpected(model.error());
  MujocoChain read;
  read.chain = model->chain();
  read.bodies = model->bodies();
  read.every_body = model->every_body();
  read.tool = model->tool().name;
  read.tool_is_site = model->tool().site >= 0;
  if (model->followers() > 0)
    return bad_input(file.string() + ": " + std::to_string(model->followers()) +
                     " joints on the way to '" + model->tool().name +
                     "' follow others by an equality, which is not read");
  if (model->springs() > 0)
    read.notices.push_back(std::to_string(model->springs()) +
                           " joints that springs hold are taken at their rest: a robot file has "
                           "them as effects (joint_compliance)");
  return read;
}

Result<MujocoPoses> settled_poses(const std::filesystem::path& file, const std::string& tool,
                                  const std::vector<MujocoLoad>& loads, const std::string& text) {
  auto model = text.empty() ? Model::load(file, tool) : Model::load_text(file, text, tool);
  if (!model) return tl::unexpected(model.error());
  MujocoPoses poses;
  poses.driven = model->driven();
  double squares = 0;
  int compared = 0;
  for (const MujocoLoad& load : loads) {
    if (load.q.size() != static_cast<Eigen::Index>(model->joints()))
      return bad_input(file.string() + ": " + std::to_string(model->joints()) +
                       " joints of a robot move '" + model->tool().name + "', and the rows have " +
                       std::to_string(load.q.size()));
    poses.tool.push_back(model->settle(load, false));
    poses.touching += model->touches();
    if (poses.driven == 0 || !poses.tool.back()) continue;
    if (const auto told = model->settle(load, true)) {
      squares += (told->p - poses.tool.back()->p).squaredNorm();
      ++compared;
    }
  }
  if (compared > 0) poses.sag = std::sqrt(squares / compared);
  return poses;
}

}  // namespace selfcal
