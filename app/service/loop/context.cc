#include "app/service/loop/context.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/service/session/decoding.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostEvents = 1024;
constexpr Nanoseconds kTellAgain = 3600 * kSecond;  // the same sentence in the store
constexpr Nanoseconds kSayAgain = 60 * kSecond;     // of a store that fails, in the log
constexpr std::size_t kToldApart = 8;               // sentences that may take turns

void log_at(const std::string& level, const std::string& text) {
  if (level == "error")
    spdlog::error("{}", text);
  else if (level == "warning")
    spdlog::warn("{}", text);
  else
    spdlog::info("{}", text);
}

}  // namespace

void ServiceContext::put(Event event) {
  event.now = now;
  if (events.size() < kMostEvents) return events.push_back(std::move(event));
  ++lost_events;
  if (events.size() > kMostEvents) return;
  // What the transition knows is not what has happened any more.
  Event lost;
  lost.what = Event::What::broken;
  lost.now = now;
  lost.why = "more than " + std::to_string(kMostEvents) + " events at once: the others are lost";
  events.push_back(std::move(lost));
}

void ServiceContext::put(Event::What what, bool ok, std::string why) {
  Event event;
  event.what = what;
  event.ok = ok;
  event.why = std::move(why);
  put(std::move(event));
}

bool ServiceContext::told_lately(std::deque<Told>& list, const std::string& text,
                                 Nanoseconds within) const {
  if (const auto again = std::ranges::find(list, text, &Told::text); again != list.end()) {
    if (now - again->at < within) return true;
    list.erase(again);
  }
  if (list.size() == kToldApart) list.pop_back();
  list.push_front({text, now});
  return false;
}

bool ServiceContext::store_failed(const Failure& failure) {
  if (!told_lately(store_told, failure.what, kSayAgain)) spdlog::error("{}", failure.what);
  put(Event::What::broken, false, std::string(kStoreFailed) + failure.what);
  return false;
}

void ServiceContext::record(const std::string& level, const std::string& text) {
  log_at(level, text);
  journal.add(EventRecord{0, unix_ms(), level, text});
}

void ServiceContext::tell(const std::string& level, const std::string& text) {
  // A robot that is switched off must not fill the store with a few sentences.
  if (told_lately(told, text, kTellAgain)) return log_at(level, text);
  record(level, text);
}

bool ServiceContext::can_compare() const {
  if (models.session() == 0) return false;
  const auto base = store.session(models.session());
  return base && base->config_hash == config_hash() && base->model_hash == models.hash();
}

std::string ServiceContext::config_hash() const {
  return selfcal::config_hash(config, ports.encoders->scales());
}

Since ServiceContext::since() const {
  Since since;
  since.unix_ms = use.calendar.last_session_ms();
  since.motion_hours = use.motion_hours - use.motion_hours_then;
  since.temperature = use.temperature_then;
  since.checks = use.checks;
  since.dated = use.calendar.believed();
  since.set_to_ms = use.calendar.set_to_ms();
  return since;
}

void ServiceContext::remember_use() {
  char line[192];
  std::snprintf(line, sizeof line, "%.6f %lld %.6f %.3f %d %lld", use.motion_hours,
                static_cast<long long>(use.calendar.last_session_to_keep_ms()),
                use.motion_hours_then, use.temperature_then.value_or(std::nan("")), use.checks,
                static_cast<long long>(use.calendar.latest_ms()));
  stored(store.remember("use", line));
}

void ServiceContext::prune() {
  if (const auto pruned = store.prune(config.store_bytes); !pruned)
    tell("warning", "the store is not kept within its bound: " + pruned.error().what);
}

}  // namespace selfcal
