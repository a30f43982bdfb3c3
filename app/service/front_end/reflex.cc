#include "app/service/front_end/reflex.h"

#include <algorithm>
#include <utility>

#include "io/urgency.h"
#include "io/wakeup.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kLook = 20 * kMillisecond;  // at the level, when no edge comes

const char* why_stopped(bool closed) { return closed ? "touched" : "the lock opened"; }

}  // namespace

Reflex::Reflex(const Ports& ports, Nanoseconds debounce)
    : ports_(ports), debouncer_(debounce), quiet_(debounce) {
  if (!ports_.trigger_clock) return;
  looked_ = ports_.trigger_clock->now();
  thread_ = std::thread([this] { watch(); });
}

Reflex::~Reflex() {
  ending_ = true;
  if (thread_.joinable()) thread_.join();  // within kLook
}

Result<void> Reflex::request(const MotionRequest& request, std::optional<bool> until) {
  const std::lock_guard lock(motion_);
  const bool there = until && held_ == until;
  guarded_ = until && !there ? request.id : 0;
  until_ = until.value_or(true);
  if (there) stopped_ = request.id;
  const auto sent = ports_.motion->request(request);
  return sent && there ? ports_.motion->stop(why_stopped(*until)) : sent;
}

Result<void> Reflex::stop(const std::string& why) {
  const std::lock_guard lock(motion_);
  return ports_.motion->stop(why);
}

void Reflex::unguard() {
  const std::lock_guard lock(motion_);
  guarded_ = 0;
}

void Reflex::watch() {
  become_urgent();
  while (!ending_) {
    const Nanoseconds now = ports_.trigger_clock->now();
    looked_ = now;
    look(now);
    ports_.trigger_clock->wait(debouncer_.settles_in(now).value_or(kLook));
  }
}

void Reflex::look(Nanoseconds now) {
  listen(now);
  settle(now);
  tell();
}

void Reflex::listen(Nanoseconds now) {
  edges_.clear();
  // Before the edges are taken: one that comes between the two must not look like a lost one.
  const std::optional<bool> closed = ports_.trigger->closed();
  if (const auto taken = ports_.trigger->take(edges_); !taken) broken_ = taken.error().what;
  known_ = closed.has_value();
  if (!level_) {
    if (!closed) return;
    debouncer_.begin(*closed);
    level_ = closed;
    settled_ = Edge{now, *closed, false};
    const std::lock_guard lock(motion_);
    held_ = closed;
    return;
  }
  for (const Edge& edge : edges_) debouncer_.add(edge, now);
  // An edge that was lost on the way shows in the level; a trigger that is gone shows in nothing.
  if (closed && edges_.empty()) debouncer_.reconcile(*closed, now);
}

void Reflex::settle(Nanoseconds now) {
  const std::optional<Edge> edge = debouncer_.settled(now);
  if (!edge) return;
  level_ = edge->closed;
  settled_ = edge;
  guard(*edge);
}

void Reflex::guard(const Edge& edge) {
  {
    const std::lock_guard lock(motion_);
    held_ = edge.closed;
    if (guarded_ == 0 || edge.closed != until_) return;
    stopped_ = std::exchange(guarded_, 0);
    if (const auto sent = ports_.motion->stop(why_stopped(edge.closed)); !sent)
      broken_ = sent.error().what;
  }
  if (!ports_.trigger_clock || !edge.timed) return;
  const Nanoseconds took = ports_.trigger_clock->now() - edge.time - quiet_;
  slowest_ = std::max<Nanoseconds>(slowest_, took);
}

void Reflex::tell() {
  const Nanoseconds now = looked_;
  // What the port says of itself, before anybody may have to wait for it.
  std::string trouble = ports_.trigger->trouble();
  const std::lock_guard lock(news_mutex_);
  if (settled_) {
    if (ports_.wakeup) ports_.wakeup->notify();
    if (news_.settled.size() < kMostSettled) news_.settled.push_back(*settled_);
    settled_.reset();
  }
  news_.level = level_;
  news_.known = known_;
  news_.chatters = debouncer_.chatters(now);
  news_.senders = ports_.trigger->senders();
  news_.glitches = debouncer_.glitches();
  news_.dropped = ports_.trigger->dropped();
  news_.strange = ports_.trigger->strange();
  news_.trouble = std::move(trouble);
  if (!broken_.empty()) news_.broken = std::exchange(broken_, {});
}

TriggerNews Reflex::take(Nanoseconds now) {
  if (!thread_.joinable()) {
    looked_ = now;
    look(now);
  }
  const std::lock_guard lock(news_mutex_);
  TriggerNews news = news_;
  news_.settled.clear();
  news_.broken.clear();
  return news;
}

}  // namespace selfcal
