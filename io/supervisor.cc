#include "io/supervisor.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <string>

namespace selfcal {

Supervisor::Supervisor() {
  const char* path = std::getenv("NOTIFY_SOCKET");
  sockaddr_un address{};
  if (!path || (path[0] != '/' && path[0] != '@') || std::strlen(path) >= sizeof address.sun_path)
    return;
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path, sizeof address.sun_path - 1);
  if (path[0] == '@') address.sun_path[0] = '\0';  // the abstract namespace
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + std::strlen(path));
  socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ >= 0 &&
      ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), length) != 0) {
    ::close(socket_);
    socket_ = -1;
  }
  if (const char* period = std::getenv("WATCHDOG_USEC"))
    period_ = std::strtoll(period, nullptr, 10) * 1000;
}

Supervisor::~Supervisor() {
  if (socket_ >= 0) ::close(socket_);
}

void Supervisor::send(std::string_view text) const {
  if (socket_ >= 0) (void)!::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
}

void Supervisor::ready() { send("READY=1"); }
void Supervisor::stopping() { send("STOPPING=1"); }
void Supervisor::status(std::string_view words) { send("STATUS=" + std::string(words)); }

void Supervisor::alive(Nanoseconds now) {
  if (period_ <= 0 || now - last_ < period_ / 2) return;
  last_ = now;
  send("WATCHDOG=1");
}

}  // namespace selfcal
