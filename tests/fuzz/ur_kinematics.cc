// Universal Robots' kinematics file: what is read is written as one that reads back alike.
#include "io/models/ur_kinematics.h"

#include "tests/fuzz/given.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace selfcal;
  const auto read = read_ur_kinematics(std::string(text_of(data, size)), "given.yaml");
  if (!read) return 0;
  promise(read->chain.joints.size() == 6, "not six joints");
  const std::string text = ur_kinematics_text(read->chain, read->hash);
  const auto again = read_ur_kinematics(text, "written.yaml");
  promise(again.has_value(), again ? "" : again.error().what + " in\n" + text);
  promise(again->hash == read->hash, "another hash");
  for (std::size_t j = 0; j < 6; ++j)
    promise(again->chain.joints[j].X_WJ.isApprox(read->chain.joints[j].X_WJ, 1e-6),
            "another joint in\n" + text);
  return 0;
}
