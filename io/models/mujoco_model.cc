#include "io/models/mujoco_model.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace selfcal {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// MuJoCo writes its warnings to a file in the current folder unless somebody takes them.
void take_warning(const char*) {}

Vector3d vector_at(const mjtNum* from) { return Eigen::Map<const Vector3d>(from); }

Isometry3d pose_at(const mjtNum* p, const mjtNum* R) {
  Isometry3d X = Isometry3d::Identity();
  X.translation() = vector_at(p);
  X.linear() = Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>>(R);
  return X;
}

std::string in_one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

/// A name as a robot file allows it.
std::string name_for(const char* given, const std::string& otherwise) {
  std::string name = given ? given : "";
  for (char& c : name)
    if (std::string_view(".* \t").find(c) != std::string_view::npos) c = '_';
  return name.empty() ? otherwise : name;
}

std::optional<MujocoFollower> follower_of(const mjModel& m, int joint) {
  for (int e = 0; e < m.neq; ++e) {
    if (m.eq_type[e] != mjEQ_JOINT || !m.eq_active[e] || m.eq_obj1id[e] != joint ||
        m.eq_obj2id[e] < 0)
      continue;
    MujocoFollower follower{joint, m.eq_obj2id[e], {}};
    std::copy_n(m.eq_data + mjNEQDATA * e, follower.a.size(), follower.a.begin());
    return follower;
  }
  return std::nullopt;
}

}  // namespace

Result<MujocoModel> MujocoModel::load(const std::filesystem::path& file, const std::string& tool) {
  return load(file, nullptr, tool);
}

