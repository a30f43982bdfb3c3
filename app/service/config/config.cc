#include "app/service/config/config.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "app/service/config/config_motion.h"
#include "app/service/config/config_transports.h"
#include "io/dds/participant.h"
#include "io/files/file.h"
#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

const std::vector<std::string_view> kOwnKeys = {"touches", "surface", "within", "places",
                                                "way_out"};

constexpr std::array<std::pair<std::string_view, CommandRules::Over>, 4> kOvers = {
    {{"none", CommandRules::Over::none},
     {"loopback", CommandRules::Over::loopback},
     {"secured", CommandRules::Over::secured},
     {"network", CommandRules::Over::network}}};

/// Names of the methods that a plan can do, as far as they need no key, in words.
std::string planned_methods() {
  std::string all;
  for (const std::string_view name : method_names()) {
    Node entry = Node::map();
    entry.set("method", Node::of(std::string(name)));
    Problems problems;
    const Set set = make_set("", entry, problems);
    if (set.method && set.method->planned() != Planned::no)
      all += (all.empty() ? "" : ", ") + std::string(name);
  }
  return all;
}

/// Reads the parts of a configuration, each into its place.
class Reader {
 public:
  Reader(std::filesystem::path folder, Problems& problems)
      : folder_(std::move(folder)), problems_(problems) {}

  Config read(const Node& node) {
    Fields fields(node, "configuration", problems_);
    read_robot(fields);
    if (problems_.any()) return std::move(c_);
    read_identity(fields);
    read_transports(fields, folder_, c_, problems_);
    c_.temperature_topic = fields.text("temperature", "");
    if (!fields.node("motion")) fields.fail("motion", "{home: [...], ...}");
    part(fields, "motion", [&](Fields& f) { read_motion(f, c_, problems_); });
    part(fields, "touch", [&](Fields& f) { read_touch(f, c_); });
    part(fields, "limits", [&](Fields& f) { read_limits(f, c_.limits); });
    part(fields, "accept", [&](Fields& f) { read_accept(f); });
    part(fields, "rounds", [&](Fields& f) { read_rounds(f); });
    part(fields, "causes", [&](Fields& f) { read_causes(f); });
    part(fields, "commands", [&](Fields& f) { read_commands(f); });
    part(fields, "schedule", [&](Fields& f) { read_schedule(f); });
    c_.resume = fields.flag("resume", c_.resume);
    c_.store_bytes = static_cast<std::int64_t>(fields.number("store_mb", 100, 1, 1e6) * 1e6);
    if (const std::string file = fields.text("simulation", ""); !file.empty())
      c_.simulation = folder_ / file;
    read_sets(fields);
    if (c_.rounds.touches > 0 && std::ranges::any_of(c_.sets, [](const Set& set) {
          return set.method->planned() == Planned::lock;
        }))
      fields.fail("rounds", "none in a cell with locks, which are planned as a whole");
    fields.refuse_unknown();
    return std::move(c_);
  }

 private:
  /// A mistyped key is said first: what does not fit together may come of it.
  template <class Read>
  void part(Fields& fields, std::string_view key, const Read& read) {
    Fields inner(entry_of(fields, key), std::string(key), problems_);
    const auto first = static_cast<std::ptrdiff_t>(problems_.list.size());
    read(inner);
    const auto read_by_then = static_cast<std::ptrdiff_t>(problems_.list.size());
    inner.refuse_unknown();
    const auto begin = problems_.list.begin();
    std::rotate(begin + first, begin + read_by_then, problems_.list.end());
  }

  void read_robot(Fields& fields) {
    const std::string name = fields.text("robot");
    if (problems_.any()) return;
    auto text = read_file(folder_ / name, kMostYamlBytes);
    if (!text) return problems_.list.push_back(text.error().what);
    auto robot = robot_of(*text, (folder_ / name).string());
    if (!robot) return problems_.list.push_back(robot.error().what);
    c_.robot = std::move(*robot);
    c_.robot_text = std::move(*text);
    if (c_.robot->joints().size() > static_cast<std::size_t>(kMostJoints))
      fields.fail("robot", "a robot of at most " + std::to_string(kMostJoints) + " joints");
  }

