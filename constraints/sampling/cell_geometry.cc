#include "constraints/sampling/cell_geometry.h"

#include <optional>

namespace selfcal {
namespace {

Eigen::Vector3d read_point(Fields& fields, std::string_view key) {
  const auto point = fields.numbers(key, 3);
  if (!fields.has(key)) fields.fail(key, "[x, y, z] (m)");
  return point ? Eigen::Vector3d(*point) : Eigen::Vector3d::Zero();
}

std::optional<Location> read_place(const Node& node) {
  if (node.kind != Node::Kind::list || (node.items.size() != 3 && node.items.size() != 7))
    return std::nullopt;
  Eigen::VectorXd v(static_cast<Eigen::Index>(node.items.size()));
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    const auto number = written_number(node.items[i].text);
    if (!number) return std::nullopt;
    v[i] = *number;
  }
  Location place{Eigen::Matrix3d::Identity(), v.head<3>()};
  if (v.size() == 3) return place;
  const Eigen::Quaterniond turn(v[3], v[4], v[5], v[6]);
  if (std::abs(turn.norm() - 1) > 1e-3) return std::nullopt;
  place.R = turn.normalized().toRotationMatrix();
  return place;
}

}  // namespace

Eigen::Vector3d read_unit(Fields& fields, std::string_view key) {
  const Eigen::Vector3d direction = read_point(fields, key);
  if (fields.has(key) && direction.norm() < 1e-9) fields.fail(key, "a direction that is not zero");
  return direction.normalized();
}

Surface read_surface(const Node& node, const std::string& what, Problems& problems) {
  Fields fields(node, what, problems);
  Surface surface{read_point(fields, "point"), read_unit(fields, "normal")};
  fields.refuse_unknown();
  return surface;
}

Patch read_patch(const Node& node, const std::string& what, Problems& problems) {
  Fields fields(node, what, problems);
  Patch patch{read_point(fields, "center"), fields.number("radius")};
  if (fields.has("radius") && !(patch.radius > 0)) fields.fail("radius", "a positive radius (m)");
  fields.refuse_unknown();
  return patch;
}

std::vector<Location> read_places(const Node& node, const std::string& what, Problems& problems) {
  std::vector<Location> places;
  for (const Node& each : node.items) {
    const auto place = read_place(each);
    if (!place) {
      problems.add(each.place, what + ": expected [x, y, z] or [x, y, z, qw, qx, qy, qz] (m)");
      return places;
    }
    places.push_back(*place);
  }
  if (places.empty()) problems.add(node.place, what + ": expected a list of places");
  return places;
}

}  // namespace selfcal
