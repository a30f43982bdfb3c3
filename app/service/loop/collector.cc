// From the plan to the last touch: how a session begins or goes on, and what comes of each touch.
#include <cmath>

#include "app/service/loop/collector.h"
#include "app/service/session/touch_decision.h"
#include "kinematics/expects.h"
#include "kinematics/size.h"

namespace selfcal {
namespace {

constexpr double kNearPath = 0.05;  // of a joint's unit

/// Distance from a straight joint path in units of the joints' readings, largest joint.
double off_path(const Robot& robot, const Eigen::VectorXd& q, const StepRecord& step) {
  const Eigen::VectorXd from = vector_of(step.start), way = vector_of(step.end) - from;
  const double length = way.squaredNorm();
  const double s = length > 0 ? std::clamp((q - from).dot(way) / length, 0.0, 1.0) : 0.0;
  return ((q - from - s * way).array().abs() / units_of_readings(robot)).maxCoeff();
}

}  // namespace

Collector::Collector(ServiceContext& context)
    : c_(context),
      reflex_(context.ports, nanoseconds(context.config.touch.debounce)),
      front_end_(context.ports, reflex_, units_of_readings(*context.config.robot),
                 context.config.touch.rest, nanoseconds(context.config.silence)) {
  // Requests of an earlier life must not be taken for ours.
  motion_id_ = static_cast<std::uint64_t>(c_.unix_ms()) * 1000;
}

void Collector::open(Session session) {
  auto decoding = read_decoding(session.record.config);
  session_ = std::move(session);
  if (!decoding) return refuse_plan(decoding.error().what);
  decoding_ = std::move(*decoding);
  collecting_since_ = c_.now;
  touches_this_run_ = 0;
  announce_plan();
}

void Collector::resume() {
  const auto record = c_.store.unfinished();
  if (!c_.stored(record)) return;
  const auto give_up = [&](const std::string& why) {
    if (*record) c_.stored(c_.store.set_state((*record)->id, SessionState::aborted, c_.unix_ms()));
    Event event;
    event.what = Event::What::planned;
    event.ok = false;
    event.ended = true;
    event.why = why;
    c_.put(std::move(event));
  };
  if (!*record) return give_up("there is no unfinished session");
  if ((*record)->model_hash != c_.models.hash() || (*record)->config_hash != c_.config_hash())
    return give_up("session " + std::to_string((*record)->id) +
                   " was begun with another robot or configuration and is ended");
  if ((*record)->kind == to_string(SessionKind::check) && !c_.can_compare())
    return give_up("session " + std::to_string((*record)->id) +
                   " is ended: a quick check compares with an accepted session, and " +
                   c_.models.name() + " is active");
  auto plan = c_.store.plan((*record)->id);
  auto touches = c_.store.touches((*record)->id);
  if (!plan || !touches)
    return c_.put(Event::What::broken, false, (!plan ? plan.error() : touches.error()).what);
  recalled_ = true;
  open({**record, std::move(*plan), std::move(*touches)});
}

/// The touches of a quick check are made twice, so that a false trigger is no alarm.
int Collector::repeats() const {
  return session_.kind() == SessionKind::check ? std::max(2, c_.config.touch.repeats)
                                               : c_.config.touch.repeats;
}

int Collector::next() const { return next_step(session_, repeats(), c_.config.limits.attempts); }

double Collector::seconds_each() const {
  return touches_this_run_ > 0 ? seconds(c_.now - collecting_since_) / touches_this_run_
                               : std::nan("");
}

void Collector::refuse_plan(const std::string& why, bool later) {
  Event event;
  event.what = Event::What::planned;
  event.ok = false;
  event.why = why;
  event.later = later;
  event.session = session_.record.id;
  c_.put(std::move(event));
}

void Collector::announce_plan() {
  Event event;
  event.what = Event::What::planned;
  event.kind = session_.kind();
  event.session = session_.record.id;
  event.steps = static_cast<int>(session_.plan.size());
  event.step = next();
  event.via_home = true;
  event.lock = lock_of(event.step);
  event.loaded = is_loaded(event.step);
  event.load_unknown = std::exchange(recalled_, false) && touched_loaded();
  if (const std::string why = unfit(); !why.empty()) return refuse_plan(why, !stands());
  const auto here = front_end_.q();
  if (here) reached_.assign(here->begin(), here->end());
  began_ = reached_;
  if (here && event.step < event.steps) {
    const StepRecord& step = session_.plan[event.step];
    const StepRecord* last =
        session_.touches.empty() ? nullptr : &session_.plan[session_.touches.back().step];
    // Whatever lock an earlier life has left engaged is released before anything moves.
    event.release = event.lock != 0 || (last && lock_of(last->index) != 0);
    // It was in the middle of this very touch: the way back is the way out.
    const bool in_it = !event.release && off_path(*c_.models.active(), *here, step) < kNearPath;
    if (in_it) {
      event.via_home = false;
      if (front_end_.closed() == true) began_ = step.start;
    } else if (!event.release && last && off_path(*c_.models.active(), *here, *last) < kNearPath) {
      // The last touch was stored, and the robot is not out of it yet.
      event.back_off = true;
      began_ = last->start;
    } else if (is_shut_in(*here)) {
      event.ok = false;
      event.why = kShutIn;
    }
  }
  c_.put(std::move(event));
}

/// The plan's ways lead from one step to the next; after steps that were left out the way leads
/// through home.
void Collector::tell_way(int step, Event& event) const {
  if (step >= static_cast<int>(session_.plan.size())) return;
  event.via_home = session_.plan[step].via_home || step > c_.extended_state.step + 1;
  event.way = static_cast<int>(session_.plan[step].way.size());
  event.nearer = may_come_nearer(step);
}

/// Where the last attempt was felt too early, or not at all, the next one is slow all the way.
bool Collector::may_come_nearer(int step) const {
  if (lock_of(step) != 0) return false;
  const TouchRecord* last = session_.touches.empty() ? nullptr : &session_.touches.back();
  if (last && last->step == step && last->outcome == TouchOutcome::outlier) return false;
  return slow_from(step) != session_.plan[step].start;
}

bool Collector::is_loaded(int step) const {
  return step < static_cast<int>(session_.plan.size()) && session_.plan[step].loaded;
}

bool Collector::touched_loaded() const {
  return std::ranges::any_of(session_.plan, &StepRecord::loaded);
}

int Collector::lock_of(int step) const {
  if (step >= static_cast<int>(session_.plan.size())) return 0;
  const int set = set_index(decoding_, session_.plan[step].set);
  return decoding_.sets[set].method->planned() == Planned::lock ? set + 1 : 0;
}

const TouchRecord* Collector::read() {
  return c_.extended_state.engaged ? read_visit() : read_touch();
}

/// The readings at rest, with the edge that confirmed the lock.
const TouchRecord* Collector::read_visit() {
  expects(front_end_.closing().has_value() && !front_end_.samples().empty(),
          "a lock is confirmed at rest");
  TouchRecord visit;
  visit.step = c_.extended_state.step;
  visit.edge = front_end_.closing()->time;
  visit.before = visit.after = front_end_.samples().last();
  const TouchDecision decided = decide_on_visit(*c_.models.active(), reading_of(visit, decoding_));
  visit.outcome = decided.outcome;
  visit.why = decided.why;
  return keep(std::move(visit));
}

const TouchRecord* Collector::read_touch() {
  expects(front_end_.closing().has_value(), "a touch is read behind its edge");
  expects(c_.extended_state.step < static_cast<int>(session_.plan.size()),
          "a touch is of the plan");
  const Nanoseconds edge = front_end_.closing()->time;
  if (!front_end_.closing()->timed)
    return outlier("the trigger's edge got lost, and with it the moment of the touch");
  const auto around = front_end_.samples().around(edge - nanoseconds(c_.config.touch.delay));
  if (!around) return outlier("no encoder readings just before and after the edge");
  TouchRecord touch;
  touch.step = c_.extended_state.step;
  touch.edge = edge;
  std::tie(touch.before, touch.after) = *around;
  const Reading reading = reading_of(touch, decoding_);
  const TouchDecision decided =
      decide_on_touch(*c_.models.active(), session_, decoding_, session_.plan[touch.step], reading,
                      c_.config.plan.search, c_.config.touch.tolerance);
  touch.outcome = decided.outcome;
  touch.why = decided.why;
  return keep(std::move(touch));
}

const TouchRecord* Collector::outlier(const std::string& why) {
  TouchRecord touch;
  touch.step = c_.extended_state.step;
  touch.outcome = TouchOutcome::outlier;
  touch.why = why;
  if (!front_end_.samples().empty()) touch.before = touch.after = front_end_.samples().last();
  return keep(std::move(touch));
}

const TouchRecord* Collector::keep(TouchRecord touch) {
  for (const TouchRecord& other : session_.touches) touch.attempt += other.step == touch.step;
  touch.unix_ms = c_.unix_ms();
  touch.temperature = front_end_.celsius().value_or(std::nan(""));
  const std::string called = label();
  // Before the robot moves on.
  if (!c_.stored(c_.store.add(session_.record.id, touch))) return nullptr;
  session_.touches.push_back(touch);
  ++touches_this_run_;
  if (touch.outcome != TouchOutcome::taken) c_.tell("warning", called + ": " + touch.why);
  Event event;
  event.what = Event::What::read;
  event.ok = touch.outcome == TouchOutcome::taken;
  event.why = touch.why;
  event.step = next();
  tell_way(event.step, event);
  event.lock = lock_of(event.step);
  event.loaded = is_loaded(event.step);
  c_.put(std::move(event));
  return &session_.touches.back();
}

}  // namespace selfcal
