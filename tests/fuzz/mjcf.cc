// A model for MuJoCo, tool and model parted by =====. MuJoCo itself is not instrumented.
#include "io/models/mujoco.h"
#include "tests/fuzz/given.h"

namespace selfcal {
namespace {

void try_model(std::string_view input) {
  const auto parts = parts_of(input, 2);
  const auto file = given_folder().write("given.xml", parts[1]);
  const std::string tool(parts[0]);
  const auto model = read_mujoco(file, tool);
  if (!model) {
    promise(!model.error().what.empty(), "refused without a word");
    return;
  }
  promise(!model->chain.joints.empty(), "a chain without a joint");
  MujocoLoad load;
  load.q = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(model->chain.joints.size()), 0.1);
  load.force.z() = -10;
  const auto poses = settled_poses(file, tool, {load});
  promise(poses && poses->tool.size() == 1, "a chain that cannot be asked");
  if (poses->tool[0]) promise(poses->tool[0]->p.allFinite(), "rests nowhere");
}

}  // namespace
}  // namespace selfcal

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  selfcal::try_model(selfcal::text_of(data, size));
  return 0;
}
