// A body stands where the calibration has its last joint, by the same step as a URDF's link:
//   X'_WB = X'_WJ X_WJ^-1 X_WB
// Its joints stay where they are in it. X_WB has all joints at zero, the file each at its `ref`:
// what is written is X'_PB X_BF. Springs, play and what follows another joint are copies of the
// joint behind it; a link that bends gets two bodies between its own and the next one.
#include "io/models/mjcf_like.h"

#include <tinyxml.h>

#include <algorithm>

#include "io/models/mjcf_elements.h"

namespace selfcal {
namespace {

using Eigen::Isometry3d;

constexpr double kUnmovedBody = 1e-11;  // m, rad: a pose that keeps its digits
constexpr double kOnAxis = 1e-9;        // of the cross product of one axis told twice
constexpr double kNextToNone = 1e-3;    // kg

bool same_pose(const Isometry3d& a, const Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff() < kUnmovedBody;
}

class MendedModel {
 public:
  MendedModel(const MujocoChain& read, const CorrectedChain& corrected, const serial::Model& robot,
              const MjcfEffects& effects)
      : read_(read), corrected_(corrected), robot_(robot), effects_(effects) {
    out_.left_out = corrected.left_out;
    out_.left_out.insert(out_.left_out.end(), effects.left_out.begin(), effects.left_out.end());
  }

  Result<MjcfText> run(const std::string& text, const std::string& file) {
    document_.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
    TiXmlElement* root = document_.RootElement();
    std::vector<TiXmlElement*> all;
    if (root)
      for (auto* e = root->FirstChildElement("worldbody"); e;
           e = e->NextSiblingElement("worldbody"))
        list_mjcf_bodies(*e, all);
    if (std::ssize(all) != read_.every_body)
      return bad_input(file + ": MuJoCo makes " + std::to_string(read_.every_body) +
                       " bodies of it, and the file itself has " + std::to_string(all.size()) +
                       ": save it as one file first (MuJoCo's `compile`)");
    for (const MujocoBody& body : read_.bodies)
      elements_.push_back(all[static_cast<std::size_t>(body.place)]);
    place_bodies();
    place_tool();
    for (std::size_t b = 0; b < elements_.size(); ++b)
      for (const int joint : read_.bodies[b].joints) add_joint_effects(*root, *elements_[b], joint);
    bend_links();
    give_masses();
    TiXmlPrinter printer;
    printer.SetIndent("  ");
    document_.Accept(&printer);
    out_.text = printer.Str();
    return out_;
  }

 private:
  const ChainJoint& before(int joint) const {
    return read_.chain.joints[static_cast<std::size_t>(joint)];
  }
  const ChainJoint& after(int joint) const {
    return corrected_.chain.joints[static_cast<std::size_t>(joint)];
  }

  void place_bodies() {
    Isometry3d moved = corrected_.base, parent = Isometry3d::Identity(), parent_before = parent;
    for (std::size_t b = 0; b < elements_.size(); ++b) {
      const MujocoBody& body = read_.bodies[b];
      if (!body.joints.empty())
        moved = after(body.joints.back()).X_WJ * before(body.joints.back()).X_WJ.inverse();
      for (const int joint : body.joints)
        if (!same_pose(moved * before(joint).X_WJ, after(joint).X_WJ))
          out_.left_out.push_back("corrections between the joints of body " + body.name +
                                  ", which it carries at one place");
      const Isometry3d X = moved * body.X_WB;
      const Isometry3d in_parent = parent.inverse() * X;
      if (!same_pose(in_parent, parent_before.inverse() * body.X_WB)) place_body(b, in_parent);
      carriers_.push_back(parent);
      placed_.push_back(X);
      parent = X;
      parent_before = body.X_WB;
    }
  }

  void place_body(std::size_t b, const Isometry3d& in_parent) {
    const Isometry3d& X_BF = read_.bodies[b].X_BF;
    const bool stays = same_pose(X_BF, Isometry3d::Identity());
    place_mjcf(*elements_[b], stays ? in_parent : in_parent * X_BF);
  }

  void place_tool() {
    const Isometry3d X = placed_.back().inverse() * corrected_.chain.X_WT;
    const Isometry3d X_before = read_.bodies.back().X_WB.inverse() * read_.chain.X_WT;
    if (same_pose(X, X_before)) return;
    TiXmlElement* site =
        read_.tool_is_site ? named_mjcf_child(*elements_.back(), "site", read_.tool) : nullptr;
    if (site) return place_mjcf(*site, X);
    if (read_.bodies.back().joints.empty() && elements_.size() > 1)
      return place_body(elements_.size() - 1,
                        placed_[placed_.size() - 2].inverse() * corrected_.chain.X_WT);
    out_.left_out.push_back("the tool's correction, for " + read_.tool +
                            " is what the last joint moves: put a site at the tool");
  }

