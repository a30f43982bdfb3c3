#include "app/service/config/command_rules.h"

#include <algorithm>

namespace selfcal {

std::string CommandRules::forbids(Verb verb) const {
  if (over == Over::none)
    return "this service takes no commands over DDS (`commands` of its configuration)";
  if (std::ranges::find(allow, verb) != allow.end()) return {};
  return "this service does not take '" + std::string(to_string(verb)) +
         "' over DDS (`commands: {allow: [...]}` of its configuration)";
}

Result<void> CommandRules::hold(const DdsReach& reach) const {
  if (over == Over::loopback && !reach.loopback)
    return bad_input(
        "commands: {over: loopback}, but DDS is not confined to this computer: CYCLONEDDS_URI must "
        "name its loopback interface and no other, as <General><Interfaces><NetworkInterface "
        "address=\"127.0.0.1\"/></Interfaces></General>");
  if (over == Over::secured && !reach.secured)
    return bad_input(
        reach.lacks.empty()
            ? "commands: {over: secured}, but there is no DDS Security in CYCLONEDDS_URI "
              "(<Security>...</Security>)"
            : "commands: {over: secured}, but DDS Security in CYCLONEDDS_URI keeps nobody out: " +
                  reach.lacks);
  return {};
}

std::string CommandRules::text() const {
  if (over == Over::none) return "no commands are taken over DDS";
  std::string verbs;
  for (const Verb verb : allow) verbs += (verbs.empty() ? "" : ", ") + std::string(to_string(verb));
  return verbs + " may be commanded by " +
         (over == Over::loopback  ? "programs on this computer (loopback)"
          : over == Over::secured ? "who DDS Security admits"
                                  : "ANYONE in this DDS domain");
}

}  // namespace selfcal
