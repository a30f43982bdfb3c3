#include "app/web/gate.h"

#include <algorithm>

#include "app/web/address.h"
#include "app/web/token.h"

namespace selfcal {
namespace {

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

bool names_us(const std::string& host, const GateRules& rules) {
  return host == "localhost" || is_numeric_host(host) ||
         std::ranges::find(rules.names, host) != rules.names.end();
}

/// Behind a proxy that speaks TLS the page's own origin is https.
bool is_own_origin(const std::string& origin, const std::string& host) {
  const std::string own = lower_case(origin);
  return own == "http://" + lower_case(host) || own == "https://" + lower_case(host);
}

std::optional<Refusal> wrong_target(const RequestHead& head) {
  if (head.target_bytes > kMostTarget) return Refusal{414, "the address is too long"};
  const bool get = head.method == "GET" || head.method == "HEAD";
  if (head.path == kPagePath || head.path == kStatePath)
    return get ? std::nullopt : std::optional(Refusal{405, "only GET"});
  if (head.path == kCommandPath)
    return head.method == "POST" ? std::nullopt : std::optional(Refusal{405, "only POST"});
  return Refusal{404, "there is nothing of this name"};
}

std::optional<Refusal> wrong_sender(const RequestHead& head, const GateRules& rules) {
  if (!names_us(host_of(head.host), rules))
    return Refusal{421, "this is not the computer that Host names"};
  if (!head.origin.empty() && !is_own_origin(head.origin, head.host))
    return Refusal{403, "a page of another site may not ask"};
  const bool own_site = head.site.empty() || head.site == "same-origin" || head.site == "none";
  if (!own_site && head.path != kPagePath)  // a link to the page may stand anywhere
    return Refusal{403, "a page of another site may not ask"};
  return std::nullopt;
}

bool has_token(const std::string& authorization, const std::string& token) {
  constexpr std::string_view kBearer = "Bearer ";
  return authorization.starts_with(kBearer) &&
         same_token(std::string_view(authorization).substr(kBearer.size()), token);
}

}  // namespace

std::string host_of(const std::string& header) {
  if (header.starts_with('[')) {
    const std::size_t end = header.find(']');
    return end == std::string::npos ? std::string() : lower_case(header.substr(1, end - 1));
  }
  return lower_case(header.substr(0, header.find(':')));
}

std::optional<Refusal> refused(const RequestHead& head, const GateRules& rules) {
  if (auto wrong = wrong_target(head)) return wrong;
  if (auto wrong = wrong_sender(head, rules)) return wrong;
  if (head.path == kPagePath) return std::nullopt;  // holds nothing of any robot
  if (!rules.token.empty() && !has_token(head.authorization, rules.token))
    return Refusal{401, "the token is missing or wrong"};
  if (head.path != kCommandPath) return std::nullopt;
  if (!rules.commands) return Refusal{403, "commands are off: started without --allow-commands"};
  if (head.command.empty())
    return Refusal{403, std::string("a command needs the header ") + kCommandHeader};
  return std::nullopt;
}

}  // namespace selfcal
