// Every cause by its name, and what several of them share.
#include "sim/trials/trial_causes.h"

#include <cmath>

namespace selfcal {

std::vector<std::string> listed_causes(const TrialWorld& world) {
  std::vector<std::string> names;
  for (const auto* list : {&joint_causes(), &site_causes(), &tracked_causes(), &touch_causes()}) {
    if (list == (world.touches() ? &tracked_causes() : &touch_causes())) continue;
    for (const auto& [name, maker] : *list) names.push_back(name);
  }
  return names;
}

TrialCause draw_cause(const std::string& effect, const TrialWorld& world, Random& random) {
  if (effect == "unknown") return draw_unknown(world, random);
  for (const auto* list : {&joint_causes(), &site_causes(), &tracked_causes(), &touch_causes()})
    if (const auto found = list->find(effect); found != list->end()) {
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
