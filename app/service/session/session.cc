#include "app/service/session/session.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace selfcal {
namespace {

constexpr int kLastTouches = 60;  // of each set, that a running residual is taken from

std::vector<double> list_of(const Eigen::VectorXd& v) { return {v.data(), v.data() + v.size()}; }

enum class StepState { open, complete, lost };

std::vector<StepState> step_states(const Session& session, int repeats, int attempts) {
  std::vector<int> good(session.plan.size(), 0), failed(session.plan.size(), 0);
  for (const TouchRecord& touch : session.touches) {
    if (touch.outcome == TouchOutcome::taken) ++good[touch.step];
    if (touch.outcome == TouchOutcome::differs) good[touch.step] = 0;
    if (touch.outcome != TouchOutcome::taken) ++failed[touch.step];
  }
  std::vector<StepState> states;
  for (std::size_t i = 0; i < good.size(); ++i)
    states.push_back(good[i] >= repeats      ? StepState::complete
                     : failed[i] >= attempts ? StepState::lost
                                             : StepState::open);
  return states;
}

}  // namespace

Eigen::VectorXd vector_of(const std::vector<double>& readings) {
  return Eigen::Map<const Eigen::VectorXd>(readings.data(),
                                           static_cast<Eigen::Index>(readings.size()));
}

std::vector<StepRecord> steps_of(const TouchPlan& plan, const std::vector<Set>& sets) {
  std::vector<StepRecord> steps;
  for (const PlannedTouch& touch : plan.touches) {
    StepRecord step;
    step.index = static_cast<int>(steps.size());
    step.set = sets[touch.set].name;
    if (touch.group >= 0) step.group = "g" + std::to_string(touch.group);
    step.check = touch.check;
    step.slow = touch.slow;
    step.loaded = touch.loaded;
    step.via_home = touch.via_home;
    for (const Eigen::VectorXd& place : touch.way) step.way.push_back(list_of(place));
    step.start = list_of(touch.start);
    step.touch = list_of(touch.touch);
    step.end = list_of(touch.end);
    steps.push_back(std::move(step));
  }
  return steps;
}

std::vector<const TouchRecord*> good_touches(const Session& session, int step) {
  std::vector<const TouchRecord*> good;
  for (const TouchRecord& touch : session.touches) {
    if (touch.step != step) continue;
    if (touch.outcome == TouchOutcome::taken) good.push_back(&touch);
    if (touch.outcome == TouchOutcome::differs) good.clear();
  }
  return good;
}

int next_step(const Session& session, int repeats, int attempts) {
  const auto states = step_states(session, repeats, attempts);
  return static_cast<int>(std::ranges::find(states, StepState::open) - states.begin());
}

int steps_put_aside(const Session& session, int repeats, int attempts) {
  const auto states = step_states(session, repeats, attempts);
  return static_cast<int>(std::ranges::count(states, StepState::lost));
}

Session lately(const Session& session, std::size_t step) {
  Session recent{session.record, session.plan, {}};
  recent.plan.resize(step + 1);
  std::map<std::string, int> taken;
  for (auto touch = session.touches.rbegin(); touch != session.touches.rend(); ++touch)
    if (static_cast<std::size_t>(touch->step) <= step &&
        ++taken[recent.plan[touch->step].set] <= kLastTouches)
      recent.touches.push_back(*touch);
  std::ranges::reverse(recent.touches);
  return recent;
}

}  // namespace selfcal
