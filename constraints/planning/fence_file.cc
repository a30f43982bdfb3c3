#include "constraints/planning/fence_file.h"

#include <algorithm>

#include "constraints/sampling/cell_geometry.h"
#include "kinematics/effect.h"

namespace selfcal {
namespace {

constexpr double kThickest = 2;  // m, radius of a capsule

KeepOut read_keep_out(const Node& node, Problems& problems) {
  KeepOut keep;
  Fields fields(node, "keep_out", problems);
  if (!fields.has("min") && !fields.has("max")) {
    const Surface plane = read_surface(node, "keep_out", problems);
    keep.point = plane.point;
    keep.outward = plane.normal;
    return keep;
  }
  const auto least = fields.numbers("min", 3), most = fields.numbers("max", 3);
  if (!least || !most || !((*most - *least).minCoeff() > 0))
    fields.fail("min", "two corners of a box in metres, min: [x, y, z], max: [x, y, z]");
  else
    keep.box = Eigen::AlignedBox3d(Eigen::Vector3d(*least), Eigen::Vector3d(*most));
  fields.refuse_unknown();
  return keep;
}

Capsule read_capsule(const Node& node, const Mechanics& mechanics, Problems& problems) {
  Capsule capsule;
  Fields fields(node, "capsules", problems);
  const std::string frame = fields.text("link");
  const auto link = std::ranges::find(mechanics.links, frame, &Link::frame);
  if (link == mechanics.links.end()) fields.fail("link", "a frame of the robot");
  capsule.link = static_cast<int>(link - mechanics.links.begin());
  const auto from = fields.numbers("from", 3), to = fields.numbers("to", 3);
  if (from && to) {
    capsule.a = *from;
    capsule.b = *to;
  } else {
    fields.fail(from ? "to" : "from", "a place in the link's frame, [x, y, z] in metres");
  }
  capsule.radius = fields.number("radius");
  if (!(capsule.radius > 0 && capsule.radius <= kThickest))
    fields.fail("radius", "above 0 and up to " + format_number(kThickest) + " m");
  fields.refuse_unknown();
  return capsule;
}

/// The items of a list; none, with a problem, of anything else.
std::vector<Node> items_of(const Node* list, const std::string& what, Problems& problems) {
  if (!list) return {};
  if (list->kind != Node::Kind::list) problems.add(list->place, what + ": a list");
  return list->kind == Node::Kind::list ? list->items : std::vector<Node>();
}

}  // namespace

Fence read_fence(const Node* keep_out, const Node* capsules, const Robot& robot,
                 Problems& problems) {
  Fence fence;
  for (const Node& each : items_of(keep_out, "keep_out", problems))
    fence.keep_outs.push_back(read_keep_out(each, problems));
  if (!capsules) return fence;
  if (!robot.statics()) {
    problems.add(capsules->place, "capsules: " + std::string(kNoStatics));
    return fence;
  }
  for (const Node& each : items_of(capsules, "capsules", problems))
    fence.capsules.push_back(read_capsule(each, robot.statics()->mechanics(), problems));
  return fence;
}

}  // namespace selfcal