  void read_identity(Fields& fields) {
    c_.id = fields.text("id", c_.robot->name());
    c_.serial = fields.text("serial", c_.id);
    const char* folder = std::getenv("STATE_DIRECTORY");
    const std::string state = fields.text("state", "");
    c_.state = !state.empty() ? folder_ / state
               : folder       ? std::filesystem::path(folder)
                              : folder_ / "state";
    c_.target = fields.number("target", c_.target, 1e-6, 1);
    if (const Node* workspace = fields.node("workspace")) {
      c_.workspace = read_workspace(*workspace, problems_);
      workspace_text_ = *workspace;
    }
    c_.domain =
        fields.integer("domain", standard_domain(fields), 0, static_cast<int>(kMostDdsDomain));
  }

  /// Where `monitor`, `command` and ROS 2 are, too.
  static int standard_domain(Fields& fields) {
    if (fields.has("domain")) return 0;
    const auto domain = domain_of_environment();
    if (!domain) fields.fail("domain", "a number, for " + domain.error().what);
    return domain.value_or(0);
  }

  void read_commands(Fields& f) {
    using Over = CommandRules::Over;
    const std::string over = f.text("over", "none");
    const auto known = std::ranges::find(kOvers, over, &std::pair<std::string_view, Over>::first);
    if (known == kOvers.end()) return f.fail("over", "none, loopback, secured or network");
    c_.commands.over = known->second;
    for (const std::string& name : f.texts("allow")) {
      const std::optional<Verb> verb = verb_of(name);
      if (!verb) return f.fail("allow", "of " + verb_names());
      c_.commands.allow.push_back(*verb);
    }
    if (c_.commands.over != Over::none && c_.commands.allow.empty())
      f.fail("allow", "the commands that are taken, by name: [start, abort, ...]");
  }

  void read_accept(Fields& f) {
    c_.accept.automatic = f.flag("auto", false);
    c_.accept.check = f.number("check", c_.accept.check, 0.1, 0.9);
    c_.plan.check = c_.accept.check;
    c_.accept.margin = f.number("margin", c_.accept.margin, 0, 0.9);
    part(f, "largest_change", [&](Fields& g) { read_by_part(g, 10, c_.accept.largest_change); });
  }

  void read_rounds(Fields& f) {
    c_.rounds.touches = f.integer("touches", c_.rounds.touches, 0, 1000);
    c_.rounds.margin = f.number("margin", c_.rounds.margin, 1, 100);
  }

  void read_causes(Fields& f) {
    c_.causes.automatic = f.flag("auto", c_.causes.automatic);
    c_.causes.touches = f.integer("touches", c_.causes.touches, 0, 1000);
    c_.causes.round = f.integer("round", c_.causes.round, 4, 100);
    c_.causes.payload = optional_within(f, "payload", 0.1, 1000);
  }

  std::optional<double> optional_within(Fields& f, std::string_view key, double least,
                                        double most) {
    if (!f.has(key)) return std::nullopt;
    return f.number(key, least, least, most);
  }

  void read_schedule(Fields& f) {
    Schedule& s = c_.schedule;
    s.every_hours = optional_within(f, "every_hours", 1e-4, 1e5);
    s.after_motion_hours = optional_within(f, "after_motion_hours", 1e-4, 1e5);
    s.temperature_change = optional_within(f, "temperature_change", 0.1, 100);
    if (f.has("at")) {
      const std::string at = f.text("at");
      int hour = -1, minute = -1;
      char end = 0;
      if (std::sscanf(at.c_str(), "%2d:%2d%c", &hour, &minute, &end) == 2 && hour >= 0 &&
          hour < 24 && minute >= 0 && minute < 60)
        s.at_minute = 60 * hour + minute;
      else
        f.fail("at", "\"HH:MM\"");
    }
    s.check_first = f.flag("check_first", s.check_first);
    s.check_touches = f.integer("check_touches", s.check_touches, 8, 200);
    s.check_p = f.number("check_p", s.check_p, 1e-6, 0.5);
    s.full_after_checks = f.integer("full_after_checks", s.full_after_checks, 1, 10000);
  }

  void read_sets(Fields& fields) {
    const Node* sets = fields.node("sets");
    if (!sets || sets->kind != Node::Kind::map)
      return fields.fail("sets", "one set or more, each as `name: {method: ...}`");
    Node entries = Node::map();  // of dataset.yaml: without the configuration's own keys
    entries.place = sets->place;
    for (std::size_t i = 0; i < sets->keys.size(); ++i)
      entries.set(sets->keys[i], sets->items[i].without(kOwnKeys));
    c_.sets = selfcal::read_sets(entries, problems_);
    if (problems_.any()) return;
    for (std::size_t i = 0; i < sets->keys.size(); ++i)
      read_target(static_cast<int>(i), sets->items[i]);
    c_.description = Node::map();
    c_.description.set("target", Node::of(c_.target));
    if (c_.workspace.box) c_.description.set("workspace", workspace_text_);
    c_.description.set("sets", std::move(entries));
  }

