// In place of mujoco_engine.cc where libmujoco was not found when the program was built.
#include "io/models/mujoco.h"

namespace selfcal {
namespace {

tl::unexpected<Failure> built_without(const std::filesystem::path& file) {
  return bad_input(file.string() +
                   ": is a model for MuJoCo, and this selfcal was built without libmujoco "
                   "(Debian: libmujoco-dev)");
}

}  // namespace

Result<MujocoChain> read_mujoco(const std::filesystem::path& file, const std::string&) {
  return built_without(file);
}

Result<MujocoPoses> settled_poses(const std::filesystem::path& file, const std::string&,
                                  const std::vector<MujocoLoad>&, const std::string&) {
  return built_without(file);
}

}  // namespace selfcal
