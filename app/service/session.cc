#include "app/service/session.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "constraints/equations/equations.h"
#include "constraints/estimation/engagements.h"
#include "constraints/planning/touch_choice.h"
#include "io/files/file.h"
#include "io/files/yaml.h"

namespace selfcal {
namespace {

constexpr int kRowsForResidual = 5;  // of one set, before its surface is known at all
constexpr int kLastTouches = 60;     // of each set, that a running residual is taken from
constexpr double kSpeedStep = 1e-3;  // s, over which a speed is taken

std::vector<double> list_of(const Eigen::VectorXd& v) { return {v.data(), v.data() + v.size()}; }

int group_index(Set& set, const std::string& name) {
  if (name.empty()) return -1;
  const auto found = std::ranges::find(set.groups, name);
  if (found != set.groups.end()) return static_cast<int>(found - set.groups.begin());
  set.groups.push_back(name);
  return static_cast<int>(set.groups.size()) - 1;
}

/// Speed of the endpoint along the way out of the contact (m/s); 0 where the robot cannot stand, of
/// which no equation comes either.
double speed_out(const Robot& robot, const Reading& reading, const Eigen::Vector3d& outward) {
  const Eigen::VectorXd step = kSpeedStep / 2 * reading.dq;
  Locations ahead, behind;
  const auto closes = [&](const Eigen::VectorXd& q, Locations& X) {
    return robot.locate(block_of(q), values(robot), Body::endpoint, X, nullptr).closes();
  };
  if (!closes(reading.q + step, ahead) || !closes(reading.q - step, behind)) return 0;
  return outward.dot(ahead.p(0) - behind.p(0)) / kSpeedStep;
}

/// Why a machine with loops cannot stand at these readings: one is out of its range, or the loops
/// do not close in their assembly mode. Empty where it can.
std::string cannot_stand(const Robot& robot, const Eigen::VectorXd& q) {
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(j)];
    if (!joint.allows(q[j]))
      return joint.name + " reads " + format_number(std::round(q[j] * 1e6) / 1e6) +
             ", out of its range";
  }
  Locations X;
  const Closure closure = robot.locate(block_of(q), values(robot), Body::endpoint, X, nullptr);
  return closure.closes(0) ? "" : "the assembly mode is lost: " + closure.why[0];
}

/// Of a mass (kg) whose centre is at the tip: on the tool, in its axes; nothing of a robot without
/// statics.
Eigen::RowVectorXd wrench_of(const Robot& robot, const Eigen::VectorXd& q, double mass) {
  Eigen::RowVectorXd wrench = Eigen::RowVectorXd::Zero(6);
  if (robot.statics())
    wrench.head<3>() = (mass * locate(robot, values(robot), q).R.transpose() *
                        robot.statics()->mechanics().gravity)
                           .transpose();
  return wrench;
}

void size_rows(Observations& rows, Eigen::Index count, Eigen::Index joints) {
  rows.q.setZero(count, joints);
  rows.position.setConstant(count, 3, std::nan(""));
  rows.orientation.setConstant(count, 4, std::nan(""));
  rows.normal.setConstant(count, 3, std::nan(""));
  rows.velocity.setZero(count, joints);
  rows.temperature.setConstant(count, std::nan(""));
  rows.time.setZero(count);
  rows.noise_factor.setOnes(count);
}

}  // namespace

int set_index(const Decoding& decoding, const std::string& name) {
  for (std::size_t s = 0; s < decoding.sets.size(); ++s)
    if (decoding.sets[s].name == name) return static_cast<int>(s);
  return 0;
}

Eigen::Vector3d endpoint(const Robot& robot, const Eigen::VectorXd& q) {
  return locate(robot, values(robot), q).p;
}

Eigen::VectorXd vector_of(const std::vector<double>& readings) {
  return Eigen::Map<const Eigen::VectorXd>(readings.data(),
                                           static_cast<Eigen::Index>(readings.size()));
}

std::string decoding_text(const Config& config, const std::vector<EncoderScale>& scales) {
  Node node = config.description;
  node.set("delay", Node::of(config.touch.delay));
  if (config.causes.payload) node.set("payload", Node::of(*config.causes.payload));
  Node list = Node::list();
  for (const EncoderScale& scale : scales) {
    Node each = Node::map();
    each.set("step", Node::of(scale.step));
    each.set("zero", Node::of(std::to_string(scale.zero)));
    list.items.push_back(std::move(each));
  }
  node.set("encoders", std::move(list));
  Node outward = Node::map();
  for (const TouchTarget& target : config.targets)
    outward.set(config.sets[target.set].name, Node::of(Eigen::VectorXd(target.outward)));
  node.set("outward", std::move(outward));
  return write_yaml(node);
}

std::string config_hash(const Config& config, const std::vector<EncoderScale>& scales) {
  return sha256_hex(decoding_text(config, scales) + write_yaml(config.transports) +
                    config.robot->text().identity());
}

