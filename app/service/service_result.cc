// From the rows to the decision, and what becomes of it.
#include <spdlog/spdlog.h>

#include "app/service/service.h"
#include "constraints/site.h"
#include "io/files/robot_file.h"
#include "io/files/solution_json.h"
#include "io/files/yaml.h"

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

void Service::analyse() {
  if (!stored(
          store_.set_state(session_.record.id, SessionState::collected, ports_.clock->unix_ms())))
    return;
  const bool check = session_.kind() == SessionKind::check;
  data_ = std::make_shared<DataSet>(
      rows_of(*models_.active(), session_, meaning_, check ? Parts::all_check : Parts::as_planned));
  if (!check) {
    const std::string few = too_few(*data_);
    return put(Event::What::computed, few.empty(), few);
  }
  join_base();
}

/// A quick check is judged beside the session behind the active parameters.
void Service::join_base() {
  const auto record = store_.session(models_.session());
  auto plan = store_.plan(models_.session());
  auto touches = store_.touches(models_.session());
  if (!record || !plan || !touches)
    return put(Event::What::computed, false, "the session behind the active parameters is gone");
  const Session base{*record, std::move(*plan), std::move(*touches)};
  const auto meaning = read_meaning(base.record.config);
  if (!meaning) return put(Event::What::computed, false, meaning.error().what);
  base_ = std::make_shared<DataSet>(rows_of(*models_.active(), base, *meaning));
  *data_ = joined(*base_, *data_);
  put(Event::What::computed);
}

void Service::identify() {
  auto found = std::make_shared<Engagements>();
  computation_.start(
      [found, robot = models_.active(), data = data_](const Computation::Tell& tell) {
        *found = identify_engagements(*on_site(robot, *data), *data, {}, tell);
        return std::string();
      });
  when_computed_ = [this, found](const std::string& failure) {
    if (failure.empty()) keep_solution(std::move(*found));
    put(Event::What::computed, failure.empty(), failure);
  };
}

/// What is judged then are the rows that were used, as they were used.
void Service::keep_solution(Engagements found) {
  const std::vector<int> steps = steps_of_rows(session_, meaning_);
  const auto configuration = [&](int row) { return std::to_string(steps[row] + 1); };
  for (const LockSlip& slip : found.solution.slips)
    tell("warning", slip.lock + " (set " + slip.set + "): the lock slipped by " +
                        format_number(std::round(slip.angle * 1e5) / 100) +
                        " mrad between configurations " + configuration(slip.before) + " and " +
                        configuration(slip.after) + " of " + std::to_string(session_.plan.size()) +
                        "; those after it have a direction of their own");
  for (const std::string& name : found.solution.locks_put_aside)
    tell("warning", "set " + name + ": its lock slipped again and again; all of it is put aside");
  solution_ = std::make_shared<Solution>(std::move(found.solution));
  found.data.rows = taken(found.data.rows, found.kept);
  data_ = std::make_shared<DataSet>(std::move(found.data));
}

void Service::give_up() {
  computation_.give_up();
  when_computed_ = {};
}

void Service::judge() {
  const bool check = session_.kind() == SessionKind::check;
  unchanged_ = std::make_shared<Solution>();
  if (check) solution_ = std::make_shared<Solution>();
  computation_.start([unchanged = unchanged_, then = check ? solution_ : nullptr,
                      robot = models_.active(), data = data_,
                      base = base_](const Computation::Tell& tell) {
    *unchanged = judge_as_it_is(*on_site(robot, *data), *data, tell);
    if (then) *then = judge_as_it_is(*on_site(robot, *base), *base, tell);
    return std::string();
  });
  when_computed_ = [this, check](const std::string& failure) {
    const ResultRecord result = !failure.empty() ? result_of_failure(failure)
                                : check          ? result_of_check()
                                                 : result_of_candidate();
    keep_result(result);
  };
}

ResultRecord Service::new_result() const {
  ResultRecord result;
  result.session = session_.record.id;
  result.unix_ms = ports_.clock->unix_ms();
  result.touches = data_->rows.rows();
  return result;
}

ResultRecord Service::result_of_failure(const std::string& why) const {
  ResultRecord result = new_result();
  result.answer = ResultAnswer::failed;
  result.decision = ResultDecision::rejected;
  result.why = why;
  return result;
}

ResultRecord Service::result_of_check() {
  last_check_ = rule_on_check(*solution_, *unchanged_, config_.schedule.check_p);
  const CheckRuling& ruling = *last_check_;
  ResultRecord result = new_result();
  result.touches -= static_cast<int>(std::ranges::count(data_->rows.check, 0));
  result.answer = ruling.explained ? ResultAnswer::explained : ResultAnswer::not_explained;
  result.decision = ResultDecision::none;
  result.why = ruling.why;
  result.p_value = ruling.p_value;
  result.check_before = ruling.expected;
  result.check_after = ruling.rms;
  return result;
}

