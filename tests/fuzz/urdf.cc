// A URDF, base and tip and the model parted by =====. A chain that is read becomes a robot, whose
// own URDF is read again.
#include "io/models/urdf.h"

#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "io/models/mjcf_text.h"
#include "io/models/urdf_text.h"
#include "tests/fuzz/given.h"

namespace selfcal {
namespace {

void try_urdf(std::string_view input) {
  const auto parts = parts_of(input, 3);
  const std::string text(parts[2]);
  const auto urdf = read_urdf(text, "given.urdf", {std::string(parts[0]), std::string(parts[1])});
  if (!urdf) {
    promise(!urdf.error().what.empty(), "refused without a word");
    return;
  }
  const Node file = serial::write(frames_of(urdf->chain));
  const auto robot = robot_of(write_yaml(file), "converted");
  if (!robot) return;
  Problems problems;
  const serial::Model model = serial::read(file, problems);
  promise(!problems.any(), "loads as a robot and not as a model");
  const UrdfText written = urdf_of(model);
  const auto again = read_urdf(written.text, "written.urdf", {});
  promise(again.has_value(), again ? "" : again.error().what + " in\n" + written.text);
  promise(!mjcf_of(serial::with_usual_masses(model), {}).text.empty(), "no model for MuJoCo");
}

}  // namespace
}  // namespace selfcal

// urdfdom does not free the links of a model that it refuses.
extern "C" const char* __lsan_default_suppressions() { return "leak:urdf::parseURDF\n"; }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  selfcal::try_urdf(selfcal::text_of(data, size));
  return 0;
}
