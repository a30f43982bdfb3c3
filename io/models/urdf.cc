// The tree that urdfdom reads, reduced to one chain. Everything is taken with all joints at zero:
// poses of links in the base, axes there, and the masses of what each joint of the chain carries.
#include "io/models/urdf.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "io/models/urdf_lines.h"
#include "io/models/urdf_tree.h"

namespace selfcal {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Vector3d vector_of(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Isometry3d pose_of(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  Isometry3d X = Isometry3d::Identity();
  X.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  X.translation() = vector_of(pose.position);
  return X;
}

bool moves(const urdf::Joint& joint) { return joint.type != urdf::Joint::FIXED; }

class Reduction {
 public:
  Reduction(const urdf::ModelInterface& model, const UrdfLines& lines, std::string file)
      : model_(model), lines_(lines), file_(std::move(file)) {}

  Result<UrdfChain> run(const UrdfEnds& ends) {
    if (auto found = find_ends(ends); !found) return tl::unexpected(found.error());
    find_path();
    find_poses();
    for (const auto& [joint, reversed] : path_)
      if (auto added = add(*joint, reversed); !added) return tl::unexpected(added.error());
    if (chain().joints.empty())
      return bad_input(place_of_link(found_.ends.tip) + ": no joint moves between '" +
                       found_.ends.base + "' and '" + found_.ends.tip + "'");
    chain().name = name_for(model_.getName());
    chain().X_WT = pose_in_base(found_.ends.tip);
    name_fixed_joints();
    if (auto mimicked = add_mimicries(); !mimicked) return tl::unexpected(mimicked.error());
    add_masses();
    return std::move(found_);
  }

 private:
  using JointAndSense = std::pair<const urdf::Joint*, bool>;

  JointChain& chain() { return found_.chain; }
  std::string place_of_joint(const std::string& name) const { return lines_.place("joint", name); }
  std::string place_of_link(const std::string& name) const { return lines_.place("link", name); }

  /// Links that carry no other.
  std::vector<std::string> ends_of_tree() const {
    std::vector<std::string> names;
    for (const auto& [name, link] : model_.links_)
      if (link->child_links.empty()) names.push_back(name);
    return names;
  }

  static std::string in_a_row(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& each : names) list += (list.empty() ? "" : ", ") + each;
    return list;
  }

  Result<void> find_ends(const UrdfEnds& ends) {
    found_.ends = ends;
    if (found_.ends.base.empty()) found_.ends.base = model_.getRoot()->name;
    if (found_.ends.tip.empty()) {
      const std::vector<std::string> ends_of_it = ends_of_tree();
      if (!ends_of_it.empty()) found_.ends.tip = ends_of_it.back();
      if (ends_of_it.size() > 1)
        return bad_input(file_ + ": has " + std::to_string(ends_of_it.size()) +
                         " ends: " + in_a_row(ends_of_it) + "; choose one with --tip");
    }
    for (const std::string& name : {found_.ends.base, found_.ends.tip})
      if (!model_.getLink(name))
        return bad_input(file_ + ": has no link '" + name + "'; it ends at " +
                         in_a_row(ends_of_tree()));
    return {};
  }

  /// Links from `name` to the root, itself first.
  std::vector<const urdf::Link*> ancestors(const std::string& name) const {
    std::vector<const urdf::Link*> links;
    for (auto link = model_.getLink(name); link; link = link->getParent())
      links.push_back(link.get());
    return links;
  }

  void find_path() {
    auto up = ancestors(found_.ends.base), down = ancestors(found_.ends.tip);
    while (!up.empty() && !down.empty() && up.back() == down.back()) {
      up.pop_back();
      down.pop_back();
    }
    for (const urdf::Link* link : up) path_.emplace_back(link->parent_joint.get(), true);
    for (auto link = down.rbegin(); link != down.rend(); ++link)
      path_.emplace_back((*link)->parent_joint.get(), false);
  }

  void find_poses() {
    pose_from(*model_.getRoot(), Isometry3d::Identity());
    X_BR_ = X_RL_.at(found_.ends.base).inverse();
  }

  void pose_from(const urdf::Link& link, const Isometry3d& X_RL) {
    X_RL_[link.name] = X_RL;
    for (const auto& child : link.child_links)
      pose_from(*child, X_RL * pose_of(child->parent_joint->parent_to_joint_origin_transform));
  }

  Isometry3d pose_in_base(const std::string& link) const { return X_BR_ * X_RL_.at(link); }

  Result<void> add(const urdf::Joint& joint, bool reversed) {
    const Isometry3d X_WC = pose_in_base(joint.child_link_name);
    found_.steps.push_back({joint.name, moves(joint), reversed, X_WC});
    if (!moves(joint)) {
      const Isometry3d far =
          pose_in_base(reversed ? joint.parent_link_name : joint.child_link_name);
      chain().fixed.push_back({name_for(joint.name), moving_.size(), far});
      return {};
    }
    const bool turns = joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS;
    if (!turns && joint.type != urdf::Joint::PRISMATIC)
      return bad_input(place_of_joint(joint.name) + ": joint '" + joint.name +
                       "' is neither revolute, prismatic nor fixed");
    const Vector3d axis = vector_of(joint.axis);
    if (!(axis.norm() > 1e-6 && axis.allFinite()))
      return bad_input(place_of_joint(joint.name) + ": joint '" + joint.name +
                       "' has an axis of no length");
    ChainJoint added;
    added.name = name_for(joint.name);
    if (added.name != joint.name)
      note("joint '" + joint.name + "' is called " + added.name + " in a robot file");
    if (!names_.insert(added.name).second)
      return bad_input(place_of_joint(joint.name) + ": two joints would be called " + added.name);
    added.motion = turns ? serial::Motion::revolute : serial::Motion::prismatic;
    added.X_WJ = X_WC;
    added.axis = (reversed ? -axis : axis).normalized();
    add_limits(joint, turns, added);
    chain().joints.push_back(added);
    moving_.push_back(&joint);
    return {};
  }

  /// After the moving joints, so that these keep their names.
  void name_fixed_joints() {
    for (FixedJoint& joint : chain().fixed)
      while (!names_.insert(joint.name).second) joint.name += "_";
  }

  void add_limits(const urdf::Joint& joint, bool turns, ChainJoint& added) {
    if (joint.type == urdf::Joint::CONTINUOUS || !joint.limits) return;
    const double lower = joint.limits->lower, upper = joint.limits->upper;
    const double most = turns ? kMostTurned : kFarthestPlace;
    if (lower < upper && std::max(std::abs(lower), std::abs(upper)) <= most) {
      added.lower = lower;
      added.upper = upper;
    } else if (lower != 0 || upper != 0) {
      note("the limits of joint '" + joint.name + "', " + format_number(lower) + " to " +
           format_number(upper) + ", are none that a robot file holds: left out");
    }
  }

  Result<void> add_mimicries() {
    for (size_t j = 0; j < moving_.size(); ++j) {
      const urdf::Joint& joint = *moving_[j];
      if (!joint.mimic) continue;
      const auto leader = std::ranges::find(moving_, joint.mimic->joint_name, &urdf::Joint::name);
      if (leader == moving_.end())
        return bad_input(place_of_joint(joint.name) + ": joint '" + joint.name + "' mimics '" +
                         joint.mimic->joint_name + "', which does not move on the chain from '" +
                         found_.ends.base + "' to '" + found_.ends.tip + "'");
      chain().joints[j].mimicry = Mimicry{static_cast<int>(leader - moving_.begin()),
                                          joint.mimic->multiplier, joint.mimic->offset};
      note("joint " + chain().joints[j].name + " mimics " +
           chain().joints[leader - moving_.begin()].name +
           " (coupling): its own reading is 0 in every row of a data set");
    }
    for (size_t j = 0; j < moving_.size(); ++j) {
      size_t at = j, steps = 0;
      while (chain().joints[at].mimicry && steps++ <= moving_.size())
        at = static_cast<size_t>(chain().joints[at].mimicry->leader);
      if (steps > moving_.size())
        return bad_input(place_of_joint(moving_[j]->name) + ": joint '" + moving_[j]->name +
                         "' mimics itself in a circle");
    }
    return {};
  }

  /// Masses of the links that no joint of the chain parts from `link`, the joint before left out.
  struct Lump {
    double mass = 0;
    Vector3d moment = Vector3d::Zero();  ///< kg m, in W
    bool known = false;
  };

  bool on_chain(const urdf::Joint* joint) const {
    return std::ranges::find(moving_, joint) != moving_.end();
  }

  void lump_from(const urdf::Link& link, const urdf::Link* from, Lump& lump) {
    if (link.inertial && link.inertial->mass > 0) {
      const Vector3d com = pose_in_base(link.name) * vector_of(link.inertial->origin.position);
      lump.mass += link.inertial->mass;
      lump.moment += link.inertial->mass * com;
      lump.known = true;
    }
    const auto go = [&](const urdf::Joint* joint, const urdf::Link* to) {
      if (!joint || !to || to == from || on_chain(joint)) return;
      if (moves(*joint)) frozen_.insert(joint->name);
      lump_from(*to, &link, lump);
    };
    for (const auto& child : link.child_links) go(child->parent_joint.get(), child.get());
    go(link.parent_joint.get(), link.getParent().get());
  }

  void add_masses() {
    bool any = false;
    std::vector<Lump> lumps(moving_.size());
    for (size_t j = 0; j < moving_.size(); ++j) {
      lump_from(*model_.getLink(carried(j)), nullptr, lumps[j]);
      any = any || lumps[j].known;
    }
    if (!any) return;
    if (!frozen_.empty())
      note("masses behind " + std::to_string(frozen_.size()) +
           " joints off the chain count with these at zero: " + *frozen_.begin() +
           (frozen_.size() > 1 ? ", …" : ""));
    for (size_t j = 0; j < moving_.size(); ++j) {
      if (!lumps[j].known) continue;
      ChainJoint& joint = chain().joints[j];
      joint.mass = lumps[j].mass;
      joint.com = joint.X_WJ.inverse() * Vector3d(lumps[j].moment / lumps[j].mass);
    }
  }

  /// The link behind moving joint `j`, seen from the base.
  const std::string& carried(size_t j) const {
    const auto step = std::ranges::find(found_.steps, moving_[j]->name, &UrdfStep::joint);
    return step->reversed ? moving_[j]->parent_link_name : moving_[j]->child_link_name;
  }

  /// A name as a robot file allows it.
  static std::string name_for(std::string name) {
    for (char& c : name)
      if (std::string_view(".* \t").find(c) != std::string_view::npos) c = '_';
    return name.empty() ? "robot" : name;
  }

  void note(std::string text) { found_.notices.push_back(std::move(text)); }

  const urdf::ModelInterface& model_;
  const UrdfLines& lines_;
  std::string file_;
  UrdfChain found_;
  std::vector<JointAndSense> path_;
  std::map<std::string, Isometry3d> X_RL_;  ///< links in the root, all joints at zero
  Isometry3d X_BR_ = Isometry3d::Identity();
  std::vector<const urdf::Joint*> moving_;  ///< of the chain
  std::set<std::string> names_, frozen_;
};

}  // namespace

Result<UrdfChain> read_urdf(const std::string& text, const std::string& file,
                            const UrdfEnds& ends) {
  const auto lines = UrdfLines::of(text, file);
  if (!lines) return tl::unexpected(lines.error());
  const auto model = urdf_tree(text, *lines);
  if (!model) return tl::unexpected(model.error());
  return Reduction(**model, *lines, file).run(ends);
}

}  // namespace selfcal
