// Raw CAN sockets: Documentation/networking/can.rst of the kernel.

#include "io/can/socket.h"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include "io/clock.h"

namespace selfcal {
namespace {

tl::unexpected<Failure> can_failed(const std::string& interface, const std::string& what,
                                   int error) {
  return device_failed("CAN interface " + interface + ": " + what + ": " + std::strerror(error));
}

template <class T>
bool set_option(const Descriptor& socket, int level, int option, const T& value) {
  return ::setsockopt(socket.handle(), level, option, &value, sizeof value) == 0;
}

ifreq request_for(const std::string& interface) {
  ifreq request{};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  return request;
}

// A raw socket that is bound to nothing yet, with FD frames where the interface has them; an error
// where it has none and they are asked for.
Result<Descriptor> make_socket(const std::string& interface, bool fd) {
  Descriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW));
  if (!socket.open()) return can_failed(interface, "no CAN sockets in this kernel", errno);
  ifreq request = request_for(interface);
  if (::ioctl(socket.handle(), SIOCGIFMTU, &request) != 0)
    return can_failed(interface, "cannot be opened", errno);
  const bool carries_fd = request.ifr_mtu >= static_cast<int>(CANFD_MTU);
  if (fd && !carries_fd)
    return device_failed("CAN interface " + interface + " carries no FD frames");
  // Also where none are meant: one with a joint's id is to be told, not to be missed.
  if (carries_fd && !set_option(socket, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, 1))
    return can_failed(interface, "FD frames", errno);
  return socket;
}

Result<void> bind_to(const Descriptor& socket, const std::string& interface) {
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
  // Index 0 would bind to all interfaces.
  if (address.can_ifindex == 0) return can_failed(interface, "cannot be opened", errno);
  if (::bind(socket.handle(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return can_failed(interface, "cannot be opened", errno);
  return {};
}

bool set_filters(const Descriptor& socket, const CanReceiverOptions& options) {
  std::vector<can_filter> filters;
  for (const CanId& id : options.ids)
    filters.push_back(
        {.can_id = id.value | (id.extended ? CAN_EFF_FLAG : 0),
         .can_mask = (id.extended ? CAN_EFF_MASK : CAN_SFF_MASK) | CAN_EFF_FLAG | CAN_RTR_FLAG});
  const can_err_mask_t errors = options.errors ? CAN_ERR_MASK : 0;
  return ::setsockopt(socket.handle(), SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                      static_cast<socklen_t>(filters.size() * sizeof(can_filter))) == 0 &&
         set_option(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors);
}

CanFrame frame_of(const canfd_frame& kernel, std::size_t size) {
  CanFrame frame;
  frame.error = (kernel.can_id & CAN_ERR_FLAG) != 0;
  frame.id.extended = !frame.error && (kernel.can_id & CAN_EFF_FLAG) != 0;
  frame.id.value = kernel.can_id & (frame.error         ? CAN_ERR_MASK
                                    : frame.id.extended ? CAN_EFF_MASK
                                                        : CAN_SFF_MASK);
  frame.fd = size == CANFD_MTU;
  frame.size = std::min<std::uint8_t>(kernel.len, frame.fd ? CANFD_MAX_DLEN : CAN_MAX_DLEN);
  std::copy_n(kernel.data, frame.size, frame.data.begin());
  return frame;
}

/// Room for one frame and what the kernel says of it.
struct Room {
  canfd_frame frame{};
  alignas(cmsghdr)
      std::array<char, CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t))> control{};
  iovec vector{};
};

// The stamp, and the frames dropped since the opening where the kernel says so.
std::optional<std::uint32_t> read_control(msghdr& header, CanFrame& frame) {
  std::optional<std::uint32_t> dropped;
  for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SCM_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
      frame.stamp = stamp.tv_sec * kSecond + stamp.tv_nsec;
    } else if (c->cmsg_type == SO_RXQ_OVFL) {
      dropped.emplace();
      std::memcpy(&*dropped, CMSG_DATA(c), sizeof *dropped);
    }
  }
  return dropped;
}

}  // namespace