  /// Where the robot's file has no masses, those that its effects were found with, to bodies that
  /// have next to none: without, nothing would give way.
  void give_masses() {
    const serial::Model usual = serial::with_usual_masses(robot_);
    const std::vector<int> moving = serial::moving_frames(robot_);
    const auto given = [&](int f) {
      const auto i = static_cast<std::size_t>(f);
      return usual.frames[i].mass && !robot_.frames[i].mass;
    };
    if (!given(moving.front())) return;
    for (const ChainJoint& joint : read_.chain.joints)
      if (joint.mass.value_or(0) > kNextToNone)
        return out_.left_out.push_back(
            "masses: the robot's file has none, and its effects were found with others than the "
            "model's: make the robot file of this model");
    Isometry3d X = Isometry3d::Identity();
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    double mass = 0;
    std::size_t joint = 0;
    for (std::size_t f = 0; f < usual.frames.size(); ++f) {
      X = X * serial::pose_in_parent(usual.frames[f], 0);
      mass += usual.frames[f].mass.value_or(0);
      moment += usual.frames[f].mass.value_or(0) * (X * usual.frames[f].com);
      const bool last = f + 1 == usual.frames.size();
      const bool ends =
          joint < moving.size() && static_cast<int>(f) >= moving[joint] &&
          (last || (joint + 1 < moving.size() && static_cast<int>(f) + 1 == moving[joint + 1]));
      if (!ends) continue;
      give_mass(static_cast<int>(joint++), mass, moment / std::max(mass, kNextToNone));
      mass = 0;
      moment.setZero();
    }
  }

  /// To the body of the joint; `com_W` as the calibrated robot has it with all joints at zero.
  void give_mass(int joint, double mass, const Eigen::Vector3d& com_W) {
    for (std::size_t b = 0; b < elements_.size(); ++b) {
      if (std::ranges::find(read_.bodies[b].joints, joint) == read_.bodies[b].joints.end())
        continue;
      if (TiXmlElement* old = elements_[b]->FirstChildElement("inertial"))
        elements_[b]->RemoveChild(old);
      const TiXmlElement inertial = mjcf_inertial(mass, placed_[b].inverse() * com_W);
      elements_[b]->InsertBeforeChild(elements_[b]->FirstChild(), inertial);
    }
  }

  /// The joint of the model that the robot's frame `name` is of.
  const std::string& model_joint(const std::string& name) const {
    const std::vector<int> moving = serial::moving_frames(robot_);
    std::size_t j = 0;
    while (robot_.frames[static_cast<std::size_t>(moving[j])].name != name) ++j;
    return read_.chain.joints[j].name;
  }

  void add_joint_effects(TiXmlElement& root, TiXmlElement& body, int joint) {
    const std::string& frame =
        robot_.frames[static_cast<std::size_t>(serial::moving_frames(robot_)[joint])].name;
    TiXmlElement* element = named_mjcf_child(body, "joint", before(joint).name);
    const auto mine = [&](const std::string& name) { return name == frame; };
    for (Following each : followings(robot_, effects_.drags)) {
      if (!mine(each.joint) || !element) continue;
      each.leader = model_joint(each.leader);
      free_joint_copy(body, *element, each.name);
      TiXmlElement* equality = root.FirstChildElement("equality");
      if (!equality) equality = root.InsertEndChild(TiXmlElement("equality"))->ToElement();
      equality->InsertEndChild(follow_element(each));
    }
    for (const DeadBand& each : effects_.plays) {
      if (!mine(each.joint) || !element) continue;
      TiXmlElement* play = free_joint_copy(body, *element, each.joint + ".play");
      play->SetAttribute("limited", "true");
      const bool turns = before(joint).motion == serial::Motion::revolute;
      const double half = each.play / 2 * (turns ? mjcf_angle_unit(root) : 1);
      play->SetAttribute("range", mjcf_numbers(Eigen::Vector2d(-half, half)));
    }
    for (const JointSpring& each : effects_.joints)
      if (mine(each.joint) && element)
        set_mjcf_spring(*free_joint_copy(body, *element, each.joint + ".spring"), each.compliance);
    if (!element) unnamed(frame);
  }

