// A robot file: what loads is written as a file that loads to the same robot, and can be located.
#include "io/files/robot_file.h"

#include "tests/fuzz/given.h"

namespace selfcal {
namespace {

void try_robot(std::string_view text) {
  const auto robot = robot_of(text, "given.robot.yaml");
  if (!robot) return;
  const std::string written = robot_text(**robot, values(**robot));
  const auto again = robot_of(written, "written.robot.yaml");
  promise(again.has_value(), again ? "" : again.error().what + " in\n" + written);
  promise(robot_text(**again, values(**again)) == written, "written twice it differs:\n" + written);
  promise(model_hash(**again) == model_hash(**robot), "written it has another model hash");

  ConfigurationBlock block =
      block_of(Eigen::VectorXd::Zero(static_cast<Eigen::Index>((*robot)->joints().size())));
  Locations X;
  PsiBlock psi;
  const Closure closure = (*robot)->locate(block, values(**robot), Body::endpoint, X, &psi);
  promise(X.position.allFinite() && X.rotation.allFinite() && psi.allFinite(),
          closure.closes() ? "no finite location" : "no finite filling of an open lane");
}

}  // namespace
}  // namespace selfcal

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  selfcal::try_robot(selfcal::text_of(data, size));
  return 0;
}
