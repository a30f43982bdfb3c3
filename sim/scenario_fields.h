// Getters that several parts of a scenario share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinematics/description.h"

namespace selfcal {

/// `name: value` of a mapping, with its place for messages.
struct NamedNumber {
  std::string name;
  double value = 0;
  Place place;
};

/// The entries of a mapping of numbers; empty when missing.
std::vector<NamedNumber> named_numbers(Fields& fields, std::string_view key, Problems& problems);

/// Reads a whole mapping into a T: `fill(fields, result)` asks for its keys, others are refused.
template <class T, class Fill>
T read_whole(const Node& node, const std::string& what, Problems& problems, Fill fill) {
  Fields fields(node, what, problems);
  T result;
  fill(fields, result);
  fields.refuse_unknown();
  return result;
}

}  // namespace selfcal
