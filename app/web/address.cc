#include "app/web/address.h"

#include <arpa/inet.h>

#include <array>
#include <charconv>

namespace selfcal {
namespace {

constexpr int kMostPort = 65535;

bool is_loopback(const std::string& host) {
  in_addr v4{};
  if (::inet_pton(AF_INET, host.c_str(), &v4) == 1) return (ntohl(v4.s_addr) >> 24U) == 127;
  in6_addr v6{};
  return ::inet_pton(AF_INET6, host.c_str(), &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6);
}

}  // namespace

bool is_numeric_host(const std::string& host) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  return ::inet_pton(AF_INET, host.c_str(), bytes.data()) == 1 ||
         ::inet_pton(AF_INET6, host.c_str(), bytes.data()) == 1;
}

std::string WebAddress::url() const {
  const bool v6 = host.find(':') != std::string::npos;
  return "http://" + (v6 ? "[" + host + "]" : host) + ":" + std::to_string(port) + "/";
}

Result<WebAddress> parse_web_address(const std::string& text) {
  const auto wrong = [&] {
    return tl::unexpected<Failure>(
        {kMisused,
         "--web: expected ADDRESS:PORT with a number for each, like 127.0.0.1:8080 or [::1]:8080, "
         "got '" +
             text + "'"});
  };
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return wrong();
  WebAddress address;
  address.host = text.substr(0, colon);
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + colon + 1, end, address.port);
  if (read.ec != std::errc() || read.ptr != end || address.port < 0 || address.port > kMostPort)
    return wrong();
  if (address.host == "localhost") address.host = "127.0.0.1";
  const bool bracketed =
      address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']';
  if (bracketed) address.host = address.host.substr(1, address.host.size() - 2);
  if (!is_numeric_host(address.host) || bracketed != (address.host.find(':') != std::string::npos))
    return wrong();
  address.loopback = is_loopback(address.host);
  return address;
}

}  // namespace selfcal
