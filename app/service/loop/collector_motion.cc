// What the robot is asked: moves of the touch in progress, and to stop.
#include "app/service/loop/collector.h"
#include "app/service/session/slow_height.h"

namespace selfcal {
namespace {

/// The trigger's change that ends the move. Out of a contact the way is free, and a lock closes and
/// opens it; everywhere else a contact ends the move.
std::optional<bool> stopped_by(MoveKind kind) {
  switch (kind) {
    case MoveKind::retract:
    case MoveKind::lock:
    case MoveKind::release:
      return std::nullopt;
    case MoveKind::visit:
      return false;
    default:
      return true;
  }
}

}  // namespace

void Collector::make_move(Action::Do what) {
  using Do = Action::Do;
  const StepRecord& step = session_.plan[c_.extended_state.step];
  const std::vector<double> home(c_.config.plan.home.begin(), c_.config.plan.home.end());
  const double travel = c_.config.speeds.travel;
  switch (what) {
    case Do::go_home:
      return move(MoveKind::travel, home, travel);
    case Do::go_along:
      return move(MoveKind::travel, step.way[step.way.size() - c_.extended_state.way], travel);
    case Do::go_to_start:
      return c_.extended_state.closed ? move(MoveKind::retract, step.start, touch_speed(step))
                                      : move(MoveKind::travel, step.start, travel);
    case Do::go_nearer:
      return move(MoveKind::travel, slow_from(c_.extended_state.step), travel / 4);
    case Do::go_touch:
      return move(step.group.empty() ? MoveKind::touch : MoveKind::seat, step.end,
                  touch_speed(step));
    case Do::go_back:
      return move(MoveKind::retract, step.start,
                  step.group.empty() ? travel : kRetreatFaster * touch_speed(step));
    case Do::lock:
      return move(MoveKind::lock, step.start, touch_speed(step));
    case Do::visit:
      return move(MoveKind::visit, step.touch, travel / 4);
    case Do::back_off:
      return move(MoveKind::retract, began_, travel / 4);
    default:
      return;
  }
}

std::vector<double> Collector::slow_from(int index) const {
  const Session recent = lately(session_, static_cast<std::size_t>(index));
  return selfcal::slow_from(*c_.models.active(), recent, decoding_, session_.plan[index],
                            c_.config.plan.search);
}

std::string Collector::label() const {
  int attempt = 0;
  for (const TouchRecord& touch : session_.touches) attempt += touch.step == c_.extended_state.step;
  return std::to_string(session_.record.id) + "/" + std::to_string(c_.extended_state.step) + "." +
         std::to_string(attempt) + " " + session_.plan[c_.extended_state.step].set +
         (is_loaded(c_.extended_state.step) ? kWithPayload : "");
}

double Collector::touch_speed(const StepRecord& step) const {
  const Eigen::VectorXd from = vector_of(step.start), to = vector_of(step.end);
  if (from.size() != to.size() || from.size() == 0) return c_.config.speeds.travel;
  const double way =
      (endpoint(*c_.models.active(), to) - endpoint(*c_.models.active(), from)).norm();
  if (way <= 0) return c_.config.speeds.travel;
  const double speed = step.slow ? c_.config.speeds.touch / kSlower : c_.config.speeds.touch;
  return std::min(c_.config.speeds.travel, speed / way * (to - from).cwiseAbs().maxCoeff());
}

void Collector::move(MoveKind kind, const std::vector<double>& q, double speed) {
  if (kind != MoveKind::retract) began_ = reached_;
  MotionRequest request;
  request.id = ++motion_id_;
  request.kind = kind;
  request.label = kind == MoveKind::lock
                      ? decoding_.sets[lock_of(c_.extended_state.step) - 1].method->lock()
                      : label();
  request.q = q;
  request.speed = speed;
  target_ = q;
  outstanding_ = true;
  stopped_ = 0;
  front_end_.expect(request.id);
  if (kind != MoveKind::visit) front_end_.forget_closing();  // that of the lock stays
  if (const auto sent = reflex_.request(request, stopped_by(kind)); !sent)
    c_.put(Event::What::broken, false, sent.error().what);
}

void Collector::arrived() {
  reached_ = target_;
  leave_alone();
}

void Collector::leave_alone() {
  outstanding_ = false;
  reflex_.unguard();
}

void Collector::release() {
  if (c_.extended_state.state == ServiceState::collecting)
    return move(MoveKind::release, reached_, c_.config.speeds.travel);
  const MotionRequest request{.id = ++motion_id_,
                              .kind = MoveKind::release,
                              .label = "whatever is locked",
                              .q = reached_,
                              .speed = c_.config.speeds.travel};
  if (const auto sent = reflex_.request(request, std::nullopt); !sent)
    c_.tell("error", "a lock may still be engaged: " + sent.error().what);
}

void Collector::stop(const std::string& why) {
  front_end_.expect(0);
  if (!outstanding_) return;  // what moves is not ours to stop
  stopped_ = c_.now;
  if (const auto sent = reflex_.stop(why); !sent) c_.tell("error", sent.error().what);
}

}  // namespace selfcal
