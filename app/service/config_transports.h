// The parts of CONFIG.yaml that are the transports', and what these and other parts read with.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "app/service/config.h"

namespace selfcal {

/// `encoders` and `trigger` of a configuration whose robot and id are read.
void read_transports(Fields& fields, const std::filesystem::path& folder, Config& config,
                     Problems& problems);

/// The mapping of a key, or an empty one.
const Node& entry_of(Fields& fields, std::string_view key);
/// The mapping without these keys: what is left for somebody else to read.
Node without(const Node& node, const std::vector<std::string_view>& keys);

}  // namespace selfcal