Result<Decoding> read_decoding(const std::string& text) {
  const Result<Node> node = parse_yaml(text, "session");
  if (!node) return tl::unexpected(node.error());
  Result<std::vector<Set>> sets = sets_of(text);
  if (!sets) return tl::unexpected(sets.error());
  Decoding decoding;
  decoding.sets = std::move(*sets);
  Problems problems;
  Fields fields(*node, "session", problems);
  decoding.target = fields.number("target");
  if (const Node* workspace = fields.node("workspace"))
    decoding.workspace = read_workspace(*workspace, problems);
  decoding.delay = fields.number("delay");
  decoding.payload = fields.number("payload", 0.0);
  if (const Node* list = fields.node("encoders"))
    for (const Node& each : list->items) {
      Fields scale(each, "encoder", problems);
      decoding.scales.push_back({scale.number("step"), std::llround(scale.number("zero"))});
    }
  const Node* outward = fields.node("outward");
  for (const Set& set : decoding.sets) {
    std::optional<Eigen::VectorXd> way;
    if (outward) way = Fields(*outward, "outward", problems).numbers(set.name, 3);
    decoding.outward.push_back(way ? Eigen::Vector3d(*way) : Eigen::Vector3d::UnitZ());
  }
  if (problems.any()) return bad_input(problems);
  return decoding;
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

namespace {

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

/// When its readings hold: at the edge; under a lock, whose edge is long past, at its sample.
Nanoseconds moment_of(const TouchRecord& touch) { return std::max(touch.edge, touch.before.time); }

/// By the edges, which no step of the wall clock moves; by that clock where the computer has
/// started anew in between.
double seconds_between(const TouchRecord& before, const TouchRecord& after) {
  if (moment_of(after) >= moment_of(before)) return seconds(moment_of(after) - moment_of(before));
  return std::max(0.0, static_cast<double>(after.unix_ms - before.unix_ms) / 1000);
}

}  // namespace

int next_step(const Session& session, int repeats, int attempts) {
  const auto states = step_states(session, repeats, attempts);
  return static_cast<int>(std::ranges::find(states, StepState::open) - states.begin());
}

int steps_put_aside(const Session& session, int repeats, int attempts) {
  const auto states = step_states(session, repeats, attempts);
  return static_cast<int>(std::ranges::count(states, StepState::lost));
}

Reading reading_of(const TouchRecord& touch, const Decoding& decoding) {
  return reading_between(touch.before, touch.after, touch.edge - nanoseconds(decoding.delay),
                         decoding.scales);
}

namespace {

/// Rows of one engagement of a lock; its edge is the engagement's.
struct Engagement {
  int rows = 0, fit = 0, set = -1;
  bool tells() const { return rows >= kFewestOfLock && fit >= 2; }
};

/// The set of each touch, negative of one to be left out; `sets` gains those of later engagements.
std::vector<int> sets_of_touches(const std::vector<const TouchRecord*>& touches,
                                 const std::vector<StepRecord>& plan, const Decoding& decoding,
                                 std::vector<Set>& sets) {
  std::vector<int> list;
  std::map<int, std::map<Nanoseconds, Engagement>> locks;
  for (const TouchRecord* touch : touches) {
    const StepRecord& step = plan[touch->step];
    list.push_back(set_index(decoding, step.set));
    if (sets[list.back()].method->planned() != Planned::lock) continue;
    Engagement& engagement = locks[list.back()][touch->edge];
    ++engagement.rows;
    engagement.fit += !step.check;
  }
  for (auto& [set, engagements] : locks) {
    const auto telling =
        std::ranges::count_if(engagements, [](const auto& each) { return each.second.tells(); });
    bool first = true;
    for (auto& [edge, engagement] : engagements) {
      if (telling > 0 && !engagement.tells()) continue;
      engagement.set = std::exchange(first, false) ? set : add_engagement(sets, set);
    }
  }
  for (std::size_t i = 0; i < touches.size(); ++i)
    if (const auto lock = locks.find(list[i]); lock != locks.end())
      list[i] = lock->second.at(touches[i]->edge).set;
  return list;
}

/// The touches that make rows, in the order of the plan.
struct RowTouches {
  std::vector<const TouchRecord*> touches;
  std::vector<int> repeat, set;
};

RowTouches touches_of_rows(const Session& session, const Decoding& decoding,
                           std::vector<Set>& sets) {
  std::vector<const TouchRecord*> good;
  std::vector<int> repeat;
  for (const StepRecord& step : session.plan) {
    const auto of_step = good_touches(session, step.index);
    good.insert(good.end(), of_step.begin(), of_step.end());
    repeat.insert(repeat.end(), of_step.size(), of_step.size() > 1 ? step.index : -1);
  }
  const std::vector<int> set = sets_of_touches(good, session.plan, decoding, sets);
  RowTouches rows;
  for (std::size_t i = 0; i < good.size(); ++i) {
    if (set[i] < 0) continue;
    rows.touches.push_back(good[i]);
    rows.repeat.push_back(repeat[i]);
    rows.set.push_back(set[i]);
  }
  return rows;
}

}  // namespace

std::vector<int> steps_of_rows(const Session& session, const Decoding& decoding) {
  std::vector<Set> sets = decoding.sets;
  std::vector<int> steps;
  for (const TouchRecord* touch : touches_of_rows(session, decoding, sets).touches)
    steps.push_back(touch->step);
  return steps;
}

DataSet rows_of(const Robot& robot, const Session& session, const Decoding& decoding, Parts parts) {
  DataSet data;
  data.sets = decoding.sets;
  data.target = decoding.target;
  data.workspace = decoding.workspace;
  auto [rows, repeat, sets] = touches_of_rows(session, decoding, data.sets);
  Observations& out = data.rows;
  size_rows(out, static_cast<Eigen::Index>(rows.size()),
            static_cast<Eigen::Index>(decoding.scales.size()));
  out.repeat = std::move(repeat);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const StepRecord& step = session.plan[rows[i]->step];
    const int set = sets[i], configured = set_index(decoding, step.set);
    const auto row = static_cast<Eigen::Index>(i);
    const Reading reading = reading_of(*rows[i], decoding);
    out.q.row(row) = reading.q.transpose();
    out.normal.row(row) = decoding.outward[configured].transpose();
    out.velocity.row(row) = reading.dq.transpose();
    out.temperature[row] = rows[i]->temperature;
    out.time[row] = i == 0 ? 0 : out.time[row - 1] + seconds_between(*rows[i - 1], *rows[i]);
    const double noise = touch_noise(data.sets[set]);
    out.noise_factor[row] = std::hypot(
        1, speed_out(robot, reading, decoding.outward[configured]) * reading.sigma_time / noise);
    if (step.loaded) {
      if (out.wrench.rows() == 0) out.wrench.setZero(out.q.rows(), 6);
      out.wrench.row(row) = wrench_of(robot, reading.q, decoding.payload);
    }
    out.set.push_back(set);
    out.group.push_back(group_index(data.sets[set], step.group));
    out.check.push_back(parts == Parts::as_planned ? step.check : parts == Parts::all_check);
  }
  return data;
}

