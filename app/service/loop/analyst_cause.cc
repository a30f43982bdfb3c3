// Looking for a cause: diagnoses what a full session and the touches since have left, and asks for
// touches that tell look-alikes apart until the cause is named, nothing is left to tell, or the
// touches that the configuration allows are made.
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/report/diagnosis_json.h"
#include "app/service/loop/analyst.h"
#include "app/service/session/cause_search.h"
#include "app/service/session/session_rows.h"
#include "constraints/measurement_context.h"
#include "diagnosis/diagnosis.h"
#include "io/files/solution_json.h"

namespace selfcal {
namespace {

ResultAnswer answer_to_cause(const Diagnosis& diagnosis) {
  if (diagnosis.verdict.effect == kNone) return ResultAnswer::no_cause;
  return names_effect(diagnosis.verdict.effect) ? ResultAnswer::cause_named
                                                : ResultAnswer::cause_unknown;
}

}  // namespace

/// Of one diagnosis of the session.
struct Analyst::CauseFindings {
  CellTouches cell;
  Diagnosis diagnosis;
  std::optional<CorrectedModel> corrected;
  Solution unchanged;  ///< where there is a corrected model
};

std::optional<SessionRecord> Analyst::base() const {
  const std::int64_t own = c_.extended_state.stored ? collector_.session().record.id
                                                    : std::numeric_limits<std::int64_t>::max();
  return base_of_cause(c_.store, c_.models.hash(), c_.config_hash(), own);
}

bool Analyst::can_diagnose() const { return base().has_value(); }

void Analyst::diagnose(const std::string& why) {
  const auto lost = [&] {
    c_.put(Event::What::computed, false, "the full session that a cause is looked for in is gone");
  };
  const auto record = base();
  if (!record) return lost();
  const auto full = stored_session(*record);
  const auto decoding = read_decoding(record->config);
  if (!full || !decoding) return lost();
  const bool begun = c_.extended_state.stored;
  const Robot& active = *c_.models.active();
  data_ = std::make_shared<DataSet>(rows_of(active, *full, *decoding));
  if (begun) {
    if (!c_.stored(c_.store.set_state(collector_.session().record.id, SessionState::collected,
                                      c_.unix_ms())))
      return;
    const DataSet more =
        rows_of(active, collector_.session(), collector_.decoding(), Parts::all_fit);
    if (more.rows.rows() > 0) *data_ = merged(*data_, more);
  }
  const int made = begun ? static_cast<int>(collector_.session().plan.size()) : 0;
  DiagnosisOptions options;
  options.most_further = std::min(c_.config.causes.round, c_.config.causes.touches - made);
  auto found = std::make_shared<CauseFindings>();
  const auto seed = static_cast<unsigned long long>(record->id + 1 + made);
  computation_.start([found, robot = c_.models.active(), data = data_, config = c_.config,
                      before = full->plan, options, seed](const Computation::Tell& tell) mutable {
    if (options.most_further > 0) {
      found->cell = possible_touches(*robot, config, before, *data, seed, tell);
      if (!found->cell.touches.empty())
        options.possible = std::make_shared<PossibleRows>(found->cell.rows);
    }
    Diagnosis& diagnosis = found->diagnosis;
    diagnosis = selfcal::diagnose(robot, *data, options, tell);
    if (!diagnosis.problem.empty()) return diagnosis.problem;
    if (options.possible && !diagnosis.next.empty()) return std::string();
    found->corrected = corrected_model(*robot, *data, diagnosis, tell);
    if (!found->corrected) return std::string();
    Problems problems;
    const auto there = in_context(robot, *data, problems);
    if (!there) return problems.list.front();
    found->unchanged = judge_as_it_is(*there, *data, tell);
    return std::string();
  });
  when_computed_ = [this, found, why](const std::string& failure) {
    if (failure.empty()) return keep_findings(why, *found);
    c_.put(Event::What::computed, false, "diagnosing: " + failure);
  };
}

void Analyst::keep_findings(const std::string& why, CauseFindings& found) {
  const std::vector<NextStep>& next = found.diagnosis.next;
  if (!next.empty() && !next.front().chosen.empty()) return touch_more(why, found);
  if (!c_.extended_state.stored) {
    SessionRecord record = new_record(why);
    const auto id = c_.store.begin(record, {});
    if (!c_.stored(id)) return;
    record.id = *id;
    collector_.hold({record, {}, {}});
  }
  keep_result(result_of_cause(found), false);
}

void Analyst::touch_more(const std::string& why, const CauseFindings& found) {
  const NextStep& next = found.diagnosis.next.front();
  std::vector<PlannedTouch> touches, loaded;
  for (const int i : next.chosen) {
    const PlannedTouch& touch = found.cell.touches[static_cast<std::size_t>(i)];
    (touch.loaded ? loaded : touches).push_back(touch);
  }
  const TouchPlanOptions& plan = c_.config.plan;
  const Eigen::VectorXd xi = values(*c_.models.active());
  const Surroundings cell{*c_.models.active(), xi,         c_.config.obstacles, plan.apart,
                          plan.home,           plan.speed, plan.fence};
  TouchPlan ordered = in_short_order(cell, c_.config.sets, touches);
  TouchPlan with_payload = in_short_order(cell, c_.config.sets, loaded);
  tell_left_out(ordered);
  tell_left_out(with_payload);
  // Those with the payload after the others: a person comes twice at most.
  for (PlannedTouch& each : with_payload.touches) {
    each.via_home = each.via_home || ordered.touches.empty() || !ordered.touches.back().loaded;
    ordered.touches.push_back(std::move(each));
  }
  const std::vector<StepRecord> steps = steps_of(ordered, c_.config.sets);
  Session session =
      c_.extended_state.stored ? collector_.session() : Session{new_record(why), {}, {}};
  if (c_.extended_state.stored) {
    if (!c_.stored(c_.store.extend(session.record.id, steps))) return;
  } else {
    const auto id = c_.store.begin(session.record, steps);
    if (!c_.stored(id)) return;
    session.record.id = *id;
  }
  for (StepRecord step : steps) {
    step.index = static_cast<int>(session.plan.size());
    session.plan.push_back(std::move(step));
  }
  std::string names;
  for (const std::string& each : next.separates) names += (names.empty() ? "" : ", ") + each;
  c_.tell("info", "session " + std::to_string(session.record.id) + " (cause, " + why +
                      "): " + std::to_string(steps.size()) + " touches to tell apart " + names +
                      ": " + next.what);
  collector_.open(std::move(session));
}

ResultRecord Analyst::result_of_cause(const CauseFindings& found) const {
  const Diagnosis& diagnosis = found.diagnosis;
  ResultFigures figures;
  figures.p_value = diagnosis.p_value;
  figures.check_before = diagnosis.gap.rms_before;
  figures.check_after = diagnosis.gap.rms_after;
  figures.endpoint_sigma = std::nan("");
  figures.outliers = static_cast<std::uint32_t>(diagnosis.outliers.size());
  ResultRecord result = new_result(figures);
  result.answer = answer_to_cause(diagnosis);
  result.decision = ResultDecision::none;
  result.why = diagnosis.why;
  nlohmann::ordered_json json = to_json(diagnosis);
  if (const auto& corrected = found.corrected) {
    AcceptanceDecision decided = decide_on_result(c_.config.accept, *c_.models.active(),
                                                  corrected->solution, found.unchanged);
    decided.asks = decided.asks || !diagnosis.verdict.confounded_with.empty();
    result.identified = decided.identified;
    result.endpoint_sigma = decided.endpoint_sigma;
    result.why += "; corrected model: " + decided.why;
    if (decided.acceptable) {
      result.decision = decided.asks || !c_.config.accept.automatic ? ResultDecision::candidate
                                                                    : ResultDecision::applying;
      result.robot_text = corrected->robot_text;
    }
    json["corrected"] = to_json(corrected->solution, c_.config.robot->name(), c_.models.hash());
  }
  result.json = json.dump();
  return result;
}

}  // namespace selfcal
