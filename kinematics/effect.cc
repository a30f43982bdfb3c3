// What every effect shares: made from its entry, written back to it.
#include "kinematics/effect.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "kinematics/robot.h"
#include "kinematics/size.h"
#include "kinematics/statics.h"

namespace selfcal {

#define X(identifier, lasting) std::unique_ptr<Effect> make_##identifier(const EffectPlan& plan);
#include "kinematics/effects.def"
#undef X

namespace {

struct Family {
  std::string_view name;
  std::unique_ptr<Effect> (*make)(const EffectPlan&);
  EffectLasting lasting;
};

constexpr Family kFamilies[] = {
#define X(identifier, lasting) {#identifier, make_##identifier, EffectLasting::lasting},
#include "kinematics/effects.def"
#undef X
};

constexpr double kUsualSize = 1.5;   // m, of the machines whose usual sizes the effects give
constexpr double kImpossible = 100;  // times the largest usual size

/// What may have been taken for a unit, as a question; nothing where none is likely.
std::string likely_slip(std::string_view unit) {
  const std::pair<std::string_view, std::string_view> slips[] = {
      {"m", "millimetres"},
      {"rad", "degrees"},
      {"s", "milliseconds"},
      {"1", "parts per million"},
      {"1/K", "parts per million per kelvin"}};
  const auto* slip =
      std::ranges::find(slips, unit, &std::pair<std::string_view, std::string_view>::first);
  return slip == std::end(slips) ? "" : " (" + std::string(slip->second) + "?)";
}

/// Of a quantity of this unit, on a machine `size` times as large: errors of lengths grow with it,
/// errors of angles and what a force makes stay.
double in_proportion(std::string_view unit, double size) {
  if (unit == "m" || unit == "m/K" || unit == "m/rad") return size;
  return unit == "1/m" || unit == "rad/m" ? 1 / size : 1;
}

/// Far beyond what any machine has. A fit may find a little of the wrong sign.
bool impossible(const EffectParameter& p, double value) {
  return std::abs(value) > kImpossible * p.usual_most || (p.positive && value < -p.usual_most);
}

std::string possible_range(const EffectParameter& p) {
  const double most = kImpossible * p.usual_most;
  return "from " + format_number(p.positive ? -p.usual_most : -most) + " to " +
         format_number(most) + (p.unit == "1" ? "" : " " + p.unit) + likely_slip(p.unit) +
         ", or `unusual: true` beside it";
}

}  // namespace

int MeasurementContext::find(std::string_view set) const {
  for (size_t s = 0; s < sets.size(); ++s)
    if (sets[s].name == set) return static_cast<int>(s);
  return -1;
}

bool MeasurementContext::touched() const {
  return std::ranges::any_of(
      sets, [](const MeasuredSet& set) { return set.touch != TouchedSurface::none; });
}

Node Effect::describe(const Eigen::VectorXd& v) const {
  Node node = Node::map();
  node.set("effect", Node::of(std::string(name_)));
  if (!at_.empty()) node.set("at", Node::of(at_));
  if (named_) node.set("named", Node::of(std::string(*named_ ? "true" : "false")));
  describe_shape(node);
  for (size_t i = 0; i < parameters_.size() && !node.find("unusual"); ++i)
    if (impossible(parameters_[i], v[static_cast<Eigen::Index>(i)]))
      node.set("unusual", Node::of(std::string("true")));
  for (size_t i = 0; i < parameters_.size(); ++i)
    node.set(parameters_[i].name, Node::of(v[static_cast<Eigen::Index>(i)]));
  return node;
}

int EffectPlan::joint() const {
  const std::string at = fields.text("at");
  if (const int joint = find_joint(robot, at); joint >= 0) return joint;
  std::string known;
  for (const Joint& joint : robot.joints()) known += (known.empty() ? "" : ", ") + joint.name;
  fields.fail("at", "a joint of the robot: " + known);
  return 0;
}

bool EffectPlan::legs() const {
  if (robot.leg_parameter(0) >= 0) return true;
  fields.fail("effect", "an effect of another kind: " + std::string(kNoLegs));
  return false;
}

int EffectPlan::leg() const { return legs() ? joint() : -1; }

int EffectPlan::set() const {
  const int set = context.find(fields.text("at"));
  if (set < 0 && !context.sets.empty()) fields.fail("at", "a set of the data set");
  return set;
}

const Mechanics* EffectPlan::mechanics() const {
  if (const Statics* statics = robot.statics()) return &statics->mechanics();
  fields.fail("effect", "an effect without load or links: " + std::string(kNoStatics));
  return nullptr;
}

bool EffectPlan::torques() const {
  if (robot.statics() || weighs(robot)) return true;
  fields.fail("effect", "an effect without load: " + std::string(kNoMasses));
  return false;
}

std::optional<double> EffectPlan::reference() const {
  const std::optional<double> written = fields.optional_number("reference");
  if (!written) return context.reference;
  if (*written < kColdest || *written > kHottest)
    fields.fail("reference", "degrees Celsius from " + format_number(kColdest) + " to " +
                                 format_number(kHottest) +
                                 (*written > kHottest ? " (kelvin?)" : ""));
  return written;
}

void EffectPlan::expect_place(std::string_view only) const {
  if (fields.text("at", std::string(only)) != only)
    fields.fail("at", only.empty() ? "nothing: it acts on the whole robot" : std::string(only));
  place = only;
}

bool all_differ(std::vector<double> numbers) {
  std::ranges::sort(numbers);
  return std::ranges::adjacent_find(numbers) == numbers.end();
}

std::unique_ptr<Effect> make_effect(const Node& node, const Robot& robot,
                                    const MeasurementContext& context, Problems& problems) {
  Fields fields(node, "effect", problems);
  const std::string name = fields.text("effect");
  std::string known;
  for (const Family& family : kFamilies) {
    known += (known.empty() ? "" : ", ") + std::string(family.name);
    if (family.name != name) continue;
    const size_t before = problems.list.size();
    std::string at = fields.text("at", "");
    std::unique_ptr<Effect> effect = family.make({fields, robot, context, at});
    if (problems.list.size() > before) return nullptr;
    effect->name_ = name;
    effect->entry_ = node;
    effect->at_ = std::move(at);
    if (fields.has("named")) effect->named_ = fields.flag("named", false);
    const bool unusual = fields.flag("unusual", false);
    for (EffectParameter& p : effect->parameters_) {
      const double size = in_proportion(p.unit, size_of(robot) / kUsualSize);
      EffectParameter widest = p;  // a tool may be large on a small robot
      widest.usual_most *= std::max(size, 1.0);
      p.usual_least *= size;
      p.usual_most *= size;
      p.value = fields.number(p.name, 0.0);
      widest.value = p.value;
      if (!unusual && impossible(widest, p.value)) fields.fail(p.name, possible_range(widest));
    }
    fields.refuse_unknown();
    return problems.list.size() > before ? nullptr : std::move(effect);
  }
  fields.fail("effect", "one of " + known);
  return nullptr;
}

std::vector<std::string_view> effect_names() {
  std::vector<std::string_view> names;
  for (const Family& family : kFamilies) names.push_back(family.name);
  return names;
}

EffectLasting lasting_of(std::string_view effect) {
  const auto* found = std::ranges::find(kFamilies, effect, &Family::name);
  return found == std::end(kFamilies) ? EffectLasting::apart : found->lasting;
}

}  // namespace selfcal