Result<MujocoModel> MujocoModel::load_text(const std::filesystem::path& file,
                                           const std::string& text, const std::string& tool) {
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

Result<MujocoModel> MujocoModel::load(const std::filesystem::path& file, const mjVFS* files,
                                      const std::string& tool) {
  mju_user_warning = take_warning;
  std::array<char, 1000> error{};
  MujocoModel loaded;
  loaded.file_ = file.string();
  loaded.model_.reset(mj_loadXML(file.c_str(), files, error.data(), error.size()));
  if (!loaded.model_) return bad_input(loaded.file_ + ": MuJoCo: " + in_one_line(error.data()));
  loaded.data_.reset(mj_makeData(loaded.model_.get()));
  if (auto found = loaded.find_tool(tool); !found) return tl::unexpected(found.error());
  if (auto found = loaded.find_joints(); !found) return tl::unexpected(found.error());
  return loaded;
}

JointChain MujocoModel::chain() {
  stand(VectorXd::Zero(static_cast<Eigen::Index>(joints_.size())));
  mj_kinematics(model_.get(), data_.get());
  JointChain chain;
  chain.name = name_for(model_->names, "robot");
  chain.X_WT = tool_pose();
  for (const MujocoJoint& joint : joints_) chain.joints.push_back(chain_joint(joint.id));
  add_masses(chain);
  return chain;
}

std::vector<MujocoBody> MujocoModel::bodies() const {
  std::vector<MujocoBody> list;
  for (int id = tool_.body; id > 0; id = model_->body_parentid[id]) {
    const char* name = mj_id2name(model_.get(), mjOBJ_BODY, id);
    const auto standing = [&](int b) { return pose_at(data_->xpos + 3 * b, data_->xmat + 9 * b); };
    MujocoBody body{id - 1, name ? name : "", standing(id)};
    std::array<mjtNum, 9> R{};
    mju_quat2Mat(R.data(), model_->body_quat + 4 * id);
    body.X_BF = body.X_WB.inverse() * standing(model_->body_parentid[id]) *
                pose_at(model_->body_pos + 3 * id, R.data());
    for (std::size_t j = 0; j < joints_.size(); ++j)
      if (model_->jnt_bodyid[joints_[j].id] == id) body.joints.push_back(static_cast<int>(j));
    list.push_back(std::move(body));
  }
  std::ranges::reverse(list);
  return list;
}

ChainJoint MujocoModel::chain_joint(int id) const {
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

std::string MujocoModel::joint_name(int id) const {
  return name_for(mj_id2name(model_.get(), mjOBJ_JOINT, id), "joint" + std::to_string(id));
}

std::vector<std::string> MujocoModel::ends(bool sites) const {
  std::vector<std::string> names;
  const int count = sites ? model_->nsite : model_->nbody;
  for (int i = sites ? 0 : 1; i < count; ++i) {
    const bool carries =
        !sites && std::find(model_->body_parentid + 1, model_->body_parentid + model_->nbody, i) !=
                      model_->body_parentid + model_->nbody;
    const char* name = mj_id2name(model_.get(), sites ? mjOBJ_SITE : mjOBJ_BODY, i);
    if (!carries && name) names.emplace_back(name);
  }
  return names;
}

Result<void> MujocoModel::find_tool(std::string name) {
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

int MujocoModel::position_actuator(int joint) const {
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

bool MujocoModel::is_driven(int joint) const {
  for (int a = 0; a < model_->nu; ++a)
    if (model_->actuator_trntype[a] == mjTRN_JOINT && model_->actuator_trnid[2 * a] == joint)
      return true;
  return false;
}

bool MujocoModel::is_play(int joint) const {
  const mjModel& m = *model_;
  const int first = m.body_jntadr[m.jnt_bodyid[joint]];
  return joint != first && m.jnt_type[joint] == m.jnt_type[first] && m.jnt_limited[joint] &&
         m.jnt_stiffness[joint] == 0 && !is_driven(joint) &&
         vector_at(m.jnt_axis + 3 * joint) == vector_at(m.jnt_axis + 3 * first) &&
         vector_at(m.jnt_pos + 3 * joint) == vector_at(m.jnt_pos + 3 * first);
}

Result<void> MujocoModel::find_joints() {
  const mjModel& m = *model_;
  std::vector<int> bodies;
  for (int body = tool_.body; body > 0; body = m.body_parentid[body]) bodies.push_back(body);
  for (auto body = bodies.rbegin(); body != bodies.rend(); ++body)
    for (int i = 0; i < m.body_jntnum[*body]; ++i) {
      const int joint = m.body_jntadr[*body] + i;
      if (m.jnt_type[joint] != mjJNT_HINGE && m.jnt_type[joint] != mjJNT_SLIDE)
        return bad_input(file_ + ": joint '" + joint_name(joint) + "' between the world and '" +
                         tool_.name + "' is neither a hinge nor a slide");
      if (const auto follower = follower_of(m, joint)) {
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
  for (const MujocoFollower& each : followers_)
    if (std::ranges::find(joints_, each.leader, &MujocoJoint::id) == joints_.end())
      return bad_input(file_ + ": joint '" + joint_name(each.id) + "' follows '" +
                       joint_name(each.leader) +
                       "', which is no joint of the robot between the "
                       "world and '" +
                       tool_.name + "'");
  if (joints_.empty()) return bad_input(file_ + ": no joint of a robot moves '" + tool_.name + "'");
  return {};
}

Isometry3d MujocoModel::tool_pose() const {
  return tool_.site >= 0
             ? pose_at(data_->site_xpos + 3 * tool_.site, data_->site_xmat + 9 * tool_.site)
             : pose_at(data_->xpos + 3 * tool_.body, data_->xmat + 9 * tool_.body);
}

void MujocoModel::stand(const VectorXd& q) {
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

void MujocoModel::follow() {
  for (const MujocoFollower& each : followers_) {
    const double x = position(each.leader) - zero(each.leader);
    double y = 0;
    for (std::size_t k = each.a.size(); k-- > 0;) y = y * x + each.a[k];
    position(each.id) = zero(each.id) + y;
  }
}

double MujocoModel::slope(const MujocoFollower& follower) const {
  const double x = position(follower.leader) - zero(follower.leader);
  double slope = 0;
  for (std::size_t k = follower.a.size(); k-- > 1;)
    slope = slope * x + static_cast<double>(k) * follower.a[k];
  return slope;
}

void MujocoModel::add_masses(JointChain& chain) const {
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

int MujocoModel::carrier_of(int body) const {
  for (; body > 0; body = model_->body_parentid[body])
    for (std::size_t j = joints_.size(); j-- > 0;)
      if (model_->jnt_bodyid[joints_[j].id] == body) return static_cast<int>(j);
  return -1;
}

}  // namespace selfcal
