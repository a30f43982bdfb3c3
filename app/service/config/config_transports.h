// The parts of CONFIG.yaml that are the transports', and what these and other parts read with.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "app/service/config/config.h"

namespace selfcal {

/// `encoders` and `trigger` of a configuration whose robot and id are read.
void read_transports(Fields& fields, const std::filesystem::path& folder, Config& config,
                     Problems& problems);

/// The mapping of a key, or an empty one.
const Node& entry_of(Fields& fields, std::string_view key);

}  // namespace selfcal
