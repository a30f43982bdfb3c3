// What the transition says is done here, each by the part of the service that can.
#include "app/service/service.h"

namespace selfcal {

void Service::act(const Action& action) {
  using Do = Action::Do;
  switch (action.what) {
    case Do::stop:
      return stop(action.why);
    case Do::give_up:
      return give_up();
    case Do::test:
      return begin_test();
    case Do::plan:
      return begin_plan(action.why);
    case Do::resume:
      return resume();
    case Do::go_home:
    case Do::go_along:
    case Do::go_to_start:
    case Do::go_touch:
    case Do::go_back:
    case Do::back_off:
    case Do::lock:
    case Do::visit:
      return make_move(action.what);
    case Do::release:
      return release();
    case Do::read:
      return read();
    case Do::outlier:
      return outlier(action.why);
    case Do::abort:
      return abort(action.why);
    case Do::analyse:
      return analyse();
    case Do::identify:
      return identify();
    case Do::judge:
      return judge();
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
      return tell(situation_.state == ServiceState::fault ? "error" : "info", action.why);
  }
}

}  // namespace selfcal
