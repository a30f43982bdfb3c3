#include "app/commands/support/leg_start.h"

#include <algorithm>

#include "constraints/axes/leg_figures.h"
#include "constraints/equations/equations.h"
#include "io/files/robot_file.h"
#include "io/files/yaml.h"

namespace selfcal {
namespace {

constexpr double kMayStayOpen = 0.1;  // of the rows

/// The file's description with values `xi`, which are the maker's from now on.
Node as_made(const Robot& robot, const Eigen::VectorXd& xi) {
  Node node = robot.text().describe(xi);
  for (const char* part : {"legs", "chains"})
    if (const Node* list = node.find(part)) {
      Node chains = Node::list();
      for (const Node& each : list->items) chains.items.push_back(each.without({"nominal"}));
      node = node.without({part});
      node.set(part, std::move(chains));
    }
  return node;
}

}  // namespace

Result<std::shared_ptr<const Robot>> leg_start(const LoadedDataSet& loaded) {
  const auto* platform = dynamic_cast<const platform::Platform*>(loaded.robot.get());
  if (!platform || !of_locations_alone(loaded.data)) return std::shared_ptr<const Robot>();
  const Equations equations(*loaded.robot, loaded.data, Use::fit);
  const double open = static_cast<double>(equations.open_rows().size());
  const auto rows = static_cast<double>(std::ranges::count(loaded.data.rows.check, char{0}));
  if (open <= kMayStayOpen * rows) return std::shared_ptr<const Robot>();
  const LegFigures found = leg_figures(*platform, loaded.data, nominal_values(*platform));
  if (!found.problem.empty())
    return bad_input(loaded.name + ": the loops of " + platform->name() + " do not close at " +
                     format_number(open) + " of " + format_number(rows) + " locations, and " +
                     found.problem);
  return robot_of(write_yaml(as_made(*platform, found.xi)), "the platform of its chains");
}

}  // namespace selfcal
