// Who may ask what of the page's server. No socket here: what a request says, and the answer.
//
// A page of another site that is open in the same browser must neither read nor command:
//   - its requests carry its Origin, which is not ours;
//   - a name of its own that leads to our address (DNS rebinding) stands in Host, where we take
//     numbers, localhost and this computer's name;
//   - commands carry a header that a browser sends across sites only where the server has agreed
//     to it (CORS), and this one never does.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace selfcal {

inline constexpr const char* kPagePath = "/";
inline constexpr const char* kStatePath = "/state";      ///< GET
inline constexpr const char* kCommandPath = "/command";  ///< POST
inline constexpr const char* kCommandHeader = "X-Selfcal-Command";
inline constexpr std::size_t kMostTarget = 512;  ///< bytes of path and query

struct GateRules {
  bool commands = false;                ///< whether any is taken
  std::string token = {};               ///< demanded for state and commands; empty: none is
  std::vector<std::string> names = {};  ///< of this computer, beside numbers and localhost
};

/// What of a request decides; empty where it has no such header.
struct RequestHead {
  std::string method = {}, path = {};
  std::size_t target_bytes = 0;
  std::string host = {}, origin = {}, site = {};  ///< Host, Origin, Sec-Fetch-Site
  std::string authorization = {};                 ///< "Bearer TOKEN"
  std::string command = {};                       ///< kCommandHeader
};

struct Refusal {
  int status = 403;
  std::string why;
};

/// Nothing for a request that may pass.
std::optional<Refusal> refused(const RequestHead& head, const GateRules& rules);

/// The host of a Host header, without port and brackets, in lower case.
std::string host_of(const std::string& header);

}  // namespace selfcal
