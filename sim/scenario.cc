// The scenario as a whole; the entries of its sets are read in scenario_set.cc.
#include "sim/scenario.h"

namespace selfcal {
namespace {

constexpr double kLargestError = 1;  // m or rad

void read_errors(Fields& fields, Errors& errors, Problems& problems) {
  read_by_part(fields, kLargestError, errors.sigma);
  errors.gear = fields.number("gear", 0, 0, kLargestError);
  errors.parameters = named_numbers(fields, "parameters", problems);
}

void read_repeats(Fields& fields, Repeats& repeats) {
  repeats.share = fields.number("share", 0, 0, 1);
  repeats.times = fields.integer("times", repeats.times, 2, 100);
}

void read_false_triggers(Fields& fields, FalseTriggers& triggers) {
  triggers.share = fields.number("share", 0, 0, 0.5);
  const auto size = fields.numbers("size", 2);
  if (!size) return;
  triggers.least = (*size)[0];
  triggers.most = (*size)[1];
  if (!(triggers.least > 0 && triggers.least <= triggers.most && triggers.most <= 0.1))
    fields.fail("size", "[LEAST, MOST] in metres, above 0 and at most 0.1");
}

void read_set_scenarios(Fields& fields, Scenario& scenario, Problems& problems) {
  const Node* sets = fields.node("sets");
  if (!sets || sets->kind != Node::Kind::map || sets->items.empty())
    return fields.fail("sets", "one set or more, each as `name: {method: ...}`");
  for (std::size_t i = 0; i < sets->keys.size(); ++i)
    scenario.sets.push_back(read_set_scenario(sets->keys[i], sets->items[i], problems));
}

}  // namespace

Scenario read_scenario(const Node& node, Problems& problems) {
  Fields fields(node, "scenario", problems);
  Scenario scenario;
  scenario.robot = fields.text("robot");
  if (fields.has("robot") && scenario.robot.empty()) fields.fail("robot", "a file's name");
  scenario.seed = fields.integer("seed", scenario.seed, 0, 2147483647);
  scenario.target = fields.optional_number("target");
  if (scenario.target && !(*scenario.target > 0 && *scenario.target < 1))
    fields.fail("target", "metres above 0 and below 1");
  if (const Node* errors = fields.node("errors"))
    scenario.errors = read_whole<Errors>(
        *errors, "errors", problems,
        [&](Fields& inner, Errors& result) { read_errors(inner, result, problems); });
  scenario.encoder_step = fields.number("encoder_step", 0, 0, 0.1);
  scenario.check = fields.number("check", scenario.check, 0, 0.9);
  if (const Node* repeats = fields.node("repeats"))
    scenario.repeats = read_whole<Repeats>(*repeats, "repeats", problems, read_repeats);
  if (const Node* triggers = fields.node("false_triggers"))
    scenario.false_triggers =
        read_whole<FalseTriggers>(*triggers, "false_triggers", problems, read_false_triggers);
  scenario.compliance = named_numbers(fields, "compliance", problems);
  if (const Node* machine = fields.node("machine"))
    scenario.machine = read_machine_scenario(*machine, problems);
  read_set_scenarios(fields, scenario, problems);
  fields.refuse_unknown();
  return scenario;
}

Node data_set_description(const Scenario& scenario, const std::string& robot_file) {
  Node node = Node::map();
  node.set("robot", Node::of(robot_file));
  node.set("observations", Node::of(std::string("observations.csv")));
  if (scenario.target) node.set("target", Node::of(*scenario.target));
  Node sets = Node::map();
  for (const SetScenario& set : scenario.sets) sets.set(set.name, set.entry);
  node.set("sets", std::move(sets));
  return node;
}

}  // namespace selfcal
