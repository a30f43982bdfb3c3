#include "diagnosis/validation/correction.h"

#include <algorithm>
#include <iterator>

namespace selfcal {

Correction named_of(const Correction& correction) {
  Correction named;
  std::ranges::copy_if(correction, std::back_inserter(named), &FoundEffect::named);
  return named;
}

std::vector<Node> entries_of(const Correction& correction) {
  std::vector<Node> list;
  for (const FoundEffect& each : correction) {
    list.push_back(entry_of(each.what));
    for (const auto& [name, value] : each.values) list.back().set(name, Node::of(value));
    // What rows speak for is told, however large.
    if (!each.values.empty()) list.back().set("unusual", Node::of(std::string("true")));
    list.back().set("named", Node::of(std::string(each.named ? "true" : "false")));
  }
  return list;
}

}  // namespace selfcal