  /// Reads the configuration's own keys of a set.
  void read_target(int set, const Node& node) {
    const std::shared_ptr<const Method>& method = c_.sets[set].method;
    Fields f(node, "set " + c_.sets[set].name, problems_);
    TouchTarget target;
    target.set = set;
    target.touches = f.integer("touches", 40, 4, 10000);  // configurations, of a lock
    const Node *surface = f.node("surface"), *within = f.node("within"), *places = f.node("places");
    if (method->planned() == Planned::surface)
      read_plane(f, surface, within, target);
    else if (method->planned() == Planned::places)
      read_sockets(f, places, target);
    else if (method->planned() == Planned::lock)
      read_lock(f, *method, target);
    else
      f.fail("method", "what a session can do, one of " + planned_methods());
    c_.targets.push_back(std::move(target));
  }

  void read_plane(Fields& f, const Node* surface, const Node* within, TouchTarget& target) {
    for (const char* key : {"places", "way_out"})
      if (f.has(key)) return f.fail(key, "only for sockets and nests");
    if (!surface) return f.fail("surface", "{point: [x, y, z], normal: [x, y, z]}");
    if (!within) return f.fail("within", "{center: [x, y, z], radius: R}");
    const Surface s = read_surface(*surface, f.what() + " surface", problems_);
    target.within = read_patch(*within, f.what() + " within", problems_);
    target.outward = s.normal;
    target.plane = Plane{s.normal, s.normal.dot(s.point)};
    const double off = std::abs(s.normal.dot(target.within.centre - s.point));
    if (!problems_.any() && off >= target.within.radius)
      return f.fail("within", "a ball that meets the surface, which is " +
                                  in_readable_unit(off, "m") + " from its center");
    target.obstacle = static_cast<int>(c_.obstacles.size());
    c_.obstacles.push_back({s.point, s.normal, target.within});
  }

  void read_sockets(Fields& f, const Node* places, TouchTarget& target) {
    for (const char* key : {"surface", "within"})
      if (f.has(key)) return f.fail(key, "only for planes");
    if (!places) return f.fail("places", "[[x, y, z], ...]");
    target.places = read_places(*places, f.what() + " places", problems_);
    target.outward = read_unit(f, "way_out");
    target.within = {};
  }

  /// The lock is engaged with its leg as it is turned at home.
  void read_lock(Fields& f, const Method& method, TouchTarget& target) {
    for (const char* key : {"surface", "within", "places", "way_out"})
      if (f.has(key)) return f.fail(key, "none of a lock: it is engaged as the leg stands at home");
    if (const std::string lacking = lacking_body(*c_.robot, c_.sets); !lacking.empty())
      return f.fail("lock", "a joint of the robot: " + lacking);
    if (problems_.any()) return;  // home may have none
    target.outward = locate(*c_.robot, values(*c_.robot), c_.plan.home, method.body()).R.col(2);
  }

  std::filesystem::path folder_;
  Problems& problems_;
  Node workspace_text_;
  Config c_;
};

}  // namespace

Result<Config> load_config(const std::filesystem::path& path) {
  const Result<Node> node = read_yaml(path);
  if (!node) return tl::unexpected(node.error());
  for (const char* key : {"frames", "legs", "chains", "towers", "observations"})
    if (node->find(key))
      return bad_input(path.string() + ": is the file of a " +
                       (key == std::string_view("observations") ? "data set" : "robot") +
                       "; expected a CONFIG.yaml, which names the robot's file, the surfaces that "
                       "it may touch and a home");
  Problems problems;
  Config config = Reader(path.parent_path(), problems).read(*node);
  if (problems.any()) return bad_input(problems);
  return config;
}

Result<std::vector<Set>> sets_of(const std::string& description) {
  const Result<Node> node = parse_yaml(description, "session");
  if (!node) return tl::unexpected(node.error());
  Problems problems;
  const Node* entries = node->find("sets");
  if (!entries) return bad_input("session: no sets");
  std::vector<Set> sets = read_sets(*entries, problems);
  if (problems.any()) return bad_input(problems);
  return sets;
}

}  // namespace selfcal
