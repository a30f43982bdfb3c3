// Who can reach a DDS participant of this process. What DDS Security asks of a configuration and of
// a governance document: OMG DDS Security 1.1, 9.4.1.2.
#include "io/dds/reach.h"

#include <dds/ddsrt/environ.h>
#include <dds/ddsrt/heap.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <regex>
#include <utility>
#include <vector>

#include "io/files/file.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostConfigurationBytes = std::size_t{1} << 20;

bool loops_back(const std::string& interface) {
  return interface == "lo" || interface == "::1" || interface.starts_with("127.");
}

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string without_blanks(std::string_view text) {
  constexpr const char* kBlanks = " \t\r\n";
  const std::size_t from = text.find_first_not_of(kBlanks);
  if (from == std::string_view::npos) return {};
  return std::string(text.substr(from, text.find_last_not_of(kBlanks) - from + 1));
}

std::string without_comments(std::string text) {
  for (std::size_t at = 0; (at = text.find("<!--", at)) != std::string::npos;) {
    const std::size_t end = text.find("-->", at);
    text.erase(at, end == std::string::npos ? end : end + 3 - at);
  }
  return text;
}

struct XmlElement {
  std::string attributes, content;
};

/// Where the element `name` that is open at `from` is closed; the end of the text when nowhere.
std::size_t closing(const std::string& lower, const std::string& name, std::size_t from) {
  for (std::size_t at = from; (at = lower.find("</" + name, at)) != std::string::npos;) {
    at += 2 + name.size();
    if (at < lower.size() && std::string_view(" \t\r\n>").find(lower[at]) != std::string_view::npos)
      return at - 2 - name.size();
  }
  return lower.size();
}

/// Every element called `name` (in lower case; the case of the text does not matter), but those
/// within another of that name.
std::vector<XmlElement> elements(std::string_view text, const std::string& name) {
  const std::string lower = in_lower_case(text);
  std::vector<XmlElement> all;
  for (std::size_t at = 0; (at = lower.find("<" + name, at)) != std::string::npos;) {
    const std::size_t attributes = at + 1 + name.size();
    const std::size_t close = lower.find('>', at = attributes);
    if (close == std::string::npos) break;
    if (std::string_view(" \t\r\n/>").find(lower[attributes]) == std::string_view::npos) continue;
    XmlElement element{std::string(text.substr(attributes, close - attributes)), {}};
    if (element.attributes.ends_with('/')) {
      element.attributes.pop_back();
    } else {
      at = closing(lower, name, close);
      element.content = text.substr(close + 1, at - close - 1);
    }
    all.push_back(std::move(element));
  }
  return all;
}

/// The first content of an element called `name`; empty when there is none.
std::string text_in(std::string_view text, const std::string& name) {
  const auto found = elements(text, name);
  return found.empty() ? std::string() : without_blanks(found.front().content);
}

/// Where the first element that begins at `from` ends; the end of the text when nowhere.
std::size_t end_of_element(std::string_view text, std::size_t from) {
  int depth = 0;
  for (std::size_t at = from; (at = text.find('<', at)) != std::string_view::npos;) {
    const bool comment = text.substr(at).starts_with("<!--");
    const bool closes = text.substr(at).starts_with("</");
    const std::size_t end = text.find(comment ? "-->" : ">", at);
    if (end == std::string_view::npos) break;
    at = end + (comment ? 3 : 1);
    if (comment) continue;
    if (!closes) ++depth;
    if (closes || text[end - 1] == '/') --depth;
    if (depth <= 0) return at;
  }
  return text.size();
}

/// What the library reads where `given` is CYCLONEDDS_URI: a list of elements and of files.
Result<std::string> configuration(const char* given, int domain) {
  const std::unique_ptr<char, void (*)(void*)> expanded(
      ddsrt_expand_envvars(given, static_cast<std::uint32_t>(domain)), ddsrt_free);
  if (!expanded) return bad_input("CYCLONEDDS_URI: a variable that it names is not set");
  constexpr std::string_view kFile = "file://";
  const std::string_view list = expanded.get();
  std::string all;
  for (std::size_t at = 0; (at = list.find_first_not_of(" \t\r\n,", at)) != list.npos;) {
    const bool element = list[at] == '<';
    const std::size_t end =
        element ? end_of_element(list, at) : std::min(list.find(',', at), list.size());
    std::string_view part = list.substr(at, end - at);
    at = end;
    if (element) {
      all += part;
      continue;
    }
    if (part.starts_with(kFile)) part.remove_prefix(kFile.size());
    const auto content = read_file(part, kMostConfigurationBytes);
    if (!content) return bad_input("CYCLONEDDS_URI: " + content.error().what);
    all += *content;
  }
  return all;
}

/// The first capture of every match.
std::vector<std::string> found(const std::string& text, const char* pattern) {
  const std::regex expression(pattern, std::regex::icase);
  std::vector<std::string> all;
  for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match)
    all.push_back((*match)[1]);
  return all;
}

