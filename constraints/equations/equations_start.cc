// First own and group values: those that fit the rows best with the robot as it is.
#include <algorithm>
#include <map>

#include "constraints/equations/equations.h"

namespace selfcal {
namespace {

/// Rows that a start is made from: enough for any method, few enough for a million rows.
constexpr int kMostRows = 3000;

class Locator {
 public:
  Locator(const Equations& equations, const Eigen::VectorXd& xi) : equations_(equations), xi_(xi) {}

  /// Locations of the body at the given rows.
  std::vector<Location> at(const std::vector<int>& rows, Body body) const {
    const Eigen::MatrixXd& q = equations_.data().rows.q;
    std::vector<Location> list;
    ConfigurationBlock block;
    block.q.resize(kLanes, q.cols());
    Locations X;
    for (size_t first = 0; first < rows.size(); first += kLanes) {
      const size_t count = std::min<size_t>(kLanes, rows.size() - first);
      for (size_t lane = 0; lane < kLanes; ++lane)
        block.q.row(static_cast<Eigen::Index>(lane)) =
            q.row(rows[first + std::min(lane, count - 1)]).array();
      block.count = static_cast<int>(count);
      equations_.robot().locate(block, xi_, body, X, nullptr);
      for (int lane = 0; lane < block.count; ++lane) list.push_back(X.at(lane));
    }
    return list;
  }

  /// Those of the rows that the robot can take with these parameters; all when it can take none,
  /// for then the start is worth nothing anyway.
  std::vector<int> closing(std::vector<int> rows, Body body) const {
    if (!equations_.robot().has_loops()) return rows;
    std::vector<int> closed;
    for (size_t first = 0; first < rows.size(); first += kLanes) {
      const auto at = rows.begin() + static_cast<std::ptrdiff_t>(first);
      const std::vector<int> some(at, at + std::min<std::ptrdiff_t>(kLanes, rows.end() - at));
      const Closure closure = equations_.closure_at(some, body, xi_);
      for (size_t lane = 0; lane < some.size(); ++lane)
        if (closure.closes(static_cast<int>(lane))) closed.push_back(some[lane]);
    }
    return closed.empty() ? rows : closed;
  }

  /// The endpoint in the last moving link.
  Location tool(int row) const {
    const Location end = at({row}, Body::endpoint)[0], link = at({row}, Body::last_link)[0];
    return {link.R.transpose() * end.R, link.R.transpose() * (end.p - link.p)};
  }

 private:
  const Equations& equations_;
  const Eigen::VectorXd& xi_;
};

std::vector<int> thinned(const std::vector<SetPlan::Item>& items, int first, int last) {
  const int step = std::max(1, (last - first) / kMostRows);
  std::vector<int> rows;
  for (int i = first; i < last; i += step) rows.push_back(items[i].row);
  return rows;
}

/// Moves locations so that their mean is that of others.
void move_to_mean_of(const std::vector<Location>& others, std::vector<Location>& moved) {
  Eigen::Vector3d by = Eigen::Vector3d::Zero();
  for (const Location& each : others) by += each.p / static_cast<double>(others.size());
  for (const Location& each : moved) by -= each.p / static_cast<double>(moved.size());
  for (Location& each : moved) each.p += by;
}

}  // namespace

void Equations::start(State& state) const {
  const Locator locator(*this, state.xi);
  const auto rows_of = [&](int set) {
    const std::vector<SetPlan::Item>& items = plans_[set].items;
    return locator.closing(thinned(items, 0, static_cast<int>(items.size())),
                           data_.sets[set].method->body());
  };
  state.nuisance.resize(data_.sets.size());
  state.groups.resize(data_.sets.size());
  for (const bool referring : {false, true})
    for (int s = 0; s < static_cast<int>(plans_.size()); ++s) {
      const Set& set = data_.sets[s];
      const SetPlan& plan = plans_[s];
      if ((set.reference >= 0) != referring || plan.items.empty()) continue;
      const std::vector<int> rows = rows_of(s);
      std::vector<Location> X = locator.at(rows, set.method->body());
      for (int other = 0; other < static_cast<int>(plans_.size()); ++other) {
        if (data_.sets[other].reference != s || plans_[other].items.empty()) continue;
        std::vector<Location> like = locator.at(rows_of(other), data_.sets[other].method->body());
        move_to_mean_of(X, like);
        X.insert(X.end(), like.begin(), like.end());
      }
      state.nuisance[s] = set.method->start(X, rows, data_.rows,
                                            referring ? &state.nuisance[set.reference] : nullptr,
                                            locator.tool(rows.front()));
      if (set.method->group_freedom() == 0) continue;
      std::map<int, std::vector<int>> by_group;
      for (const SetPlan::Item& item : plan.items)
        by_group[data_.rows.group[item.row]].push_back(item.row);
      for (auto& [group, members] : by_group) {
        if (members.size() > kMostRows) members.resize(kMostRows);
        members = locator.closing(std::move(members), set.method->body());
        const Eigen::VectorXd values =
            set.method->start_group(locator.at(members, set.method->body()));
        if (state.groups[s].rows() != values.size())
          state.groups[s].setZero(values.size(), static_cast<Eigen::Index>(set.groups.size()));
        state.groups[s].col(group) = values;
      }
    }
}

}  // namespace selfcal