  void unnamed(const std::string& joint) {
    const auto needs = [&](const auto& list) {
      return std::ranges::any_of(list, [&](const auto& each) { return each.joint == joint; });
    };
    if (needs(effects_.joints) || needs(effects_.plays) || needs(effects_.drags))
      out_.left_out.push_back("effects of joint " + joint +
                              ", which the file does not call so: give it this name");
  }

  /// The frames are rigid on the bodies: those of the calibrated robot at zero, in the model's
  /// world where their axes are the joints' own.
  void bend_links() {
    if (effects_.links.empty() && effects_.tools.empty()) return;
    const auto joints = static_cast<Eigen::Index>(read_.chain.joints.size());
    const std::vector<Isometry3d> frames =
        serial::frame_poses(robot_, Eigen::VectorXd::Zero(joints));
    const std::vector<int> moving = serial::moving_frames(robot_);
    for (std::size_t j = 0; j < moving.size(); ++j) {
      const Isometry3d& X_WJ = after(static_cast<int>(j)).X_WJ;
      const Eigen::Vector3d axis = X_WJ.linear() * after(static_cast<int>(j)).axis;
      if (frames[static_cast<std::size_t>(moving[j])].linear().col(2).cross(axis).norm() >
          kOnAxis) {
        out_.left_out.emplace_back("springs of links: the robot's world is not the model's");
        return;
      }
    }
    // From the base on: each time the bodies behind are found anew.
    for (const serial::Frame& frame : robot_.frames)
      for (const BodySpring& each : effects_.links)
        if (each.frame == frame.name) bend(each, frames, true);
    for (const BodySpring& each : effects_.tools) bend(each, frames, false);
  }

  void bend(const BodySpring& spring, const std::vector<Isometry3d>& frames, bool along) {
    const auto found = std::ranges::find(robot_.frames, spring.frame, &serial::Frame::name);
    const auto frame = static_cast<std::size_t>(found - robot_.frames.begin());
    std::size_t b = 0;  // the body of the frame's joint
    const std::vector<int> moving = serial::moving_frames(robot_);
    const auto joint = std::ranges::find(moving, static_cast<int>(frame)) - moving.begin();
    while (b < read_.bodies.size() &&
           std::ranges::find(read_.bodies[b].joints, static_cast<int>(joint)) ==
               read_.bodies[b].joints.end())
      ++b;
    if (b + 1 >= read_.bodies.size()) {
      out_.left_out.push_back("springs of link " + spring.frame +
                              ": the model has no body behind it to carry");
      return;
    }
    const Eigen::Vector3d next =
        along ? Eigen::Vector3d((frames[frame].inverse() * frames[frame + 1]).translation())
              : Eigen::Vector3d(Eigen::Vector3d::Zero());
    const std::vector<SprungBody> bodies =
        along ? bending_bodies(spring, next) : std::vector<SprungBody>{mounting_body(spring)};
    const TiXmlElement kept = *elements_[b + 1];
    TiXmlElement* parent = elements_[b + 1]->Parent()->ToElement();
    parent->RemoveChild(elements_[b + 1]);
    for (const SprungBody& each : bodies) {
      const Isometry3d X = frames[frame] * Eigen::Translation3d(each.p);
      TiXmlElement made = sprung_element(each);
      place_mjcf(made, carriers_[b + 1].inverse() * X);
      parent = parent->InsertEndChild(made)->ToElement();
      carriers_[b + 1] = X;
    }
    relocate(b + 1, *parent->InsertEndChild(kept)->ToElement());
    place_body(b + 1, carriers_[b + 1].inverse() * placed_[b + 1]);
  }

  /// The elements of the bodies from `b` on, the first of which is now `element`.
  void relocate(std::size_t b, TiXmlElement& element) {
    std::vector<TiXmlElement*> inside = {&element};
    list_mjcf_bodies(element, inside);
    const int first = read_.bodies[b].place;
    for (std::size_t i = b; i < elements_.size(); ++i)
      elements_[i] = inside[static_cast<std::size_t>(read_.bodies[i].place - first)];
  }

  const MujocoChain& read_;
  const CorrectedChain& corrected_;
  const serial::Model& robot_;
  const MjcfEffects& effects_;
  TiXmlDocument document_;
  std::vector<TiXmlElement*> elements_;        ///< of the bodies that carry the tool
  std::vector<Isometry3d> placed_, carriers_;  ///< where they and what carries them stand now
  MjcfText out_;
};

}  // namespace

Result<MjcfText> mjcf_like(const std::string& text, const std::string& file,
                           const MujocoChain& read, const CorrectedChain& corrected,
                           const serial::Model& robot, const MjcfEffects& effects) {
  return MendedModel(read, corrected, robot, effects).run(text, file);
}

}  // namespace selfcal