ResultRecord Service::result_of_candidate() const {
  const AcceptanceDecision ruling =
      rule_on_result(config_.accept, *models_.active(), *solution_, *unchanged_);
  ResultRecord result = new_result();
  result.answer = stored_answer(ruling.answer);
  result.decision = !ruling.acceptable                         ? ResultDecision::rejected
                    : ruling.asks || !config_.accept.automatic ? ResultDecision::candidate
                                                               : ResultDecision::applying;
  result.why = ruling.why;
  result.p_value = solution_->verdict.p_value;
  result.check_before = ruling.check_before;
  result.check_after = ruling.check_after;
  result.endpoint_sigma = solution_->workspace.rms;
  result.rejected = rows_put_aside(*solution_);
  result.identified = parameters_identified(*solution_);
  result.json = to_json(*solution_, config_.robot->name(), models_.hash()).dump();
  result.robot_text = robot_text(*models_.active(), solution_->values);
  return result;
}

void Service::keep_result(const ResultRecord& result) {
  const bool candidate =
      result.decision == ResultDecision::applying || result.decision == ResultDecision::candidate;
  const bool explained = result.answer == ResultAnswer::explained;
  const SlotRecord slot{result.session, result.unix_ms, models_.hash(), result.robot_text};
  if (!stored(store_.finish(result, candidate ? &slot : nullptr))) return;
  tell(candidate || explained ? "info" : "warning",
       "session " + std::to_string(result.session) + ": " + std::string(to_string(result.answer)) +
           ", " + std::string(to_string(result.decision)) + ": " + result.why);
  since_.unix_ms = result.unix_ms;
  since_.motion_hours = motion_hours_;
  since_.temperature = senses_.celsius();
  since_.checks = explained ? since_.checks + 1 : 0;
  remember_use();
  stored(store_.prune(config_.store_bytes));
  Event event;
  event.what = Event::What::decided;
  event.why = result.why;
  event.decision = next_after(result);
  put(std::move(event));
}

bool Service::reload_models() {
  auto models = Models::load(models_.factory(), store_);
  if (!models) {
    put(Event::What::broken, false, "store: " + models.error().what);
    return false;
  }
  models_ = std::move(*models);
  if (const auto written = models_.write_active(config_.state); !written) {
    put(Event::What::broken, false, written.error().what);
    return false;
  }
  return true;
}

void Service::apply(const std::string& why) {
  if (!stored(store_.accept(ports_.clock->unix_ms())) || !reload_models()) return;
  last_check_.reset();
  tell("info", models_.name() + " is active: " + why);
  put(Event::What::applied);
}

void Service::finish_interrupted_apply() {
  const auto last = store_.results(1);
  if (!last || last->empty() || last->front().decision != ResultDecision::applying) return;
  const auto slot = store_.slot(Slot::candidate);
  if (!slot || !*slot || (*slot)->session != last->front().session ||
      (*slot)->model_hash != models_.hash())
    return;
  if (stored(store_.accept(ports_.clock->unix_ms())) && reload_models())
    tell("info", models_.name() + " is active: the power had failed while it was applied");
}

void Service::reject() {
  if (stored(store_.reject(ports_.clock->unix_ms()))) reload_models();
}

void Service::roll_back() {
  const std::string given_up = models_.name();
  const auto done = store_.roll_back(ports_.clock->unix_ms());
  if (!done) {
    if (command_) refuse(*command_, done.error().what + "; active: " + models_.name());
    return;
  }
  if (!reload_models()) return;
  const std::string said = models_.name() + " is active now; " + given_up +
                           " was rolled back and is not used again by itself";
  if (command_) messenger_.reply({command_->id, command_->verb, true, said});
  tell("warning", said);
}

void Service::publish() {
  const auto results = store_.results(1);
  if (results && !results->empty()) {
    const auto result = store_.result(results->front().session);
    if (stored(result) && *result) publish(**result);
  }
  put(Event::What::published);
}

void Service::publish(const ResultRecord& result) {
  ResultMessage message;
  message.unix_ms = result.unix_ms;
  message.robot = config_.id;
  message.model_hash = models_.hash();
  message.session = result.session;
  const auto session = store_.session(result.session);
  message.kind = session ? session->kind : "";
  message.answer = to_string(result.answer);
  message.decision = to_string(result.decision);
  message.why = result.why;
  message.p_value = result.p_value;
  message.check_before = result.check_before;
  message.check_after = result.check_after;
  message.endpoint_sigma = result.endpoint_sigma;
  message.touches = static_cast<std::uint32_t>(result.touches);
  message.rejected = static_cast<std::uint32_t>(result.rejected);
  message.identified = static_cast<std::uint32_t>(result.identified);
  message.json = result.json;
  messenger_.publish(message);
}

}  // namespace selfcal
