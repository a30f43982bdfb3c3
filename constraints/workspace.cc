#include "constraints/workspace.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace selfcal {

Workspace read_workspace(const Node& node, Problems& problems) {
  Workspace workspace;
  Fields fields(node, "workspace", problems);
  const Node* box = fields.node("box");
  Eigen::Vector3d corner[2];
  bool given = box != nullptr && box->kind == Node::Kind::list && box->items.size() == 2;
  for (std::size_t i = 0; given && i < 2; ++i) {
    const std::vector<Node>& numbers = box->items[i].items;
    given = numbers.size() == 3;
    for (std::size_t k = 0; given && k < 3; ++k) {
      const auto number = parse_number(numbers[k].text);
      given = number && std::abs(*number) <= kFarthestPlace;
      if (given) corner[i][static_cast<Eigen::Index>(k)] = *number;
    }
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
