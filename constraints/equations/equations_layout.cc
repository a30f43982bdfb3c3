// Which columns the rows of one set have. Rows of a set know nothing of what others own: they are
// gathered in the few columns that they have, and only what is left of them once the set's own are
// eliminated meets the other sets. So a hundred sets cost as much a row as one.
#include <numeric>

#include "constraints/equations/equations_inner.h"

namespace selfcal {
namespace {

template <class Layout>
void add_robot(const std::vector<int>& columns, Layout& layout) {
  for (size_t i = 0; i < columns.size(); ++i) {
    const int at = static_cast<int>(layout.global.size());
    if (!layout.robot.empty() && columns[i] == layout.robot.back().from + layout.robot.back().count)
      ++layout.robot.back().count;
    else
      layout.robot.push_back({columns[i], at, 1});
    layout.global.push_back(static_cast<int>(i));
  }
}

/// `count` columns that stand from `global` on in the system; where they stand here.
template <class Layout>
int add_columns(int global, int count, Layout& layout) {
  const int at = layout.width();
  for (int i = 0; i < count; ++i) layout.global.push_back(global + i);
  return at;
}

}  // namespace

Equations::Layout Equations::whole_layout(int set, bool beside) const {
  std::vector<int> robot(static_cast<size_t>(robot_columns()));
  std::iota(robot.begin(), robot.end(), 0);
  Layout layout;
  add_robot(robot, layout);
  add_columns(robot_columns(), nuisance_columns(), layout);
  layout.own = nuisance_at_[set];
  const int reference = data_.sets[set].reference;
  if (reference >= 0) layout.reference = nuisance_at_[reference];
  if (beside) {
    layout.motions = add_columns(layout.width(), kMotions, layout);
    layout.known = add_columns(layout.width(), known_lengths(), layout) + known_at_[set];
  }
  add_columns(layout.width(), 1, layout);
  return layout;
}

Equations::Layout Equations::layout(int set, const Pass& pass) const {
  const int reference = data_.sets[set].reference;
  const int own_from = static_cast<int>(pass.robot.size()) - robot_columns();
  const int beside_from = static_cast<int>(pass.robot.size()) + nuisance_columns();
  Layout layout;
  const auto add_own = [&](int of) {
    return add_columns(own_from + nuisance_at_[of], nuisance_count_[of], layout);
  };
  if (!shared_[set]) layout.own = add_own(set);
  if (pass.beside)
    layout.known =
        add_columns(beside_from + kMotions + known_at_[set],
                    static_cast<int>(data_.sets[set].method->known_lengths().size()), layout);
  layout.lone = layout.width();
  add_robot(pass.robot, layout);
  if (shared_[set]) layout.own = add_own(set);
  if (reference >= 0) layout.reference = add_own(reference);
  if (pass.beside) layout.motions = add_columns(beside_from, kMotions, layout);
  add_columns(pass.width - 1, 1, layout);
  return layout;
}

}  // namespace selfcal
