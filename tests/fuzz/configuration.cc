// A service's configuration, CONFIG.yaml, robot.yaml and a DBC file parted by =====.
#include "app/service/config/config.h"

#include "tests/fuzz/given.h"

namespace selfcal {
namespace {

void try_configuration(std::string_view input) {
  const auto parts = parts_of(input, 3);
  const GivenFolder& folder = given_folder();
  folder.write("robot.yaml", parts[1]);
  folder.write("given.dbc", parts[2]);
  const auto config = load_config(folder.write("config.yaml", parts[0]));
  if (!config) {
    promise(!config.error().what.empty(), "refused without a word");
    return;
  }
  promise(config->robot && !config->id.empty() && !config->sets.empty(), "accepted in part");
  promise(config->joint_names.size() == config->robot->joints().size(), "other joints");
}

}  // namespace
}  // namespace selfcal

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  selfcal::try_configuration(selfcal::text_of(data, size));
  return 0;
}
