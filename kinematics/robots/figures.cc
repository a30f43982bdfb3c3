#include "kinematics/robots/figures.h"

namespace selfcal {

void read_beside(Fields& of, const std::vector<Named>& names, Problems& problems,
                 PartFigures& figures) {
  for (const Named& each : names) figures.nominal[each.at] = figures.value[each.at];
  const auto read = [&](const char* key, const auto& take) {
    const Node* node = of.node(key);
    if (!node) return;
    Fields fields(*node, of.what() + " " + key, problems);
    for (const Named& each : names)
      if (const auto value = fields.optional_number(each.name)) take(each.at, *value);
    fields.refuse_unknown();
  };
  read("tolerance", [&](int at, double value) {
    figures.tolerance[at] = value;
    if (!(value > 0 && value < 1)) of.fail("tolerance", "1 sigma each, above 0 and below 1");
  });
  read("nominal", [&](int at, double value) { figures.nominal[at] = value; });
}

std::optional<Eigen::Vector2d> read_travel(Fields& drive) {
  const auto limits = drive.numbers("limits", 2);
  if (!limits) return std::nullopt;
  if (!((*limits)[0] < (*limits)[1])) drive.fail("limits", "a lower and a higher reading");
  if (!(limits->cwiseAbs().maxCoeff() <= kLongestPart))
    drive.fail("limits", "metres, at most " + format_number(kLongestPart) + " (millimetres?)");
  return *limits;
}

bool write_beside(const PartFigures& figures, const std::vector<Named>& names, Node& into) {
  Node tolerance = Node::map(), nominal = Node::map();
  for (const Named& each : names) {
    if (figures.tolerance[each.at] > 0)
      tolerance.set(each.name, Node::of(figures.tolerance[each.at]));
    if (figures.nominal[each.at] != figures.value[each.at])
      nominal.set(each.name, Node::of(figures.nominal[each.at]));
  }
  const bool any = !tolerance.items.empty() || !nominal.items.empty();
  if (!tolerance.items.empty()) into.set("tolerance", std::move(tolerance));
  if (!nominal.items.empty()) into.set("nominal", std::move(nominal));
  return any;
}

void take_figures(const PartFigures& figures, int at, double silent, Parameter& p) {
  p.value = figures.value[at];
  p.nominal = figures.nominal[at];
  p.tolerance = figures.tolerance[at] > 0 ? figures.tolerance[at] : silent;
}

}  // namespace selfcal
