// joint_compliance by one number, link_compliance and tool_compliance by springs; backlash by load
// is a dead band, but by the last motion it is none, for bodies at rest have come from nowhere;
// joint_coupling is an equality.
#include "io/models/mjcf_effects.h"

#include <algorithm>
#include <optional>

namespace selfcal {
namespace {

constexpr double kRigid = 1e-12;  // rad/(N m): a nanometre by a kilonewton at a metre

double number_in(const Node& entry, const std::string& key) {
  const Node* node = entry.find(key);
  return node ? written_number(node->text).value_or(0) : 0;
}

std::string text_in(const Node& entry, const char* key) {
  const Node* node = entry.find(key);
  return node ? node->text : std::string();
}

/// Index of the frame called `name`, or -1.
int frame_called(const serial::Model& model, const std::string& name) {
  const auto found = std::ranges::find(model.frames, name, &serial::Frame::name);
  return found == model.frames.end() ? -1 : static_cast<int>(found - model.frames.begin());
}

/// Takes one entry, or says why not; an empty reason says nothing more than its name.
class Taking {
 public:
  Taking(const serial::Model& model, MjcfEffects& into) : model_(model), into_(into) {}

  void take(const Node& entry) {
    const std::string effect = text_in(entry, "effect"), at = text_in(entry, "at");
    const std::string why = refused(entry, effect, at);
    if (why == kTaken) return;
    into_.left_out.push_back("the effect " + effect + (at.empty() ? "" : " at " + at) +
                             (why.empty() ? "" : ": " + why));
  }

 private:
  static constexpr const char* kTaken = "taken";
  static constexpr const char* kBends[] = {"bend_x", "bend_y", "twist"};

  std::string refused(const Node& entry, const std::string& effect, const std::string& at) {
    if (effect == "joint_compliance") return spring(number_in(entry, "c"), at);
    if (effect == "link_compliance") return link(entry, at);
    if (effect == "tool_compliance") return tool(entry);
    if (effect == "backlash") return dead_band(entry, at);
    if (effect != "joint_coupling") return {};
    into_.drags.push_back({at, text_in(entry, "from"), 0});
    into_.drags.back().kappa = number_in(entry, "kappa_" + into_.drags.back().from);
    return kTaken;
  }

  std::string spring(double compliance, const std::string& at) {
    if (!(compliance > 0)) return "by masses of its own, not by one positive compliance";
    into_.joints.push_back({at, compliance});
    return kTaken;
  }

  /// Those of an entry that are springs. One below zero, which noise makes of one that is hardly
  /// there, is none: it is left out and named. One that moves nothing would be a spring beside
  /// which others lose their digits.
  std::optional<Eigen::Vector3d> bends(const Node& entry, const std::string& effect) {
    Eigen::Vector3d compliance = Eigen::Vector3d::Zero();
    std::vector<std::string> below;
    for (int i = 0; i < 3; ++i) {
      const char* const name = kBends[i];
      compliance[i] = number_in(entry, name);
      if (compliance[i] < 0) below.emplace_back(name);
    }
    compliance = (compliance.array() < kRigid).select(0, compliance);
    if (!below.empty() && compliance.isZero()) return std::nullopt;
    for (const std::string& each : below)
      into_.left_out.push_back("of " + effect + " " + each + ", which is below zero");
    return compliance;
  }

  std::string link(const Node& entry, const std::string& at) {
    const int frame = frame_called(model_, at);
    if (frame + 1 >= static_cast<int>(model_.frames.size())) return "no frame behind it to carry";
    if (model_.frames[frame + 1].motion == serial::Motion::prismatic)
      return "its length changes with the slide behind it";
    const auto compliance = bends(entry, "link_compliance at " + at);
    if (!compliance) return "a negative compliance";
    into_.links.push_back({at, *compliance});
    return kTaken;
  }

  std::string tool(const Node& entry) {
    const int last = serial::moving_frames(model_).back();
    if (last + 1 == static_cast<int>(model_.frames.size())) return "no tool frame to carry";
    if (text_in(entry, "by") == "tool")
      return "the tool itself bends, which takes more than springs";
    if (number_in(entry, "mass") > 0) return "its tool's frames have no mass";
    const auto compliance = bends(entry, "tool_compliance");
    if (!compliance) return "a negative compliance";
    into_.tools.push_back({model_.frames[last].name, *compliance});
    return kTaken;
  }

  std::string dead_band(const Node& entry, const std::string& at) {
    if (text_in(entry, "by") != "load")
      return "its side is that of the last motion, and a model at rest has none";
    const double play = number_in(entry, "play");
    if (!(play > 0)) return "no positive play";
    into_.plays.push_back({at, play});
    return kTaken;
  }

  const serial::Model& model_;
  MjcfEffects& into_;
};

}  // namespace

std::vector<Following> followings(const serial::Model& robot, const std::vector<Drag>& drags) {
  const std::vector<int> moving = serial::moving_frames(robot);
  const auto n = static_cast<Eigen::Index>(moving.size());
  const Eigen::MatrixXd coupling =
      robot.coupling.size() > 0 ? robot.coupling : Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n));
  const auto dragged = [&](const std::string& joint, const std::string& from) {
    double kappa = 0;
    for (const Drag& drag : drags)
      if (drag.joint == joint && drag.from == from) kappa += drag.kappa;
    return kappa;
  };
  const auto frame = [&](Eigen::Index j) -> const serial::Frame& {
    return robot.frames[static_cast<size_t>(moving[static_cast<size_t>(j)])];
  };
  std::vector<Following> list;
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i) {
      const double factor =
          coupling(j, i) * frame(i).gear - (i == j ? 1 : 0) + dragged(frame(j).name, frame(i).name);
      if (factor != 0)
        list.push_back(
            {frame(j).name, frame(i).name, frame(j).name + ".of." + frame(i).name, factor});
    }
  return list;
}

MjcfEffects mjcf_effects(const Node& robot, const serial::Model& model) {
  MjcfEffects effects;
  if (const Node* entries = robot.find("effects"))
    for (const Node& entry : entries->items) Taking(model, effects).take(entry);
  return effects;
}

}  // namespace selfcal
