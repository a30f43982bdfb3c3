// Where the service of a robot keeps its state.
#pragma once

#include <filesystem>
#include <string>

#include "io/result.h"

namespace selfcal {

/// What is said of the argument WHERE.
inline constexpr const char* kStoreIsWhere =
    "CONFIG.yaml or the state's folder (default: $STATE_DIRECTORY, or /var/lib/selfcal)";

/// Where the store is, and the robot's file when a configuration names it.
struct StoreSource {
  std::filesystem::path state;
  std::string robot_text;
};

/// `where`: a configuration, the state's folder, or empty.
Result<StoreSource> find_store(const std::string& where);

}  // namespace selfcal
