#include "app/service/session/session_rows.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "constraints/equations/equations.h"
#include "constraints/estimation/engagements.h"
#include "kinematics/statics.h"

namespace selfcal {
namespace {

constexpr int kRowsForResidual = 5;      // of one set, before its surface is known at all
constexpr double kSpeedStep = 1e-3;      // s, over which a speed is taken
constexpr double kStepOfWallClock = 60;  // s, more than what keeps it right makes of it

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

/// Of a mass (kg) whose centre is at the tip: on the tool, in its axes.
Eigen::RowVectorXd wrench_of(const Robot& robot, const Eigen::VectorXd& q, double mass) {
  Eigen::RowVectorXd wrench = Eigen::RowVectorXd::Zero(6);
  wrench.head<3>() =
      (mass * locate(robot, values(robot), q).R.transpose() * gravity_of(robot)).transpose();
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

/// When its readings hold: at the edge; under a lock, whose edge is long past, at its sample.
Nanoseconds moment_of(const TouchRecord& touch) { return std::max(touch.edge, touch.before.time); }

/// By the edges, which no step of the wall clock moves; by that clock where the computer has
/// started anew in between, and the edges count from two starts. It has for sure where they run
/// backwards, and as good as surely where the wall clock says more than a minute more and that the
/// last start is since the first of them.
double seconds_between(const TouchRecord& before, const TouchRecord& after) {
  const double edges = seconds(moment_of(after) - moment_of(before));
  const double wall = static_cast<double>(after.unix_ms - before.unix_ms) / 1000;
  const bool anew =
      edges < 0 || (wall - edges > kStepOfWallClock && wall > seconds(moment_of(after)));
  return anew ? std::max(0.0, wall) : edges;
}

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
  Observations held_out = check.rows;
  for (int row = 0; row < held_out.rows(); ++row) {
    const int set = held_out.set[row];
    if (int& group = held_out.group[row]; group >= 0)
      group = group_index(data.sets[set], check.sets[set].groups[group]);
  }
  held_out.check.assign(held_out.set.size(), 1);
  data.rows = joined(taken(base.rows, fit), held_out);
  // Steps of two plans: their numbers say nothing of each other.
  data.rows.repeat.assign(data.rows.set.size(), -1);
  return data;
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
