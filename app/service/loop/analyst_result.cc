// What a session came to, as the store has it.
#include "app/service/loop/analyst.h"
#include "io/files/robot_file.h"
#include "io/files/solution_json.h"

namespace selfcal {
namespace {

ResultAnswer stored_answer(Answer verdict) {
  switch (verdict) {
    case Answer::improved:
      return ResultAnswer::improved;
    case Answer::not_improved:
      return ResultAnswer::not_improved;
    case Answer::not_determined:
      return ResultAnswer::not_determined;
  }
  return ResultAnswer::failed;
}

/// What the service does next.
Event::Decision next_after(const ResultRecord& result) {
  if (result.decision == ResultDecision::applying) return Event::Decision::apply;
  if (result.decision == ResultDecision::candidate) return Event::Decision::ask;
  return result.answer == ResultAnswer::not_explained ? Event::Decision::full
                                                      : Event::Decision::none;
}

}  // namespace

ResultRecord Analyst::new_result(const ResultFigures& figures) const {
  ResultRecord result;
  static_cast<ResultFigures&>(result) = figures;
  result.session = collector_.session().record.id;
  result.unix_ms = c_.unix_ms();
  result.touches = static_cast<std::uint32_t>(data_->rows.rows());
  return result;
}

ResultRecord Analyst::result_of_failure(const std::string& why) const {
  ResultRecord result = new_result({});
  result.answer = ResultAnswer::failed;
  result.decision = ResultDecision::rejected;
  result.why = why;
  return result;
}

ResultRecord Analyst::result_of_check() {
  last_check_ = decide_on_check(*solution_, *unchanged_, c_.config.schedule.check_p);
  const CheckDecision& decided = *last_check_;
  ResultRecord result = new_result(decided);
  result.touches -= static_cast<std::uint32_t>(std::ranges::count(data_->rows.check, 0));
  result.answer = decided.explained ? ResultAnswer::explained : ResultAnswer::not_explained;
  result.decision = ResultDecision::none;
  result.why = decided.why;
  return result;
}

ResultRecord Analyst::result_of_candidate() const {
  const AcceptanceDecision decided =
      decide_on_result(c_.config.accept, *c_.models.active(), *solution_, *unchanged_);
  ResultRecord result = new_result(decided);
  result.answer = stored_answer(decided.answer);
  result.decision = !decided.acceptable                           ? ResultDecision::rejected
                    : decided.asks || !c_.config.accept.automatic ? ResultDecision::candidate
                                                                  : ResultDecision::applying;
  result.why = decided.why;
  result.json = to_json(*solution_, c_.config.robot->name(), c_.models.hash()).dump();
  result.robot_text = robot_text(*c_.models.active(), solution_->values);
  return result;
}

bool Analyst::more_than_noise() const {
  const FitDecision decided = decide_on_fit(*solution_, data_->sets);
  if (decided.noise) return false;
  c_.tell("warning",
          "session " + std::to_string(collector_.session().record.id) + ": " + decided.why);
  return c_.config.causes.automatic;
}

void Analyst::keep_result(const ResultRecord& result, bool cause) {
  const bool candidate =
      result.decision == ResultDecision::applying || result.decision == ResultDecision::candidate;
  const bool explained = result.answer == ResultAnswer::explained;
  const SlotRecord slot{result.session, result.unix_ms, c_.models.hash(), result.robot_text};
  Event event;
  event.what = Event::What::decided;
  event.why = result.why;
  event.session = result.session;
  event.cause = cause;
  event.decision = next_after(result);
  // With what is to follow: a power cut may come before that is taken up.
  const std::string wanted = event.decision == Event::Decision::full
                                 ? std::string(to_string(SessionKind::full))
                             : cause ? std::string(to_string(SessionKind::cause))
                                     : std::string();
  if (!c_.stored(c_.store.finish(result, candidate ? &slot : nullptr, {kWanted, wanted}))) return;
  c_.put(std::move(event));  // before anything else can fail
  c_.tell(candidate || explained ? "info" : "warning",
          "session " + std::to_string(result.session) + ": " +
              std::string(to_string(result.answer)) + ", " +
              std::string(to_string(result.decision)) + ": " + result.why);
  c_.use.calendar.session_ended();
  c_.use.motion_hours_then = c_.use.motion_hours;
  c_.use.temperature_then = collector_.front_end().celsius();
  c_.use.checks = explained ? c_.use.checks + 1 : 0;
  c_.remember_use();
  c_.prune();
}

}  // namespace selfcal
