// Status on every change, progress after every touch, the result.
#include "app/service/loop/reporter.h"
#include "app/service/session/session_rows.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace selfcal {
namespace {

/// What a diagnosis names, of its json; nothing of another one, or of one that is pruned.
void name_cause(const std::string& text, ResultMessage& message) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("gap")) return;
  const auto& verdict = json["verdict"];
  const auto& named = verdict["named"];
  if (named.empty()) return;
  message.cause = verdict["effect"];
  if (const auto& where = verdict["where"]; !where.empty())
    message.cause += "@" + where.front().get<std::string>();
  const auto number = [](const nlohmann::json& each) {
    return each.is_number() ? each.get<double>() : std::nan("");
  };
  message.cause_probability = number(verdict["probability"]);
  message.cause_closes = number(named.front()["closes_alone"]);
}

}  // namespace

Reporter::Reporter(ServiceContext& context, const Collector& collector, const Analyst& analyst,
                   std::string damaged)
    : c_(context), collector_(collector), analyst_(analyst), damaged_(std::move(damaged)) {}

StatusMessage Reporter::status() const {
  StatusMessage status;
  status.unix_ms = c_.unix_ms();
  status.robot = c_.config.id;
  status.model_hash = c_.models.hash();
  status.version = SELFCAL_VERSION;
  status.state = to_string(c_.extended_state.state);
  status.phase = to_string(c_.extended_state.phase);
  status.hardware = hardware_may(c_.extended_state.state, c_.extended_state.phase);
  status.why = c_.extended_state.why;
  status.session = c_.extended_state.session;
  status.kind = c_.extended_state.session > 0 ? to_string(c_.extended_state.kind) : "";
  status.active = c_.models.name();
  status.active_since_ms = c_.models.since_ms();
  status.candidate = c_.extended_state.candidate;
  status.next_due_ms = next_due(c_.config.schedule, c_.since(), status.unix_ms, utc_offset);
  status.temperature = collector_.front_end().celsius().value_or(std::nan(""));
  return status;
}

void Reporter::report() {
  // The phases of a touch change ten times a second; a subscriber needs the last, not each.
  const bool changed =
      c_.extended_state.state != told_.state || c_.extended_state.why != told_.why ||
      c_.extended_state.candidate != told_.candidate || c_.models.name() != told_active_;
  const bool second = c_.now - last_report_ >= kSecond;
  if (changed || second) {
    c_.messenger.publish(status());
    supervisor_.status(std::string(to_string(c_.extended_state.state)) + ": " +
                       c_.extended_state.why);
    told_ = c_.extended_state;
    told_active_ = c_.models.name();
  }
  if (const auto now = analyst_.progress(); now && now->stage != last_stage_)
    progress(nullptr, last_stage_ = now->stage);
  report_health(changed || second);
  if (second) last_report_ = c_.now;
}

void Reporter::progress(const TouchRecord* touch, const std::string& note) {
  ProgressMessage progress;
  progress.unix_ms = c_.unix_ms();
  progress.robot = c_.config.id;
  const bool begins =
      c_.extended_state.state == ServiceState::planning && !c_.extended_state.stored;
  if (begins) {  // what is planned has no number yet
    progress.kind = to_string(c_.extended_state.kind);
    progress.seconds_left = progress.residual = std::nan("");
    progress.note = note;
    return c_.messenger.publish(progress);
  }
  const Session& session = collector_.session();
  progress.session = session.record.id;
  progress.kind = session.record.kind;
  progress.planned = static_cast<std::uint32_t>(session.plan.size());
  progress.done = static_cast<std::uint32_t>(collector_.next());
  progress.outlier = static_cast<std::uint32_t>(
      steps_put_aside(session, collector_.repeats(), c_.config.limits.attempts));
  progress.seconds_left =
      collector_.seconds_each() * collector_.repeats() * (progress.planned - progress.done);
  progress.residual = std::nan("");
  progress.note = note;
  if (touch) {
    progress.set = session.plan[touch->step].set;
    progress.index = static_cast<std::uint32_t>(touch->step);
    progress.accepted = touch->outcome == TouchOutcome::taken;
    if (progress.accepted &&
        collector_.lock_of(touch->step) == 0) {  // of a lock there is no length
      const Session recent = lately(session, touch->step);
      const Robot& robot = *c_.models.active();
      const DataSet rows = rows_of(robot, recent, collector_.decoding(), Parts::all_fit);
      progress.residual = running_residual(robot, rows).value_or(std::nan(""));
    }
  }
  c_.messenger.publish(progress);
}

void Reporter::result(const ResultRecord& result) {
  ResultMessage message;
  message.unix_ms = result.unix_ms;
  message.robot = c_.config.id;
  message.model_hash = c_.models.hash();
  message.session = result.session;
  const auto session = c_.store.session(result.session);
  message.kind = session ? session->kind : "";
  message.answer = to_string(result.answer);
  message.decision = to_string(result.decision);
  message.why = result.why;
  static_cast<ResultFigures&>(message) = known_figures(result, result.answer);
  message.json = result.json;
  message.cause_probability = message.cause_closes = std::nan("");
  name_cause(result.json, message);
  c_.messenger.publish(message);
}

}  // namespace selfcal
