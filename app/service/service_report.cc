// What is told: status on every change, progress after every touch, health once a second and at
// once when something gets worse, events to the store and the log.
#include <spdlog/spdlog.h>

#include <cmath>
#include <cstdio>
#include <ctime>

#include "app/service/service.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kHealth = kSecond / 5;        // between two looks at what may have degraded
constexpr Nanoseconds kTellAgain = 3600 * kSecond;  // the same sentence in the store
constexpr Nanoseconds kRemember = 60 * kSecond;     // between two savings of the hours of motion

std::string text(double value, const char* format = "%.4g") {
  char out[32];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

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
  // An event that cannot be stored must not become an event itself.
  if (const auto kept = store_.add(EventRecord{0, ports_.clock->unix_ms(), level, text}); !kept)
    spdlog::error("{}", kept.error().what);
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
  const std::time_t t = status.unix_ms / 1000;
  std::tm local{};
  localtime_r(&t, &local);
  status.next_due_ms =
      next_due(config_.schedule, since_, status.unix_ms, static_cast<int>(local.tm_gmtoff));
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
  if (now_ - last_remembered_ >= kRemember) remember_use();
}

void Service::report_health(bool in_any_case) {
  if (!in_any_case && now_ - last_health_ < kHealth) return;
  last_health_ = now_;
  const std::vector<HealthMessage> lines = health();
  std::string levels;
  for (const HealthMessage& line : lines) levels += std::to_string(static_cast<int>(line.level));
  if (in_any_case || levels != last_levels_) messenger_.publish(lines, config_.serial);
  last_levels_ = levels;
}

void Service::tell_progress(const TouchRecord* touch, const std::string& note) {
  const int repeats = session_.kind() == SessionKind::check ? std::max(2, config_.touch.repeats)
                                                            : config_.touch.repeats;
  ProgressMessage progress;
  progress.unix_ms = ports_.clock->unix_ms();
  progress.robot = config_.id;
  progress.session = session_.record.id;
  progress.kind = session_.record.kind;
  progress.planned = static_cast<std::uint32_t>(session_.plan.size());
  const int next = next_step(session_, repeats, config_.limits.attempts);
  progress.done = static_cast<std::uint32_t>(next);
  progress.put_aside =
      static_cast<std::uint32_t>(steps_put_aside(session_, repeats, config_.limits.attempts));
  const double each =
      touches_this_run_ > 0 ? seconds(now_ - collecting_since_) / touches_this_run_ : std::nan("");
  progress.seconds_left = each * repeats * (progress.planned - progress.done);
  progress.residual = std::nan("");
  progress.note = note;
  if (touch) {
    progress.set = session_.plan[touch->step].set;
    progress.index = static_cast<std::uint32_t>(touch->step);
    progress.accepted = touch->outcome == TouchOutcome::taken;
    if (progress.accepted) {
      Session so_far = session_;
      so_far.plan.resize(touch->step + 1);
      progress.residual =
          running_residual(*models_.active(), rows_of(so_far, meaning_, Parts::all_fit))
              .value_or(std::nan(""));
    }
  }
  messenger_.publish(progress);
}

std::vector<HealthMessage> Service::health() const {
  std::vector<HealthMessage> lines;
  const auto add = [&](const std::string& name, Health level, const std::string& message,
                       std::vector<std::pair<std::string, std::string>> values = {}) {
    lines.push_back({"selfcal: " + name, level, message, std::move(values)});
  };
  const bool fault = situation_.state == ServiceState::fault;
  add("service",
      fault                   ? Health::error
      : situation_.unfinished ? Health::warn
                              : Health::ok,
      std::string(to_string(situation_.state)) + ": " + situation_.why,
      {{"hardware", std::string(hardware_may(situation_.state, situation_.phase))},
       {"session", std::to_string(situation_.session)}});
  const bool alive = senses_.encoders_alive(now_);
  add("encoders", alive ? Health::ok : Health::error, alive ? "readings come in" : "silent",
      {{"rate_hz", text(senses_.rate())},
       {"dropped", std::to_string(senses_.samples_dropped())},
       {"out_of_order", std::to_string(senses_.samples().out_of_order())}});
  const auto closed = senses_.closed();
  const bool contact = situation_.state == ServiceState::collecting || situation_.unfinished;
  add("trigger",
      !closed               ? Health::error
      : *closed && !contact ? Health::warn
                            : Health::ok,
      !closed   ? "level unknown"
      : *closed ? "closed"
                : "open",
      {{"glitches", std::to_string(senses_.glitches())},
       {"dropped", std::to_string(senses_.edges_dropped())}});
  const auto bytes = store_.bytes();
  add("store", !bytes || !damaged_.empty() ? Health::error : Health::ok,
      !bytes             ? bytes.error().what
      : damaged_.empty() ? "sound"
                         : damaged_,
      {{"size_mb", text(bytes ? static_cast<double>(*bytes) / 1e6 : 0)},
       {"limit_mb", text(static_cast<double>(config_.store_bytes) / 1e6)}});
  const bool unexplained = last_check_ && !last_check_->explained;
  const bool wrong = !models_.refused().empty();
  std::string message = models_.name() + " is active";
  if (wrong) message = models_.refused();
  if (situation_.candidate) message += "; a result waits: accept or reject";
  if (unexplained) message += "; the last check was not explained";
  add("calibration",
      wrong                                                           ? Health::error
      : unexplained || situation_.candidate || models_.session() == 0 ? Health::warn
                                                                      : Health::ok,
      message,
      {{"age_h",
        text(models_.since_ms() == 0
                 ? 0
                 : static_cast<double>(ports_.clock->unix_ms() - models_.since_ms()) / 3.6e6)},
       {"check_p", last_check_ ? text(last_check_->p_value) : "none yet"},
       {"check_rms_mm", last_check_ ? text(1e3 * last_check_->rms) : "none yet"},
       {"motion_h", text(motion_hours_)},
       {"temperature_c", text(senses_.celsius().value_or(std::nan("")))}});
  return lines;
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
  if (const auto held = store_.remembered("held")) situation_.held = *held == "yes";
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
