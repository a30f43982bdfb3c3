// A network that is gone for a while: loaded before a process (LD_PRELOAD), it loses every datagram
// that the process sends or is sent over IP for as long as the file BAD_NETWORK is there. Both ends
// live on and hear nothing of each other.
#include <dlfcn.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <unistd.h>

#include <cstdlib>

namespace {

bool gone(int socket) {
  const char* file = std::getenv("BAD_NETWORK");
  if (file == nullptr || access(file, F_OK) != 0) return false;
  int domain = 0;
  socklen_t size = sizeof domain;
  return getsockopt(socket, SOL_SOCKET, SO_DOMAIN, &domain, &size) == 0 &&
         (domain == AF_INET || domain == AF_INET6);
}

size_t bytes_of(const msghdr& message) {
  size_t bytes = 0;
  for (size_t i = 0; i < message.msg_iovlen; ++i) bytes += message.msg_iov[i].iov_len;
  return bytes;
}

}  // namespace

extern "C" {

ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  using Send = ssize_t (*)(int, const msghdr*, int);
  static const auto real = reinterpret_cast<Send>(dlsym(RTLD_NEXT, "sendmsg"));
  if (gone(socket)) return static_cast<ssize_t>(bytes_of(*message));
  return real(socket, message, flags);
}

ssize_t recvmsg(int socket, msghdr* message, int flags) {
  using Receive = ssize_t (*)(int, msghdr*, int);
  static const auto real = reinterpret_cast<Receive>(dlsym(RTLD_NEXT, "recvmsg"));
  const ssize_t got = real(socket, message, flags);
  // An empty datagram, which is none of the protocol's: who waits for another one here would not
  // look at the other sockets.
  return got > 0 && gone(socket) ? 0 : got;
}

}  // extern "C"
