// Planning, identifying, judging: what is computed, and what is done once it has ended.
#include "app/service/loop/analyst.h"

#include <cmath>

#include "app/service/session/cause_search.h"
#include "app/service/session/session_rows.h"
#include "constraints/measurement_context.h"

namespace selfcal {
namespace {

constexpr int kFewestRows = 4;  // of a set, to say anything of it

/// The first set that has too few rows; empty when none has.
std::string too_few(const DataSet& data) {
  for (std::size_t s = 0; s < data.sets.size(); ++s) {
    const auto rows = std::ranges::count(data.rows.set, static_cast<int>(s));
    if (rows < kFewestRows)
      return "set " + data.sets[s].name + " has only " + std::to_string(rows) +
             (data.sets[s].method->planned() == Planned::lock ? " good configurations"
                                                              : " good touches");
  }
  return {};
}

/// The targets with `touches` in all, as evenly as they go; those that get none are left out.
std::vector<TouchTarget> shared_out(std::vector<TouchTarget> targets, std::size_t touches) {
  for (std::size_t i = 0; i < targets.size(); ++i)
    targets[i].touches =
        static_cast<int>((i + 1) * touches / targets.size() - i * touches / targets.size());
  std::erase_if(targets, [](const TouchTarget& target) { return target.touches == 0; });
  return targets;
}

/// A lock is engaged at another direction each time: only what stays where it is can be checked.
std::vector<TouchTarget> lasting(const std::vector<Set>& sets, std::vector<TouchTarget> targets) {
  std::erase_if(targets, [&](const TouchTarget& target) {
    return sets[target.set].method->planned() == Planned::lock;
  });
  return targets;
}

}  // namespace

bool Analyst::can_check() const {
  return !lasting(c_.config.sets, c_.config.targets).empty() && c_.can_compare();
}

SessionRecord Analyst::new_record(const std::string& why) const {
  SessionRecord record;
  record.kind = std::string(to_string(c_.extended_state.kind));
  record.reason = why;
  record.model_hash = c_.models.hash();
  record.config = decoding_text(c_.config, c_.ports.encoders->scales());
  record.config_hash = c_.config_hash();
  record.started_ms = c_.unix_ms();
  const auto sessions = c_.store.sessions(1);
  record.seed = sessions && !sessions->empty() ? sessions->front().id + 1 : 1;
  return record;
}

void Analyst::plan(const std::string& why) {
  if (c_.extended_state.stored) return plan_round();
  const SessionRecord record = new_record(why);
  TouchPlanOptions options = c_.config.plan;
  options.seed = record.seed;
  const std::vector<TouchTarget> targets =
      c_.extended_state.kind == SessionKind::check
          ? shared_out(lasting(c_.config.sets, c_.config.targets), c_.config.schedule.check_touches)
          : targets_of_round({});
  auto touches = std::make_shared<TouchPlan>();
  computation_.start([touches, robot = c_.models.active(), sets = c_.config.sets, targets, options,
                      obstacles = c_.config.obstacles,
                      workspace = c_.config.workspace](const Computation::Tell& tell) {
    *touches =
        plan_touches(*robot, values(*robot), sets, targets, obstacles, workspace, options, tell);
    return std::string();
  });
  when_computed_ = [this, touches, record](const std::string& failure) {
    if (!failure.empty()) return c_.put(Event::What::planned, false, "planning: " + failure);
    keep_plan(record, *touches);
  };
}

void Analyst::keep_plan(SessionRecord record, const TouchPlan& plan) {
  if (!plan.unreached.empty())
    return c_.put(Event::What::planned, false, "planning: " + plan.unreached);
  const std::vector<StepRecord> steps = steps_of(plan, c_.config.sets);
  const auto id = c_.store.begin(record, steps);
  if (!c_.stored(id)) return;
  record.id = *id;
  c_.tell("info", "session " + std::to_string(*id) + " (" + record.kind + ", " + record.reason +
                      "): " + std::to_string(steps.size()) + " touches planned");
  tell_left_out(plan);
  base_.reset();
  collector_.open({record, steps, {}});
}

void Analyst::tell_left_out(const TouchPlan& plan) const {
  if (!plan.left_out.empty()) c_.tell("warning", plan.left_out);
}

void Analyst::analyse() {
  if (!c_.stored(c_.store.set_state(collector_.session().record.id, SessionState::collected,
                                    c_.unix_ms())))
    return;
  if (collector_.session().kind() == SessionKind::cause) return c_.put(Event::What::computed);
  const bool check = collector_.session().kind() == SessionKind::check;
  data_ = std::make_shared<DataSet>(rows_of(*c_.models.active(), collector_.session(),
                                            collector_.decoding(),
                                            check ? Parts::all_check : Parts::as_planned));
  if (!check) {
    const std::string few = too_few(*data_);
    return c_.put(Event::What::computed, few.empty(), few);
  }
  join_base();
}

std::optional<Session> Analyst::stored_session(const SessionRecord& record) const {
  auto plan = c_.store.plan(record.id);
  auto touches = c_.store.touches(record.id);
  if (!plan || !touches) return std::nullopt;
  return Session{record, std::move(*plan), std::move(*touches)};
}

/// A quick check is judged beside the session behind the active parameters; where that looked for a
/// cause, beside the full one that it was looked for in, too.
void Analyst::join_base() {
  const auto gone = [&] {
    c_.put(Event::What::computed, false, "the session behind the active parameters is gone");
  };
  const auto record = c_.store.session(c_.models.session());
  if (!record) return gone();
  std::vector<SessionRecord> behind{*record};
  if (record->kind == to_string(SessionKind::cause)) {
    const auto full = base_of_cause(c_.store, record->model_hash, record->config_hash, record->id);
    if (!full) return gone();
    behind.insert(behind.begin(), *full);
  }
  base_.reset();
  for (const SessionRecord& each : behind) {
    const auto session = stored_session(each);
    if (!session) return gone();
    const auto decoding = read_decoding(each.config);
    if (!decoding) return c_.put(Event::What::computed, false, decoding.error().what);
    DataSet rows = rows_of(*c_.models.active(), *session, *decoding);
    if (rows.rows.rows() == 0) continue;
    base_ = std::make_shared<DataSet>(base_ ? merged(*base_, rows) : std::move(rows));
  }
  if (!base_) return gone();
  *data_ = joined(*base_, *data_);
  c_.put(Event::What::computed);
}

void Analyst::identify() {
  auto found = std::make_shared<Engagements>();
  computation_.start(
      [found, robot = c_.models.active(), data = data_](const Computation::Tell& tell) {
        Problems problems;
        const auto there = in_context(robot, *data, problems);
        if (!there) return problems.list.front();
        *found = identify_engagements(*there, *data, {}, tell);
        return std::string();
      });
  when_computed_ = [this, found](const std::string& failure) {
    if (!failure.empty()) return c_.put(Event::What::computed, false, failure);
    keep_solution(std::move(*found));
    Event event;
    event.what = Event::What::computed;
    event.more = wants_more();
    event.why = event.more ? "planning further touches from what is known by now" : "";
    c_.put(std::move(event));
  };
}

/// What is judged then are the rows that were used, as they were used.
void Analyst::keep_solution(Engagements found) {
  const std::vector<int> steps = steps_of_rows(collector_.session(), collector_.decoding());
  const auto configuration = [&](int row) { return std::to_string(steps[row] + 1); };
  for (const LockSlip& slip : found.solution.slips)
    c_.tell("warning", slip.lock + " (set " + slip.set + "): the lock slipped by " +
                           format_number(std::round(slip.angle * 1e5) / 100) +
                           " mrad between configurations " + configuration(slip.before) + " and " +
                           configuration(slip.after) + " of " +
                           std::to_string(collector_.session().plan.size()) +
                           "; those after it have a direction of their own");
  for (const std::string& name : found.solution.locks_left_out)
    c_.tell("warning",
            "set " + name + ": its lock slipped again and again; all of it is put aside");
  solution_ = std::make_shared<Solution>(std::move(found.solution));
  found.data.rows = taken(found.data.rows, found.kept);
  data_ = std::make_shared<DataSet>(std::move(found.data));
}

void Analyst::give_up() {
  computation_.give_up();
  when_computed_ = {};
}

void Analyst::take() {
  std::string failure;
  if (computation_.take(failure) && when_computed_) std::exchange(when_computed_, {})(failure);
}

std::optional<Computation::Progress> Analyst::progress() const {
  if (!computation_.running()) return std::nullopt;
  return computation_.progress();
}

void Analyst::judge() {
  const bool check = collector_.session().kind() == SessionKind::check;
  unchanged_ = std::make_shared<Solution>();
  if (check) solution_ = std::make_shared<Solution>();
  computation_.start([unchanged = unchanged_, then = check ? solution_ : nullptr,
                      robot = c_.models.active(), data = data_,
                      base = base_](const Computation::Tell& tell) {
    Problems problems;
    const auto now = in_context(robot, *data, problems);
    const auto before = then ? in_context(robot, *base, problems) : nullptr;
    if (problems.any()) return problems.list.front();
    *unchanged = judge_as_it_is(*now, *data, tell);
    if (then) *then = judge_as_it_is(*before, *base, tell);
    return std::string();
  });
  when_computed_ = [this, check](const std::string& failure) {
    const ResultRecord result = !failure.empty() ? result_of_failure(failure)
                                : check          ? result_of_check()
                                                 : result_of_candidate();
    keep_result(result, !check && failure.empty() && more_than_noise());
  };
}

}  // namespace selfcal
