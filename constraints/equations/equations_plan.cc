// Which rows of a data set take part, in which order, and which groups share unknowns.
#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "constraints/equations/equations.h"

namespace selfcal {
namespace {

using Item = SetPlan::Item;

/// Rows of one set in file order, with their predecessors in the group for paired methods.
std::vector<Item> all_items(const DataSet& data, int set) {
  const bool paired = data.sets[set].method->paired();
  std::vector<Item> items;
  std::map<int, int> last;  // group -> row
  for (int row = 0; row < data.rows.rows(); ++row) {
    if (data.rows.set[row] != set || data.rows.check[row] == kCopy) continue;
    if (!paired) {
      items.push_back({row, -1});
      continue;
    }
    const auto before = last.find(data.rows.group[row]);
    if (before != last.end()) items.push_back({row, before->second});
    last[data.rows.group[row]] = row;
  }
  return items;
}

bool is_check(const DataSet& data, const Item& item) {
  return data.rows.check[item.row] || (item.previous >= 0 && data.rows.check[item.previous]);
}

/// A frame turns about two of its points.
constexpr int kPointsOfFrame = 3, kFrame = 6;

/// The rows that identify give at least as many equations as the set has unknowns of its own,
/// repeats of a configuration counted once: fewer leave it anywhere, and say nothing of other rows.
bool is_placed(const DataSet& data, int set, const std::vector<Item>& items) {
  const Method& method = *data.sets[set].method;
  const auto equations = static_cast<int>(method.equations().size());
  const int fewest = method.tangent_dimension() >= kFrame && equations == 3 ? kPointsOfFrame : 1;
  std::set<int> repeats;
  int configurations = 0;
  for (const Item& item : items) {
    if (is_check(data, item)) continue;
    const int repeat = data.rows.repeat.empty() ? -1 : data.rows.repeat[item.row];
    if (repeat >= 0 && !repeats.insert(repeat).second) continue;
    ++configurations;
    if (configurations >= fewest && configurations * equations >= method.tangent_dimension())
      return true;
  }
  return false;
}

/// Groups of the set that have at least one `fit` item.
std::vector<char> fitted_groups(const DataSet& data, int set, const std::vector<Item>& items) {
  std::vector<char> fitted(data.sets[set].groups.size(), 0);
  for (const Item& item : items)
    if (!is_check(data, item) && data.rows.group[item.row] >= 0)
      fitted[data.rows.group[item.row]] = 1;
  return fitted;
}

/// A link may name a group that has no row at all.
bool has_rows(const std::vector<char>& fitted, int group) {
  return group < static_cast<int>(fitted.size()) && fitted[group];
}

/// Smallest index reachable from each group through links.
std::vector<int> components(int groups, const std::vector<GroupDistance>& links) {
  std::vector<int> root(groups);
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int g) {
    while (root[g] != g) g = root[g] = root[root[g]];
    return g;
  };
  for (const GroupDistance& link : links) {
    const int a = find(link.a), b = find(link.b);
    root[std::max(a, b)] = std::min(a, b);
  }
  for (int g = 0; g < groups; ++g) root[g] = find(g);
  return root;
}

void make_clusters(const DataSet& data, const std::vector<GroupDistance>& links, SetPlan& plan,
                   int groups) {
  const std::vector<int> root = components(groups, links);
  const auto group = [&](const Item& item) { return data.rows.group[item.row]; };
  std::stable_sort(plan.items.begin(), plan.items.end(), [&](const Item& a, const Item& b) {
    return std::pair(root[group(a)], group(a)) < std::pair(root[group(b)], group(b));
  });
  std::map<int, int> cluster_of;  // root -> cluster
  for (int i = 0; i < static_cast<int>(plan.items.size()); ++i) {
    const int g = group(plan.items[i]);
    if (plan.clusters.empty() || root[plan.clusters.back().groups.front()] != root[g]) {
      cluster_of[root[g]] = static_cast<int>(plan.clusters.size());
      plan.clusters.push_back({i, i, {}, {}});
    }
    SetPlan::Cluster& cluster = plan.clusters.back();
    cluster.last = i + 1;
    if (cluster.groups.empty() || cluster.groups.back() != g) cluster.groups.push_back(g);
  }
  for (const GroupDistance& link : links)
    plan.clusters[cluster_of.at(root[link.a])].links.push_back(link);
}

}  // namespace

Closure Equations::closure_at(const std::vector<int>& rows, Body body,
                              const Eigen::VectorXd& xi) const {
  ConfigurationBlock block{Eigen::ArrayXXd(kLanes, data_.rows.q.cols()),
                           static_cast<int>(rows.size())};
  for (size_t lane = 0; lane < kLanes; ++lane)
    block.q.row(static_cast<Eigen::Index>(lane)) =
        data_.rows.q.row(rows[std::min(lane, rows.size() - 1)]).array();
  if (conditions_matter_) {
    std::vector<int> lanes(rows);
    lanes.resize(kLanes, rows.back());
    block.conditions = conditions(data_.rows, lanes);
  }
  Locations X;
  return robot_.locate(block, xi, body, X, nullptr);
}

std::vector<Equations::OpenItem> Equations::take_open(int set,
                                                      std::vector<SetPlan::Item>& items) const {
  if (!robot_.has_loops()) return {};
  std::vector<OpenItem> open;
  std::vector<SetPlan::Item> closed;
  const Body body = data_.sets[set].method->body();
  const Eigen::VectorXd xi = nominal_values(robot_);
  for (size_t first = 0; first < items.size(); first += kLanes) {
    const size_t count = std::min<size_t>(kLanes, items.size() - first);
    std::vector<int> now, before;
    for (size_t i = first; i < first + count; ++i) {
      now.push_back(items[i].row);
      before.push_back(items[i].previous < 0 ? items[i].row : items[i].previous);
    }
    Closure closure = closure_at(now, body, xi);
    closure.add(closure_at(before, body, xi));
    for (size_t lane = 0; lane < count; ++lane)
      if (closure.closes(static_cast<int>(lane)))
        closed.push_back(items[first + lane]);
      else
        open.push_back({items[first + lane], closure.why[lane]});
  }
  items = std::move(closed);
  return open;
}

void Equations::make_plan(int set, Use use) {
  const Method& method = *data_.sets[set].method;
  SetPlan& plan = plans_[set];
  std::vector<Item> items = all_items(data_, set);
  const std::vector<OpenItem> open = take_open(set, items);
  const std::vector<char> fitted = fitted_groups(data_, set, items);
  const bool placed = is_placed(data_, set, items);
  const bool grouped = method.group_freedom() > 0;
  const auto takes_part = [&](const Item& item) {
    const bool check = is_check(data_, item);
    if (use == Use::align)
      return check && (grouped ? !fitted[data_.rows.group[item.row]] : !placed);
    return use == Use::fit ? !check : check;
  };
  for (const OpenItem& each : open)
    if (takes_part(each.item)) open_rows_.push_back({each.item.row, set, each.why});
  std::erase_if(items, [&](const Item& item) { return !takes_part(item); });
  items.shrink_to_fit();
  plan.items = std::move(items);
  if (plan.items.empty()) return;
  if (!grouped || use == Use::check) {
    plan.clusters.push_back({0, static_cast<int>(plan.items.size()), {}, {}});
    return;
  }
  std::vector<GroupDistance> links;
  if (use == Use::fit)
    for (const GroupDistance& link : method.links())
      if (has_rows(fitted, link.a) && has_rows(fitted, link.b)) links.push_back(link);
  make_clusters(data_, links, plan, static_cast<int>(fitted.size()));
}

}  // namespace selfcal
