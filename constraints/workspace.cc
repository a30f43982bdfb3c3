#include "constraints/workspace.h"

#include <numbers>

namespace selfcal {

Workspace read_workspace(const Node& node, Problems& problems) {
  Workspace workspace;
  Fields fields(node, "workspace", problems);
  const Node* box = fields.node("box");
  Eigen::Vector3d corner[2];
  bool given = box != nullptr && box->kind == Node::Kind::list && box->items.size() == 2;
  for (std::size_t i = 0; given && i < 2; ++i) {
    Node one = Node::map();
    one.place = box->place;
    one.set("corner", box->items[i]);
    const auto numbers = Fields(one, "workspace box", problems).numbers("corner", 3);
    given = numbers && numbers->cwiseAbs().maxCoeff() <= kFarthestPlace;
    if (given) corner[i] = *numbers;
  }
  if (!given || !((corner[1] - corner[0]).minCoeff() > 0))
    fields.fail("box", "two opposite corners [[x, y, z], [x, y, z]] in metres, the smaller first");
  else
    workspace.box = Eigen::AlignedBox3d(corner[0], corner[1]);
  if (fields.has("approach") != fields.has("cone")) fields.fail("approach", "together with `cone`");
  if (const auto approach = fields.numbers("approach", 3)) {
    if (!(approach->norm() > 0)) fields.fail("approach", "a direction");
    workspace.approach = approach->normalized();
    workspace.cone = fields.number("cone", 1, 1e-3, std::numbers::pi);
  }
  fields.refuse_unknown();
  return workspace;
}

}  // namespace selfcal