DataSet joined(const DataSet& base, const DataSet& check) {
  std::vector<int> fit;
  for (int row = 0; row < base.rows.rows(); ++row)
    if (!base.rows.check[row]) fit.push_back(row);
  DataSet data = base;
  Observations judging = check.rows;
  for (int row = 0; row < judging.rows(); ++row) {
    const int set = judging.set[row];
    if (int& group = judging.group[row]; group >= 0)
      group = group_index(data.sets[set], check.sets[set].groups[group]);
  }
  judging.check.assign(judging.set.size(), 1);
  data.rows = joined(taken(base.rows, fit), judging);
  // Steps of two plans: their numbers say nothing of each other.
  data.rows.repeat.assign(data.rows.set.size(), -1);
  return data;
}

TouchDecision decide_on_touch(const Robot& robot, const Session& session, const Decoding& decoding,
                              const StepRecord& step, const Reading& reading, double search,
                              double tolerance) {
  if (const std::string why = robot.has_loops() ? cannot_stand(robot, reading.q) : ""; !why.empty())
    return {TouchOutcome::outlier, why};
  const int set = set_index(decoding, step.set);
  const auto out_by = [&](const Eigen::VectorXd& from) {
    return decoding.outward[set].dot(endpoint(robot, reading.q) - endpoint(robot, from));
  };
  const double early = out_by(vector_of(step.touch));
  if (early > search)
    return {TouchOutcome::outlier,
            "touched " + format_number(std::round(early * 1e5) / 100) + " mm before the surface"};
  const auto good = good_touches(session, step.index);
  for (const TouchRecord* other : good) {
    const double apart = std::abs(out_by(reading_of(*other, decoding).q));
    if (apart > tolerance)
      return {TouchOutcome::differs,
              "differs by " + format_number(std::round(apart * 1e6)) + " um from the one before"};
  }
  return {};
}

TouchDecision decide_on_visit(const Robot& robot, const Reading& reading) {
  const std::string why = cannot_stand(robot, reading.q);
  return why.empty() ? TouchDecision{} : TouchDecision{TouchOutcome::outlier, why};
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

std::optional<double> running_residual(const Robot& robot, const DataSet& data) {
  const int last = data.rows.rows() - 1;
  if (last < 0 || std::ranges::count(data.rows.set, data.rows.set[last]) < kRowsForResidual)
    return std::nullopt;
  for (const int set : data.rows.set)
    if (const int shared = data.sets[set].reference;
        shared >= 0 && std::ranges::count(data.rows.set, shared) < kRowsForResidual)
      return std::nullopt;
  const Equations equations(robot, data, Use::fit);
  State state;
  state.xi = values(robot);
  state.nuisance.resize(data.sets.size());
  state.groups.resize(data.sets.size());
  equations.start(state);
  for (const RowResidual& row : equations.residuals(state))
    if (row.row == last) return row.lengths == 1 ? row.scalars[0] : row.length;
  return std::nullopt;
}

}  // namespace selfcal
