#include "sim/scenario_fields.h"

namespace selfcal {

std::vector<NamedNumber> named_numbers(Fields& fields, std::string_view key, Problems& problems) {
  std::vector<NamedNumber> list;
  const Node* node = fields.node(key);
  if (!node) return list;
  Fields inner(*node, fields.what() + " " + std::string(key), problems);
  for (std::size_t i = 0; i < node->keys.size(); ++i)
    list.push_back({node->keys[i], inner.number(node->keys[i]), node->items[i].place});
  return list;
}

}  // namespace selfcal
