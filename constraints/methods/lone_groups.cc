#include "constraints/methods/lone_groups.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "kinematics/readable.h"

namespace selfcal {

std::string lone_groups(const DataSet& data, int s) {
  const Set& set = data.sets[static_cast<size_t>(s)];
  const auto equations = static_cast<std::ptrdiff_t>(set.method->equations().size());
  std::vector<std::ptrdiff_t> rows(set.groups.size(), 0);
  for (int row = 0; row < data.rows.rows(); ++row)
    if (data.rows.set[row] == s && data.rows.group[row] >= 0)
      ++rows[static_cast<size_t>(data.rows.group[row])];
  std::vector<std::string> lone;
  for (size_t g = 0; g < rows.size(); ++g)
    if (rows[g] > 0 && rows[g] * equations <= set.method->group_freedom() &&
        std::ranges::none_of(set.method->links(), [&](const GroupDistance& link) {
          return std::cmp_equal(link.a, g) || std::cmp_equal(link.b, g);
        }))
      lone.push_back(set.groups[g]);
  if (lone.empty()) return {};
  return "set " + set.name + ": too few rows at " + listed(lone) +
         " to tell anything of the robot: touch there again, or is a name mistyped?";
}

}  // namespace selfcal
