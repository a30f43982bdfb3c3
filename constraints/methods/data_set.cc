// Making a set from its entry in the file, and tying sets together that share unknowns.
#include "constraints/methods/data_set.h"

#include <algorithm>

#include "constraints/methods/maker.h"
#include "kinematics/readable.h"

namespace selfcal {

#define X(identifier, text) MethodPtr make_##identifier(SetEntry& entry);
#include "constraints/methods.def"
#undef X

namespace {

struct MethodKind {
  std::string_view name;
  MethodPtr (*make)(SetEntry&);
};

constexpr MethodKind kMethodKinds[] = {
#define X(identifier, text) {text, make_##identifier},
#include "constraints/methods.def"
#undef X
};

double read_noise(Fields& fields, const char* key) {
  const double noise = fields.number(key, 0);
  if (fields.has(key) && !(noise > 0 && noise < 1))
    fields.fail(key, "1 sigma of one residual, above 0 and below 1 (m or rad)");
  return noise;
}

/// Resolves references between sets and checks that they are possible.
void link_sets(std::vector<Set>& sets, const Node& node, Problems& problems) {
  for (Set& set : sets) {
    if (!set.method || set.method->reference().empty()) continue;
    const std::string wanted = set.method->reference();
    const auto other = std::find_if(sets.begin(), sets.end(),
                                    [&](const Set& each) { return each.name == wanted; });
    const Node* entry = node.find(set.name);
    const Place place = entry ? entry->place : node.place;
    if (other == sets.end())
      problems.add(place, "set " + set.name + ": parallel_to names no set '" + wanted + "'");
    else if (!other->method || !set.method->can_refer_to(*other->method))
      problems.add(place, "set " + set.name + ": parallel_to needs a set of method plane that is " +
                              "not itself parallel to another, '" + wanted + "' is not");
    else
      set.reference = static_cast<int>(other - sets.begin());
  }
}

/// {place: m, turn: rad, length: m}
GivenTolerance read_given(const Node& node, Problems& problems) {
  Fields fields(node, "tolerance", problems);
  GivenTolerance given;
  for (const auto& [key, value] :
       {std::pair{"place", &given.place}, {"turn", &given.turn}, {"length", &given.length}})
    if (fields.has(key)) *value = fields.number(key, 0, 0, 1);
  fields.refuse_unknown();
  return given;
}

}  // namespace

int group_index(std::vector<std::string>& groups, const std::string& name) {
  const auto found = std::find(groups.begin(), groups.end(), name);
  if (found == groups.end()) {
    groups.push_back(name);
    return static_cast<int>(groups.size()) - 1;
  }
  return static_cast<int>(found - groups.begin());
}

bool read_unknown(Fields& fields, std::string_view key) {
  if (!fields.has(key)) return false;
  if (fields.text(key) != "unknown") fields.fail(key, "'unknown', or the key left out");
  return true;
}

Apart read_apart(Fields& fields) {
  const Apart apart{fields.length("distance", 0), fields.number("noise")};
  if (!fields.has("distance") || apart.distance < 0)
    fields.fail("distance", "a distance of at least 0 m");
  if (!(apart.noise > 0 && apart.noise < 1)) fields.fail("noise", "a positive 1 sigma below 1 m");
  return apart;
}

std::optional<Eigen::Vector3d> read_direction(Fields& fields, std::string_view key) {
  const auto v = fields.numbers(key, 3);
  if (!v) return std::nullopt;
  if (v->norm() < 1e-9) fields.fail(key, "a direction that is not zero");
  return Eigen::Vector3d(v->normalized());
}

Set make_set(const std::string& name, const Node& node, Problems& problems) {
  Set set;
  set.name = name;
  Fields fields(node, "set " + name, problems);
  const std::string method = fields.text("method");
  SetEntry entry{name, fields, problems, set.groups};
  for (const MethodKind& kind : kMethodKinds)
    if (kind.name == method) set.method = kind.make(entry);
  if (!set.method) {
    std::string known;
    for (const MethodKind& kind : kMethodKinds)
      known += (known.empty() ? "" : ", ") + std::string(kind.name);
    fields.fail("method", "one of " + known);
    return set;
  }
  set.noise = read_noise(fields, "noise");
  if (set.method->has_angles()) set.noise_angle = read_noise(fields, "noise_angle");
  set.noise_joints = read_noise(fields, "noise_joints");
  if (set.noise_joints > 0 && !set.method->every_row_alone())
    fields.fail("noise_joints", "nothing, for the rows of this method have unknowns in common");
  if (const Node* tolerance = fields.node("tolerance")) {
    set.given = read_given(*tolerance, problems);
    if (!set.method->place_known() && set.method->known_lengths().empty())
      fields.fail("tolerance", "nothing, for the entry gives no surface, centre or radius");
  }
  if (!set.method->has_lengths()) {
    if (!(set.noise_angle > 0)) set.noise_angle = set.noise;
    set.noise = 0;
  }
  fields.refuse_unknown();
  set.options = node.without({"noise", "noise_angle", "noise_joints", "tolerance"});
  return set;
}

std::vector<Set> read_sets(const Node& node, Problems& problems) {
  std::vector<Set> sets;
  if (node.kind != Node::Kind::map || node.items.empty()) {
    problems.add(node.place, "sets: expected one set or more, each as `name: {method: ...}`");
    return sets;
  }
  for (std::size_t i = 0; i < node.keys.size(); ++i) {
    if (has_control(node.keys[i]))
      problems.add(node.items[i].place, "sets: a name with a control character");
    if (node.keys[i].empty()) problems.add(node.items[i].place, "sets: a set has no name");
    sets.push_back(make_set(node.keys[i], node.items[i], problems));
  }
  if (!problems.any()) link_sets(sets, node, problems);
  return sets;
}

std::string lacking_body(const Robot& robot, const std::vector<Set>& sets) {
  for (const Set& set : sets) {
    if (set.method && !has_body(robot, set.method->body()))
      return "set " + set.name + ": this " + std::string(robot.kind()) +
             " robot has no such joint to lock";
    const std::string joint = set.method ? set.method->turning_joint() : "";
    if (joint.empty()) continue;
    const int j = find_joint(robot, joint);
    if (j < 0 || robot.joints()[static_cast<std::size_t>(j)].quantity != Quantity::angle)
      return "set " + set.name + ": " + robot.name() + " has no joint '" + joint + "' that turns";
  }
  return {};
}

int same_set(const std::vector<Set>& sets, const Set& set) {
  const auto same = std::find_if(sets.begin(), sets.end(), [&](const Set& other) {
    return other.name == set.name && other.method->name() == set.method->name() &&
           alike(other.options, set.options);
  });
  return same == sets.end() ? -1 : static_cast<int>(same - sets.begin());
}

namespace {

/// Puts what the second has of sets and groups behind the first's, and its rows into these terms.
void adopt(DataSet& first, const std::vector<Set>& sets, Observations& rows) {
  const std::vector<Set> nuisance = first.sets;
  std::vector<int> set_of, first_group;
  for (const Set& set : sets) {
    const int same = same_set(nuisance, set);
    set_of.push_back(same >= 0 ? same : static_cast<int>(first.sets.size()));
    first_group.push_back(same >= 0 ? static_cast<int>(first.sets[same].groups.size()) : 0);
    if (same < 0) {
      first.sets.push_back(set);
      std::string& name = first.sets.back().name;
      while (std::ranges::find(nuisance, name, &Set::name) != nuisance.end()) name += "'";
      continue;
    }
    for (const std::string& group : set.groups) first.sets[same].groups.push_back(group + "'");
  }
  for (size_t s = nuisance.size(); s < first.sets.size(); ++s)
    if (first.sets[s].reference >= 0) first.sets[s].reference = set_of[first.sets[s].reference];
  for (size_t row = 0; row < rows.set.size(); ++row) {
    if (rows.group[row] >= 0) rows.group[row] += first_group[rows.set[row]];
    rows.set[row] = set_of[rows.set[row]];
  }
}

}  // namespace

std::string lacking_reference(const DataSet& data) {
  std::vector<int> fitted(data.sets.size(), 0), judging = fitted;
  for (int row = 0; row < data.rows.rows(); ++row)
    ++(data.rows.check[row] ? judging : fitted)[data.rows.set[row]];
  for (size_t s = 0; s < data.sets.size(); ++s) {
    const int other = data.sets[s].reference;
    if (other < 0 || fitted[s] + judging[s] == 0 || fitted[other] > 0) continue;
    if (fitted[s] == 0 && judging[other] > 0) continue;
    return "set " + data.sets[s].name + " is parallel to " + data.sets[other].name +
           ", which has no `" + (fitted[s] > 0 ? "fit" : "fit` or `check") + "` rows";
  }
  return {};
}

DataSet merged(const DataSet& before, const DataSet& after) {
  DataSet all = before;
  Observations later = after.rows;
  adopt(all, after.sets, later);
  int most_repeat = 0;
  for (const int repeat : before.rows.repeat) most_repeat = std::max(most_repeat, repeat + 1);
  for (int& repeat : later.repeat)
    if (repeat >= 0) repeat += most_repeat;
  if (before.rows.time.size() > 0 && later.time.size() > 0)
    later.time.array() += before.rows.time.maxCoeff<Eigen::PropagateNumbers>() -
                          later.time.minCoeff<Eigen::PropagateNumbers>();
  all.rows = joined(before.rows, later);
  all.order_is_time = before.order_is_time || after.order_is_time;
  return all;
}

std::vector<std::string_view> method_names() {
  std::vector<std::string_view> names;
  for (const MethodKind& kind : kMethodKinds) names.push_back(kind.name);
  return names;
}

}  // namespace selfcal