Result<CanReceiver> CanReceiver::open(const CanReceiverOptions& options) {
  auto socket = make_socket(options.interface, options.fd);
  if (!socket) return tl::unexpected(socket.error());
  // Filters first: nothing else may come in between.
  if (!set_filters(*socket, options) || !set_option(*socket, SOL_SOCKET, SO_TIMESTAMPNS, 1) ||
      !set_option(*socket, SOL_SOCKET, SO_RXQ_OVFL, 1) ||
      !set_option(*socket, SOL_SOCKET, SO_RCVBUF, options.receive_buffer))
    return can_failed(options.interface, "cannot be set up", errno);
  if (auto bound = bind_to(*socket, options.interface); !bound)
    return tl::unexpected(bound.error());
  return CanReceiver(*std::move(socket), options.interface);
}

Result<CanRead> CanReceiver::read(std::vector<CanFrame>& out) {
  std::array<Room, kMost> rooms;
  std::array<mmsghdr, kMost> messages{};
  for (std::size_t i = 0; i < kMost; ++i) {
    rooms[i].vector = {.iov_base = &rooms[i].frame, .iov_len = sizeof(canfd_frame)};
    msghdr& header = messages[i].msg_hdr;
    header.msg_iov = &rooms[i].vector;
    header.msg_iovlen = 1;
    header.msg_control = rooms[i].control.data();
    header.msg_controllen = rooms[i].control.size();
  }
  const Nanoseconds called = stamped_ ? 0 : realtime_now();
  const int count = ::recvmmsg(socket_.handle(), messages.data(), kMost, MSG_DONTWAIT, nullptr);
  if (count < 0) {
    if (errno == EAGAIN || errno == EINTR) return CanRead::drained;
    if (errno == ENETDOWN) return CanRead::down;
    if (errno == ENODEV || errno == ENXIO) return CanRead::gone;
    return can_failed(interface_, "cannot be read", errno);
  }
  for (int i = 0; i < count; ++i) {
    CanFrame frame = frame_of(rooms[i].frame, messages[i].msg_len);
    if (const auto dropped = read_control(messages[i].msg_hdr, frame)) {
      frame.lost = *dropped - dropped_;  // the kernel's count begins anew after 2^32 as ours does
      dropped_ = *dropped;
    }
    // The kernel begins to stamp frames some time after a first socket asks for it
    // (net_enable_timestamp); those that came in before get the time of their reading, and only
    // such stamps are later than the call that reads them.
    stamped_ = stamped_ || (frame.stamp != 0 && frame.stamp < called);
    if (stamped_ || frame.error) out.push_back(frame);
  }
  return count < static_cast<int>(kMost) ? CanRead::drained : CanRead::more;
}

bool CanReceiver::interface_up() const {
  ifreq request = request_for(interface_);
  return ::ioctl(socket_.handle(), SIOCGIFFLAGS, &request) == 0 &&
         (request.ifr_flags & IFF_UP) != 0;
}

Result<CanSender> CanSender::open(const std::string& interface, bool fd) {
  auto socket = make_socket(interface, fd);
  if (!socket) return tl::unexpected(socket.error());
  // No filter lets nothing in, which else would fill a queue that nobody reads.
  if (::setsockopt(socket->handle(), SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0) != 0)
    return can_failed(interface, "cannot be set up", errno);
  if (auto bound = bind_to(*socket, interface); !bound) return tl::unexpected(bound.error());
  return CanSender(*std::move(socket), interface);
}

Result<void> CanSender::send(const CanFrame& frame) {
  canfd_frame kernel{};
  kernel.can_id =
      frame.id.value | (frame.id.extended ? CAN_EFF_FLAG : 0) | (frame.error ? CAN_ERR_FLAG : 0);
  kernel.len = frame.size;
  std::copy_n(frame.data.begin(), frame.size, kernel.data);
  const std::size_t size = frame.fd ? CANFD_MTU : CAN_MTU;
  if (::send(socket_.handle(), &kernel, size, MSG_DONTWAIT) == static_cast<ssize_t>(size))
    return {};
  return can_failed(interface_, "frame " + to_string(frame.id) + " not sent", errno);
}

}  // namespace selfcal
