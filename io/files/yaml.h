// YAML text to and from Nodes (yaml-cpp).
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "io/result.h"
#include "kinematics/description.h"

namespace selfcal {

inline constexpr std::size_t kMostYamlBytes = std::size_t{4} << 20;

/// The one mapping that the file holds, every value with its line. Refuses what would be silently
/// lost otherwise: a key given twice, a second document; and what no file of ours needs: nesting
/// deeper than 64, more than kMostYamlBytes.
Result<Node> read_yaml(const std::filesystem::path& path);

/// The same of `text`; `name` stands for the file in messages.
Result<Node> parse_yaml(std::string_view text, const std::string& name);

/// Text that parse_yaml reads back as an equal tree. What fits on a line stands on one:
/// {name: j1, joint: revolute, r: 0.5}.
std::string write_yaml(const Node& node);

}  // namespace selfcal
