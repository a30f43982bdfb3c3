// Who can reach a DDS participant of this process.
#include "io/dds/reach.h"

#include <cstdlib>
#include <regex>

#include "io/files/file.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostConfigurationBytes = std::size_t{1} << 20;

bool nuisance(const std::string& interface) {
  return interface == "lo" || interface == "::1" || interface.starts_with("127.");
}

/// The first capture of every match.
std::vector<std::string> found(const std::string& text, const char* pattern) {
  const std::regex expression(pattern, std::regex::icase);
  std::vector<std::string> all;
  for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match)
    all.push_back((*match)[1]);
  return all;
}

}  // namespace

DdsReach reach_of(std::string_view configuration) {
  const std::string text =
      std::regex_replace(std::string(configuration), std::regex("<!--[\\s\\S]*?-->"), "");
  DdsReach reach;
  reach.secured = !found(text, "<\\s*((?:DDS)?Security)\\b").empty();
  std::vector<std::string> interfaces =
      found(text, "<\\s*NetworkInterfaceAddress\\s*>\\s*([^<]*?)\\s*<");
  bool all_own = true;
  for (const std::string& element : found(text, "<\\s*NetworkInterface\\b([^>]*)>")) {
    const auto named = found(element, "\\b(?:name|address)\\s*=\\s*[\"']([^\"']*)[\"']");
    all_own = all_own && !named.empty();
    interfaces.insert(interfaces.end(), named.begin(), named.end());
  }
  for (const std::string& interface : interfaces) all_own = all_own && nuisance(interface);
  reach.loopback = all_own && !interfaces.empty();
  return reach;
}

Result<DdsReach> dds_reach() {
  const char* given = std::getenv("CYCLONEDDS_URI");
  std::string text = given ? given : "";
  for (const std::string& path : found(text, "file://([^,<]+)")) {
    const auto content = read_file(path, kMostConfigurationBytes);
    if (!content) return tl::unexpected(content.error());
    text += *content;
  }
  return reach_of(text);
}

}  // namespace selfcal
