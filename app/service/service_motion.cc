// What the robot is asked: moves of the touch in progress, and to stop.
#include "app/service/service.h"

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

/// The move of an action, for the touch in progress.
void Service::make_move(Action::Do what) {
  using Do = Action::Do;
  const StepRecord& step = session_.plan[situation_.step];
  const std::vector<double> home(config_.plan.home.begin(), config_.plan.home.end());
  const double travel = config_.speeds.travel;
  switch (what) {
    case Do::go_home:
      return move(MoveKind::travel, home, travel);
    case Do::go_along:
      return move(MoveKind::travel, step.way[step.way.size() - situation_.way], travel);
    case Do::go_to_start:
      return situation_.closed ? move(MoveKind::retract, step.start, touch_speed(step))
                               : move(MoveKind::travel, step.start, travel);
    case Do::go_touch:
      return move(step.group.empty() ? MoveKind::touch : MoveKind::seat, step.end,
                  touch_speed(step));
    case Do::go_back:
      return move(MoveKind::retract, step.start, kRetreatFaster * touch_speed(step));
    case Do::lock:
      return move(MoveKind::lock, step.start, touch_speed(step));
    case Do::visit:
      return move(MoveKind::visit, step.touch, travel / 4);
    case Do::back_off:
      return move(MoveKind::retract, reached_, travel / 4);
    default:
      return;
  }
}

std::string Service::label() const {
  int attempt = 0;
  for (const TouchRecord& touch : session_.touches) attempt += touch.step == situation_.step;
  return std::to_string(session_.record.id) + "/" + std::to_string(situation_.step) + "." +
         std::to_string(attempt) + " " + session_.plan[situation_.step].set;
}

double Service::touch_speed(const StepRecord& step) const {
  const Eigen::VectorXd from = vector_of(step.start), to = vector_of(step.end);
  if (from.size() != to.size() || from.size() == 0) return config_.speeds.travel;
  const double way = (endpoint(*models_.active(), to) - endpoint(*models_.active(), from)).norm();
  if (way <= 0) return config_.speeds.travel;
  return std::min(config_.speeds.travel,
                  config_.speeds.touch / way * (to - from).cwiseAbs().maxCoeff());
}

void Service::move(MoveKind kind, const std::vector<double>& q, double speed) {
  MotionRequest request;
  request.id = ++motion_id_;
  request.kind = kind;
  request.label =
      kind == MoveKind::lock ? meaning_.sets[lock_of(situation_.step) - 1].method->lock() : label();
  request.q = q;
  request.speed = speed;
  asked_ = q;
  outstanding_ = true;
  stopped_ = 0;
  senses_.expect(request.id);
  if (kind != MoveKind::visit) senses_.forget_closing();  // that of the lock stays
  if (const auto sent = reflex_.request(request, stopped_by(kind)); !sent)
    put(Event::What::broken, false, sent.error().what);
}

/// Opens whatever lock is engaged: as a move of its own while collecting, whose end is waited for;
/// else beside the stop, which is said again until the robot stands.
void Service::release() {
  if (situation_.state == ServiceState::collecting)
    return move(MoveKind::release, reached_, config_.speeds.travel);
  const MotionRequest request{.id = ++motion_id_,
                              .kind = MoveKind::release,
                              .label = "whatever is locked",
                              .q = reached_,
                              .speed = config_.speeds.travel};
  if (const auto sent = reflex_.request(request, std::nullopt); !sent)
    tell("error", "a lock may still be engaged: " + sent.error().what);
}

void Service::stop(const std::string& why) {
  senses_.expect(0);
  if (!outstanding_) return;  // what moves is not ours to stop
  stopped_ = now_;
  if (const auto sent = reflex_.stop(why); !sent) tell("error", sent.error().what);
}

}  // namespace selfcal
