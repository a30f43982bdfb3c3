// Every cause by its name, and what several of them share.
#include "sim/trials/trial_causes.h"

#include <cmath>

namespace selfcal {

namespace {

/// Needs links, masses of links, or drives that share a gearbox: legs have none of them.
bool of_links(const std::string& name) {
  for (const char* each : {"joint_compliance", "link_compliance", "transmission_error",
                           "joint_coupling", "thermal_expansion", "tool_compliance"})
    if (name == each) return true;
  return false;
}

using Causes = const std::map<std::string, CauseMaker>& (*)();
constexpr Causes kAllCauses[] = {joint_causes, leg_causes, site_causes, tracked_causes,
                                 touch_causes};

}  // namespace

std::vector<std::string> listed_causes(const TrialWorld& world) {
  std::vector<std::string> names;
  for (const Causes causes : kAllCauses) {
    const auto* list = &causes();
    if (list == (world.touches() ? &tracked_causes() : &touch_causes())) continue;
    if (list == &leg_causes() && !world.on_legs()) continue;
    for (const auto& [name, maker] : *list)
      if (!world.on_legs() || !of_links(name)) names.push_back(name);
  }
  return names;
}

TrialCause draw_cause(const std::string& effect, const TrialWorld& world, Random& random) {
  if (effect == "unknown") return draw_unknown(world, random);
  for (const Causes causes : kAllCauses)
    if (const auto found = causes().find(effect); found != causes().end()) {
      TrialCause cause = found->second(world, random);
      cause.effect = effect;
      return cause;
    }
  return {};
}

std::vector<ActingJoint> draw_joints(const TrialWorld& world, Random& random, double two) {
  const int count = world.joints();
  const int first = pick(random, count);
  const auto name = [&](int j) { return world.robot->joints()[static_cast<size_t>(j)].name; };
  std::vector<ActingJoint> joints{{first, 1, name(first)}};
  if (count > 1 && chance(random, two)) {
    const int second = (first + 1 + pick(random, count - 1)) % count;
    joints.push_back({second, uniform(random, 0.4, 1), name(second)});
  }
  return joints;
}

std::vector<std::string> names_of(const std::vector<ActingJoint>& joints) {
  std::vector<std::string> names;
  for (const ActingJoint& each : joints) names.push_back(each.name);
  return names;
}

AirRecord smooth_walk(double duration, Random& random) {
  constexpr int kSteps = 300;
  AirRecord walk{duration / kSteps, std::vector<double>(kSteps + 1, 0)};
  const double kept = std::exp(-3.0 / kSteps);
  double speed = normal(random), squares = 0;
  for (size_t i = 1; i < walk.celsius.size(); ++i) {
    walk.celsius[i] = walk.celsius[i - 1] + speed;
    squares += walk.celsius[i] * walk.celsius[i];
    speed = kept * speed + std::sqrt(1 - kept * kept) * normal(random);
  }
  for (double& each : walk.celsius) each /= std::sqrt(squares / kSteps);
  return walk;
}

}  // namespace selfcal
