// Rows of one group share the endpoint's position, an unknown c (11.48 to 11.50, first three
// equations, here against the shared point rather than row against row, so that groups may have any
// size):
//   r = P(q) - c,   dr = dP - dc
// Two groups' points may be a known distance apart: |c_a - c_b| - D with its own noise.
#include <algorithm>

#include "constraints/methods/maker.h"
#include "constraints/methods/shared/shared_point.h"
#include "constraints/statistics.h"

namespace selfcal {
namespace {

class PositionConstraint final : public Method {
 public:
  PositionConstraint(std::vector<GroupDistance> links, std::vector<std::string> names)
      : links_(std::move(links)), names_(std::move(names)) {}

  std::string_view name() const override { return "position-constraint"; }
  std::vector<Quantity> equations() const override { return {3, Quantity::length}; }
  std::vector<std::string> columns() const override { return {"group"}; }
  Planned planned() const override { return Planned::places; }
  bool vectors() const override { return true; }
  bool may_leave_scale_free() const override { return true; }
  int group_freedom() const override { return 3; }
  std::vector<std::string> group_names() const override { return {"x", "y", "z"}; }
  std::vector<GroupDistance> links() const override { return links_; }
  std::vector<KnownLength> known_lengths() const override {
    std::vector<KnownLength> list;
    for (const GroupDistance& link : links_)
      list.push_back({"distance of " + names_[link.a] + " from " + names_[link.b], link.distance,
                      link.noise, false});
    return list;
  }

  Eigen::VectorXd start_group(const std::vector<Location>& X) const override {
    Eigen::Vector3d c;
    for (int i = 0; i < 3; ++i) {
      std::vector<double> v;
      for (const Location& each : X) v.push_back(each.p[i]);
      c[i] = median(std::move(v));
    }
    return c;
  }
  void retract_group(Eigen::Ref<Eigen::VectorXd> group,
                     const Eigen::VectorXd& step) const override {
    group += step;
  }

  double link_residual(const GroupDistance& link, const Eigen::VectorXd& a,
                       const Eigen::VectorXd& b, Eigen::VectorXd& D_a,
                       Eigen::VectorXd& D_b) const override {
    const double length = (a - b).norm();
    D_a = length > 0 ? Eigen::VectorXd((a - b) / length) : Eigen::VectorXd::Zero(3);
    D_b = -D_a;
    return length - link.distance;
  }

  void evaluate(const MethodInput& in, MethodOutput& out) const override {
    for (int lane = 0; lane < in.count; ++lane) {
      const Eigen::Vector3d c = in.groups->col(in.data->group[in.rows[lane]]);
      out.r.row(lane) = (in.now->p(lane) - c).transpose();
      for (int a = 0; a < 3; ++a) {
        set_linear(out.G_now, lane, a, Eigen::Vector3d::Unit(a));
        out.D_group.row(lane).segment<3>(3 * a) = -Eigen::RowVector3d::Unit(a);
      }
    }
  }

 private:
  std::vector<GroupDistance> links_;
  std::vector<std::string> names_;  ///< of the groups that the links know by their index
};

GroupDistance read_link(const Node& node, SetEntry& entry) {
  Fields fields(node, entry.fields.what() + " apart", entry.problems);
  GroupDistance link;
  const std::vector<std::string> names = fields.texts("groups");
  if (names.size() == 2 && names[0] != names[1]) {
    link.a = group_index(entry.groups, names[0]);
    link.b = group_index(entry.groups, names[1]);
  } else {
    fields.fail("groups", "two different groups, [FIRST, SECOND]");
  }
  const Apart apart = read_apart(fields);
  link.distance = apart.distance;
  link.noise = apart.noise;
  fields.refuse_unknown();
  return link;
}

}  // namespace

MethodPtr make_position_constraint(SetEntry& entry) {
  std::vector<GroupDistance> links;
  if (const Node* list = entry.fields.node("apart")) {
    if (list->kind != Node::Kind::list)
      entry.fields.fail("apart", "a list of {groups: [A, B], distance: D, noise: S}");
    for (const Node& item : list->items) {
      GroupDistance link = read_link(item, entry);
      link.known = static_cast<int>(links.size());
      if (std::ranges::any_of(links, [&](const GroupDistance& other) {
            return std::minmax(link.a, link.b) == std::minmax(other.a, other.b);
          }))
        entry.problems.add(item.place, "these two groups are apart already");
      links.push_back(link);
    }
  }
  return std::make_unique<PositionConstraint>(std::move(links), entry.groups);
}

std::shared_ptr<const Method> shared_point() {
  return std::make_shared<PositionConstraint>(std::vector<GroupDistance>(),
                                              std::vector<std::string>());
}

}  // namespace selfcal