/// What of a configuration holds in `domain`: all but the parts that name another one.
std::string of_domain(const std::string& text, int domain) {
  std::string holds = text;
  for (const XmlElement& part : elements(text, "domain")) {
    const auto id = found(part.attributes, "\\bid\\s*=\\s*[\"']\\s*([^\"']*?)\\s*[\"']");
    if (id.empty() || id[0] == "any" || id[0] == std::to_string(domain)) continue;
    const std::size_t at = part.content.empty() ? std::string::npos : holds.find(part.content);
    if (at != std::string::npos) holds.erase(at, part.content.size());
  }
  return holds;
}

void read_security(const std::string& text, DdsReach& reach) {
  auto security = elements(text, "security");
  for (XmlElement& other : elements(text, "ddssecurity")) security.push_back(std::move(other));
  if (security.empty()) return;
  // One may stand in several fragments, of which each adds to the others.
  std::string all;
  for (const XmlElement& each : security) all += each.content;
  const std::string authentication = text_in(all, "authentication"),
                    access = text_in(all, "accesscontrol");
  using Needed = std::pair<const std::string&, const char*>;
  for (const auto& [part, name] : std::array{
           Needed{authentication, "IdentityCA"}, Needed{authentication, "IdentityCertificate"},
           Needed{authentication, "PrivateKey"}, Needed{access, "PermissionsCA"},
           Needed{access, "Governance"}, Needed{access, "Permissions"}})
    if (text_in(part, in_lower_case(name)).empty())
      reach.lacks += (reach.lacks.empty() ? "it has no <" : ", no <") + std::string(name) + ">";
  reach.governance = text_in(access, "governance");
  reach.secured = reach.lacks.empty();
}

bool says(std::string_view text, const std::string& element, bool what) {
  const std::string content = in_lower_case(text_in(text, element));
  return content == (what ? "true" : "false") || content == (what ? "1" : "0");
}

/// A document of DDS Security as a configuration names it: file:PATH, or data:,TEXT.
Result<std::string> document(const std::string& named) {
  constexpr std::string_view kFile = "file:", kData = "data:,";
  if (named.starts_with(kData)) return named.substr(kData.size());
  if (named.starts_with(kFile))
    return read_file(named.substr(kFile.size()), kMostConfigurationBytes);
  return bad_input("CYCLONEDDS_URI: <Governance>" + named + "</Governance>: expected file:PATH");
}

}  // namespace

DdsReach reach_of(std::string_view configuration, int domain) {
  const std::string text = of_domain(without_comments(std::string(configuration)), domain);
  DdsReach reach;
  read_security(text, reach);
  std::vector<std::string> interfaces;
  for (const XmlElement& each : elements(text, "networkinterfaceaddress"))
    interfaces.push_back(without_blanks(each.content));
  bool all_own = true;
  for (const XmlElement& each : elements(text, "networkinterface")) {
    const auto named = found(each.attributes, "\\b(?:name|address)\\s*=\\s*[\"']([^\"']*)[\"']");
    all_own = all_own && !named.empty();
    interfaces.insert(interfaces.end(), named.begin(), named.end());
  }
  for (const std::string& interface : interfaces) all_own = all_own && loops_back(interface);
  reach.loopback = all_own && !interfaces.empty();
  return reach;
}

std::string admits_strangers(std::string_view governance, const std::string& topic) {
  const std::string text = without_comments(std::string(governance));
  const auto rules = elements(text, "domain_rule");
  if (rules.empty()) return "its governance has no <domain_rule>";
  for (const XmlElement& rule : rules) {
    if (!says(rule.content, "allow_unauthenticated_participants", false))
      return "its governance allows unauthenticated participants";
    if (!says(rule.content, "enable_join_access_control", true))
      return "its governance lets anybody join who has a certificate "
             "(enable_join_access_control)";
    const auto topics = elements(rule.content, "topic_rule");
    const auto of = std::ranges::find_if(topics, [&](const XmlElement& each) {
      return fnmatch(text_in(each.content, "topic_expression").c_str(), topic.c_str(), 0) == 0;
    });
    if (of == topics.end() || !says(of->content, "enable_write_access_control", true))
      return "its governance lets anybody in the domain write " + topic +
             " (enable_write_access_control)";
  }
  return {};
}

Result<DdsReach> dds_reach(int domain, const std::string& topic) {
  const char* given = std::getenv("CYCLONEDDS_URI");
  const auto text = configuration(given ? given : "", domain);
  if (!text) return tl::unexpected(text.error());
  DdsReach reach = reach_of(*text, domain);
  if (!reach.secured) return reach;
  const auto governance = document(reach.governance);
  if (!governance) return tl::unexpected(governance.error());
  reach.lacks = admits_strangers(*governance, topic);
  reach.secured = reach.lacks.empty();
  return reach;
}

}  // namespace selfcal
