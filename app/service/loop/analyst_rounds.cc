// A full session by rounds: a share of the touches is planned, made and identified from, and the
// rest planned anew from the parameters that are known by then and beside the touches that are
// made, until the end position is known well enough or all are made.
#include <algorithm>
#include <cmath>

#include "app/service/loop/analyst.h"

namespace selfcal {
namespace {

constexpr int kFirstOfSet = 6;  // in the first round, so that each surface is told of and judged

/// That the collector gave the group's name (session.cc).
int place_of(const std::string& group) {
  return group.size() > 1 ? std::stoi(group.substr(1)) : -1;
}

}  // namespace

std::vector<TouchTarget> Analyst::targets_of_round(const std::vector<StepRecord>& made) const {
  std::vector<TouchTarget> targets = c_.config.targets;
  if (c_.config.rounds.touches == 0) return targets;
  int left = 0;
  for (TouchTarget& each : targets) {
    each.touches -=
        static_cast<int>(std::ranges::count(made, c_.config.sets[each.set].name, &StepRecord::set));
    left += each.touches;
  }
  const double share = std::min(1.0, c_.config.rounds.touches / std::max(1.0, 1.0 * left));
  for (TouchTarget& each : targets) {
    const int wanted = static_cast<int>(std::ceil(share * each.touches));
    each.touches = made.empty() ? std::min(each.touches, std::max(kFirstOfSet, wanted)) : wanted;
  }
  std::erase_if(targets, [](const TouchTarget& each) { return each.touches <= 0; });
  return targets;
}

bool Analyst::wants_more() const {
  const Session& session = collector_.session();
  if (c_.config.rounds.touches == 0 || targets_of_round(session.plan).empty()) return false;
  const double sigma = solution_->workspace.rms;
  if (solution_->verdict.answer != Answer::improved ||
      !known_to(solution_->workspace, c_.config.target / c_.config.rounds.margin))
    return true;
  c_.tell("info", "session " + std::to_string(session.record.id) + " ends after " +
                      std::to_string(session.plan.size()) +
                      " touches: the end position is known to " +
                      format_number(std::round(1e6 * sigma) / 1e3) + " mm, target " +
                      format_number(1e3 * c_.config.target) + " mm");
  return false;
}

/// Those that identify.
std::vector<PossibleTouch> Analyst::touches_made() const {
  const Observations& rows = data_->rows;
  std::vector<PossibleTouch> made;
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    const auto at = static_cast<std::size_t>(row);
    const Set& set = data_->sets[static_cast<std::size_t>(rows.set[at])];
    const auto target = std::ranges::find_if(c_.config.targets, [&](const TouchTarget& each) {
      return c_.config.sets[each.set].name == set.name;
    });
    if (rows.check[at] || target == c_.config.targets.end()) continue;
    const int group = rows.group[at];
    made.push_back({rows.q.row(row).transpose(), target->set,
                    group < 0 ? -1 : place_of(set.groups[static_cast<std::size_t>(group)]),
                    target->outward});
  }
  return made;
}

void Analyst::plan_round() {
  const Session& session = collector_.session();
  TouchPlanOptions options = c_.config.plan;
  options.seed = session.record.seed + session.plan.size();
  options.known.made = touches_made();
  const std::shared_ptr<const Robot> robot = c_.models.active();
  // What a few touches leave open may have led the parameters astray.
  const Eigen::VectorXd xi =
      solution_->verdict.answer == Answer::improved ? solution_->values : values(*robot);
  auto touches = std::make_shared<TouchPlan>();
  computation_.start([touches, robot, xi, sets = c_.config.sets,
                      targets = targets_of_round(session.plan), options,
                      obstacles = c_.config.obstacles,
                      workspace = c_.config.workspace](const Computation::Tell& tell) {
    *touches = plan_touches(*robot, xi, sets, targets, obstacles, workspace, options, tell);
    return std::string();
  });
  when_computed_ = [this, touches](const std::string& failure) {
    if (!failure.empty()) return c_.put(Event::What::planned, false, "planning: " + failure);
    keep_round(*touches);
  };
}

void Analyst::keep_round(const TouchPlan& plan) {
  if (!plan.unreached.empty())
    return c_.put(Event::What::planned, false, "planning: " + plan.unreached);
  Session session = collector_.session();
  const std::vector<StepRecord> steps = steps_of(plan, c_.config.sets);
  if (!c_.stored(c_.store.extend(session.record.id, steps))) return;
  for (StepRecord step : steps) {
    step.index = static_cast<int>(session.plan.size());
    session.plan.push_back(std::move(step));
  }
  c_.tell("info", "session " + std::to_string(session.record.id) + ": " +
                      std::to_string(steps.size()) + " further touches planned");
  tell_left_out(plan);
  collector_.open(std::move(session));
}

}  // namespace selfcal
