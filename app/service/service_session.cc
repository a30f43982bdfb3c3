// From the plan to the last touch.
#include <cmath>

#include "app/service/service.h"

namespace selfcal {
namespace {

constexpr double kNearPath = 0.05;  // rad or m

/// Distance from a straight joint path, largest joint.
double off_path(const Eigen::VectorXd& q, const StepRecord& step) {
  const Eigen::VectorXd from = vector_of(step.start), way = vector_of(step.end) - from;
  const double length = way.squaredNorm();
  const double s = length > 0 ? std::clamp((q - from).dot(way) / length, 0.0, 1.0) : 0.0;
  return (q - from - s * way).cwiseAbs().maxCoeff();
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

std::string Service::config_hash() const {
  return selfcal::config_hash(config_, ports_.encoders->scales());
}

bool Service::can_check() const {
  if (models_.session() == 0 || lasting(config_.sets, config_.targets).empty()) return false;
  const auto base = store_.session(models_.session());
  return base && base->config_hash == config_hash() && base->model_hash == models_.hash();
}

void Service::begin_plan(const std::string& why) {
  SessionRecord record;
  record.kind = std::string(to_string(situation_.kind));
  record.reason = why;
  record.model_hash = models_.hash();
  record.config = meaning_text(config_, ports_.encoders->scales());
  record.config_hash = config_hash();
  record.started_ms = ports_.clock->unix_ms();
  const auto sessions = store_.sessions(1);
  record.seed = sessions && !sessions->empty() ? sessions->front().id + 1 : 1;
  TouchPlanOptions options = config_.plan;
  options.seed = record.seed;
  const std::vector<TouchTarget> targets =
      situation_.kind == SessionKind::check
          ? shared_out(lasting(config_.sets, config_.targets), config_.schedule.check_touches)
          : config_.targets;
  auto plan = std::make_shared<TouchPlan>();
  computation_.start([plan, robot = models_.active(), sets = config_.sets, targets, options,
                      obstacles = config_.obstacles,
                      workspace = config_.workspace](const Computation::Tell& tell) {
    *plan =
        plan_touches(*robot, values(*robot), sets, targets, obstacles, workspace, options, tell);
    return std::string();
  });
  when_computed_ = [this, plan, record](const std::string& failure) {
    if (!failure.empty()) return put(Event::What::planned, false, "planning: " + failure);
    keep_plan(record, *plan);
  };
}

void Service::keep_plan(SessionRecord record, const TouchPlan& plan) {
  if (!plan.unreached.empty())
    return put(Event::What::planned, false, "planning: " + plan.unreached);
  const std::vector<StepRecord> steps = steps_of(plan, config_.sets);
  const auto id = store_.begin(record, steps);
  if (!stored(id)) return;
  record.id = *id;
  tell("info", "session " + std::to_string(*id) + " (" + record.kind + ", " + record.reason +
                   "): " + std::to_string(steps.size()) + " touches planned");
  if (open({record, steps, {}})) announce_plan();
}

bool Service::open(Session session) {
  auto meaning = read_meaning(session.record.config);
  if (!meaning) {
    put(Event::What::planned, false, meaning.error().what);
    return false;
  }
  meaning_ = std::move(*meaning);
  session_ = std::move(session);
  base_.reset();
  collecting_since_ = now_;
  touches_this_run_ = 0;
  return true;
}

void Service::resume() {
  const auto record = store_.unfinished();
  if (!stored(record)) return;
  const auto give_up = [&](const std::string& why) {
    if (*record)
      stored(store_.set_state((*record)->id, SessionState::aborted, ports_.clock->unix_ms()));
    put(Event::What::planned, false, why);
  };
  if (!*record) return give_up("there is no unfinished session");
  if ((*record)->model_hash != models_.hash() || (*record)->config_hash != config_hash())
    return give_up("session " + std::to_string((*record)->id) +
                   " was begun with another robot or configuration and is ended");
  auto plan = store_.plan((*record)->id);
  auto touches = store_.touches((*record)->id);
  if (!plan || !touches)
    return put(Event::What::broken, false, (!plan ? plan.error() : touches.error()).what);
  if (open({**record, std::move(*plan), std::move(*touches)})) announce_plan();
}

/// The touches of a quick check are made twice, so that a false trigger is no alarm.
int Service::repeats() const {
  return session_.kind() == SessionKind::check ? std::max(2, config_.touch.repeats)
                                               : config_.touch.repeats;
}

void Service::announce_plan() {
  Event event;
  event.what = Event::What::planned;
  event.kind = session_.kind();
  event.session = session_.record.id;
  event.steps = static_cast<int>(session_.plan.size());
  event.step = next_step(session_, repeats(), config_.limits.attempts);
  event.via_home = true;
  event.lock = lock_of(event.step);
  if (!senses_.encoders_alive(now_) || senses_.at_rest() != true)
    return put(Event::What::planned, false, "the robot does not stand still, or is silent");
  if (const std::string strangers = two_senders(); !strangers.empty())
    return put(Event::What::planned, false, strangers);
  const auto here = senses_.q();
  if (here) reached_.assign(here->begin(), here->end());
  if (here && event.step < event.steps) {
    const StepRecord& step = session_.plan[event.step];
    // It was in the middle of this very touch: the way back is the way out.
    const StepRecord* last =
        session_.touches.empty() ? nullptr : &session_.plan[session_.touches.back().step];
    // Whatever lock an earlier life has left engaged is released before anything moves.
    event.release = event.lock != 0 || (last && lock_of(last->index) != 0);
    // It was in the middle of this very touch: the way back is the way out.
    const bool in_it = !event.release && off_path(*here, step) < kNearPath;
    if (in_it) {
      event.via_home = false;
    } else if (!event.release && last && off_path(*here, *last) < kNearPath) {
      // The last touch was stored, and the robot is not out of it yet.
      event.back_off = true;
      reached_ = last->start;
    } else if (!path_is_free(*models_.active(), values(*models_.active()), *here, config_.plan.home,
                             config_.obstacles, 0)) {
      event.ok = false;
      event.why = "no free way home from where the robot stands: move it there by hand";
    }
  }
  put(std::move(event));
}

/// The plan's ways lead from one step to the next; after steps that were left out the way leads
/// through home.
void Service::tell_way(int step, Event& event) const {
  if (step >= static_cast<int>(session_.plan.size())) return;
  event.via_home = session_.plan[step].via_home || step > situation_.step + 1;
  event.way = static_cast<int>(session_.plan[step].way.size());
}

/// The lock that a step wants engaged, by its set from 1; 0 for none.
int Service::lock_of(int step) const {
  if (step >= static_cast<int>(session_.plan.size())) return 0;
  const int set = set_index(meaning_, session_.plan[step].set);
  return meaning_.sets[set].method->planned() == Planned::lock ? set + 1 : 0;
}

void Service::read() {
  if (situation_.engaged)
    read_visit();
  else
    read_touch();
}

/// The readings at rest, with the edge that confirmed the lock.
void Service::read_visit() {
  TouchRecord visit;
  visit.step = situation_.step;
  visit.edge = senses_.closing()->time;
  visit.before = visit.after = senses_.samples().last();
  const TouchRuling ruling = rule_on_visit(*models_.active(), reading_of(visit, meaning_));
  visit.outcome = ruling.outcome;
  visit.why = ruling.why;
  keep(std::move(visit));
}

void Service::read_touch() {
  const Nanoseconds edge = senses_.closing()->time;
  if (!senses_.closing()->timed)
    return outlier("the trigger's edge got lost, and with it the moment of the touch");
  const auto around = senses_.samples().around(edge - nanoseconds(config_.touch.delay));
  if (!around) return outlier("no encoder readings just before and after the edge");
  TouchRecord touch;
  touch.step = situation_.step;
  touch.edge = edge;
  std::tie(touch.before, touch.after) = *around;
  const Reading reading = reading_of(touch, meaning_);
  const TouchRuling ruling =
      rule_on_touch(*models_.active(), session_, meaning_, session_.plan[touch.step], reading,
                    config_.plan.search, config_.touch.tolerance);
  touch.outcome = ruling.outcome;
  touch.why = ruling.why;
  keep(std::move(touch));
}

void Service::outlier(const std::string& why) {
  TouchRecord touch;
  touch.step = situation_.step;
  touch.outcome = TouchOutcome::outlier;
  touch.why = why;
  if (!senses_.samples().empty()) touch.before = touch.after = senses_.samples().last();
  keep(std::move(touch));
}

void Service::keep(TouchRecord touch) {
  for (const TouchRecord& other : session_.touches) touch.attempt += other.step == touch.step;
  touch.unix_ms = ports_.clock->unix_ms();
  touch.temperature = senses_.celsius().value_or(std::nan(""));
  const std::string called = label();
  // Before the robot moves on.
  if (!stored(store_.add(session_.record.id, touch))) return;
  session_.touches.push_back(touch);
  ++touches_this_run_;
  if (touch.outcome != TouchOutcome::taken) tell("warning", called + ": " + touch.why);
  Event event;
  event.what = Event::What::read;
  event.ok = touch.outcome == TouchOutcome::taken;
  event.why = touch.why;
  event.step = next_step(session_, repeats(), config_.limits.attempts);
  tell_way(event.step, event);
  event.lock = lock_of(event.step);
  put(std::move(event));
  tell_progress(&session_.touches.back(), touch.why);
}

void Service::abort(const std::string& why) {
  give_up();
  // While a session is being planned the store has none of it yet.
  const auto unfinished = store_.unfinished();
  if (!stored(unfinished)) return;
  if (!*unfinished) return tell("warning", "planning ended early: " + why);
  const std::int64_t id = (*unfinished)->id;
  stored(store_.set_state(id, SessionState::aborted, ports_.clock->unix_ms()));
  tell("warning", "session " + std::to_string(id) + " ended early: " + why);
}

}  // namespace selfcal
