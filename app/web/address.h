// Where the live page is served.
#pragma once

#include <string>

#include "io/result.h"

namespace selfcal {

inline constexpr int kMisused = 2;  ///< exit status: wrong usage

struct WebAddress {
  std::string host;       ///< numeric: "127.0.0.1", "::1"
  int port = 0;           ///< 0: any that is free
  bool loopback = false;  ///< only programs on this computer reach it

  /// "http://127.0.0.1:8080/"
  std::string url() const;
};

/// "127.0.0.1:8080", "[::1]:8080" or "localhost:8080"; names other than localhost are refused, as
/// what they lead to may change. Fails with kMisused.
Result<WebAddress> parse_web_address(const std::string& text);

/// Whether `host` is a number, of IPv4 or, without brackets, of IPv6.
bool is_numeric_host(const std::string& host);

}  // namespace selfcal
