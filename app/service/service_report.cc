// What is told: status on every change, progress after every touch, events to the store and the
// log; and what is remembered over a restart.
#include <spdlog/spdlog.h>

#include <cmath>
#include <cstdio>

#include "app/service/service.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kTellAgain = 3600 * kSecond;  // the same sentence in the store
constexpr Nanoseconds kRemember = 60 * kSecond;     // between two savings of the hours of motion

}  // namespace

void Service::tell(const std::string& level, const std::string& text) {
  if (level == "error")
    spdlog::error("{}", text);
  else if (level == "warning")
    spdlog::warn("{}", text);
  else
    spdlog::info("{}", text);
  // A robot that is switched off must not fill the store with one sentence.
  if (text == last_told_ && now_ - last_told_at_ < kTellAgain) return;
  last_told_ = text;
  last_told_at_ = now_;
  journal_.add(EventRecord{0, ports_.clock->unix_ms(), level, text});
}

StatusMessage Service::status() const {
  StatusMessage status;
  status.unix_ms = ports_.clock->unix_ms();
  status.robot = config_.id;
  status.model_hash = models_.hash();
  status.version = SELFCAL_VERSION;
  status.state = to_string(situation_.state);
  status.phase = to_string(situation_.phase);
  status.hardware = hardware_may(situation_.state, situation_.phase);
  status.why = situation_.why;
  status.session = situation_.session;
  status.kind = situation_.session > 0 ? to_string(situation_.kind) : "";
  status.active = models_.name();
  status.active_since_ms = models_.since_ms();
  status.candidate = situation_.candidate;
  status.next_due_ms =
      next_due(config_.schedule, since_, status.unix_ms, utc_offset(status.unix_ms));
  status.temperature = senses_.celsius().value_or(std::nan(""));
  return status;
}

void Service::report() {
  // The phases of a touch change ten times a second; a subscriber needs the last, not each.
  const bool changed = situation_.state != told_.state || situation_.why != told_.why ||
                       situation_.candidate != told_.candidate || models_.name() != told_active_;
  const bool second = now_ - last_report_ >= kSecond;
  if (changed || second) {
    messenger_.publish(status());
    supervisor_.status(std::string(to_string(situation_.state)) + ": " + situation_.why);
    told_ = situation_;
    told_active_ = models_.name();
  }
  if (computation_.running()) {
    const Computation::Progress progress = computation_.progress();
    if (progress.stage != last_stage_) tell_progress(nullptr, last_stage_ = progress.stage);
  }
  report_health(changed || second);
  if (second) last_report_ = now_;
  // Writing may take long: not while the robot is to be stopped at a touch.
  const bool touching = situation_.state == ServiceState::collecting &&
                        (situation_.phase == Phase::touch || situation_.phase == Phase::settle);
  if (now_ - last_remembered_ >= kRemember && !touching) remember_use();
}

void Service::tell_progress(const TouchRecord* touch, const std::string& note) {
  ProgressMessage progress;
  progress.unix_ms = ports_.clock->unix_ms();
  progress.robot = config_.id;
  if (situation_.state == ServiceState::planning) {  // what is planned has no number yet
    progress.kind = to_string(situation_.kind);
    progress.seconds_left = progress.residual = std::nan("");
    progress.note = note;
    return messenger_.publish(progress);
  }
  progress.session = session_.record.id;
  progress.kind = session_.record.kind;
  progress.planned = static_cast<std::uint32_t>(session_.plan.size());
  const int next = next_step(session_, repeats(), config_.limits.attempts);
  progress.done = static_cast<std::uint32_t>(next);
  progress.outlier =
      static_cast<std::uint32_t>(steps_put_aside(session_, repeats(), config_.limits.attempts));
  const double each =
      touches_this_run_ > 0 ? seconds(now_ - collecting_since_) / touches_this_run_ : std::nan("");
  progress.seconds_left = each * repeats() * (progress.planned - progress.done);
  progress.residual = std::nan("");
  progress.note = note;
  if (touch) {
    progress.set = session_.plan[touch->step].set;
    progress.index = static_cast<std::uint32_t>(touch->step);
    progress.accepted = touch->outcome == TouchOutcome::taken;
    if (progress.accepted && lock_of(touch->step) == 0) {  // of a lock there is no length
      const Session recent = lately(session_, touch->step);
      progress.residual = running_residual(*models_.active(), rows_of(*models_.active(), recent,
                                                                      meaning_, Parts::all_fit))
                              .value_or(std::nan(""));
    }
  }
  messenger_.publish(progress);
}

void Service::remember_use() {
  last_remembered_ = now_;
  char line[160];
  std::snprintf(line, sizeof line, "%.6f %lld %.6f %.3f %d", motion_hours_,
                static_cast<long long>(since_.unix_ms), since_.motion_hours,
                since_.temperature.value_or(std::nan("")), since_.checks);
  stored(store_.remember("use", line));
}

void Service::remember_held() { stored(store_.remember("held", situation_.held ? "yes" : "")); }

void Service::recall_use() {
  // What cannot be read must not let the robot begin by itself.
  const auto held = store_.remembered("held");
  situation_.held = !held || *held == "yes";
  const auto line = store_.remembered("use");
  long long unix_ms = 0;
  double temperature = std::nan("");
  if (line && std::sscanf(line->c_str(), "%lf %lld %lf %lf %d", &motion_hours_, &unix_ms,
                          &since_.motion_hours, &temperature, &since_.checks) == 5) {
    since_.unix_ms = unix_ms;
    if (!std::isnan(temperature)) since_.temperature = temperature;
  }
  const auto results = store_.results(1);
  if (!results || results->empty()) return;
  const auto last = store_.result(results->front().session);
  if (stored(last) && *last) publish(**last);
}

}  // namespace selfcal
