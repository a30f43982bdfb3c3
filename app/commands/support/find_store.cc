#include "app/commands/support/find_store.h"

#include <cstdlib>

#include "app/service/config/config.h"

namespace selfcal {

Result<StoreSource> find_store(const std::string& where) {
  std::error_code error;
  if (where.empty()) {
    const char* folder = std::getenv("STATE_DIRECTORY");
    return StoreSource{folder ? folder : "/var/lib/selfcal", ""};
  }
  if (std::filesystem::is_directory(where, error)) return StoreSource{where, ""};
  auto config = load_config(where);
  if (!config) return tl::unexpected(config.error());
  return StoreSource{config->state, std::move(config->robot_text)};
}

}  // namespace selfcal
