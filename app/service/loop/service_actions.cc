// What the transition says is done here, each by the part of the service that can.
#include "app/service/loop/service.h"

namespace selfcal {

void Service::act(const Action& action) {
  using Do = Action::Do;
  switch (action.what) {
    case Do::stop:
      return collector_.stop(action.why);
    case Do::give_up:
      return analyst_.give_up();
    case Do::test:
      return begin_test();
    case Do::plan:
      return analyst_.plan(action.why);
    case Do::resume:
      return collector_.resume();
    case Do::go_home:
    case Do::go_along:
    case Do::go_to_start:
    case Do::go_nearer:
    case Do::go_touch:
    case Do::go_back:
    case Do::back_off:
    case Do::lock:
    case Do::visit:
      return collector_.make_move(action.what);
    case Do::release:
      return collector_.release();
    case Do::read:
      return kept(collector_.read());
    case Do::outlier:
      return kept(collector_.outlier(action.why));
    case Do::abort:
      return abort(action.why);
    case Do::analyse:
      return analyst_.analyse();
    case Do::identify:
      return analyst_.identify();
    case Do::judge:
      return analyst_.judge();
    case Do::diagnose:
      return analyst_.diagnose(action.why);
    case Do::apply:
      return apply(action.why);
    case Do::reject:
      return reject();
    case Do::roll_back:
      return roll_back();
    case Do::publish:
      return publish();
    case Do::grant:
    case Do::refuse:
      return answer(action);
    case Do::tell:
      return c_.tell(c_.extended_state.state == ServiceState::fault ? "error" : "info", action.why);
  }
}

void Service::kept(const TouchRecord* touch) {
  if (touch) reporter_.progress(touch, touch->why);
}

void Service::abort(const std::string& why) {
  analyst_.give_up();
  // While a session is being planned the store has none of it yet.
  const auto unfinished = c_.store.unfinished();
  if (!c_.stored(unfinished)) return;
  if (!*unfinished) return c_.tell("warning", "planning ended early: " + why);
  const std::int64_t id = (*unfinished)->id;
  c_.stored(c_.store.set_state(id, SessionState::aborted, c_.unix_ms()));
  c_.tell("warning", "session " + std::to_string(id) + " ended early: " + why);
}

}  // namespace selfcal
