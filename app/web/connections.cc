#include "app/web/connections.h"

#include <sys/socket.h>

#include <utility>

namespace selfcal {

Connections::Slot::Slot(Slot&& other) noexcept
    : connections_(std::exchange(other.connections_, nullptr)), entry_(other.entry_) {}

Connections::Slot::~Slot() {
  if (!connections_) return;
  const std::lock_guard lock(connections_->mutex_);
  connections_->entries_.erase(entry_);
}

void Connections::Slot::waits() {
  const std::lock_guard lock(connections_->mutex_);
  entry_->waiting = true;
  entry_->since = Clock::now();
}

void Connections::Slot::works() {
  const std::lock_guard lock(connections_->mutex_);
  entry_->waiting = false;
}

Connections::Slot Connections::enter(int socket) {
  const std::lock_guard lock(mutex_);
  return {*this, entries_.insert(entries_.end(), {socket, true, Clock::now()})};
}

bool Connections::push_one_out() {
  const std::lock_guard lock(mutex_);
  Slot::Entry* longest = nullptr;
  for (Slot::Entry& each : entries_)
    if (each.waiting && (!longest || each.since < longest->since)) longest = &each;
  if (!longest) return false;
  longest->waiting = false;  // once is enough
  ::shutdown(longest->socket, SHUT_RDWR);
  return true;
}

void Connections::cut_off() {
  const std::lock_guard lock(mutex_);
  for (const Slot::Entry& each : entries_) ::shutdown(each.socket, SHUT_RDWR);
}

}  // namespace selfcal
