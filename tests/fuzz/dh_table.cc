// A vendor's table of Denavit and Hartenberg's numbers; the first byte chooses the convention.
#include "io/models/dh_table.h"

#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "tests/fuzz/given.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace selfcal;
  if (size == 0) return 0;
  const auto table = read_dh_table(given_folder().write("arm.csv", text_of(data + 1, size - 1)),
                                   data[0] % 2 == 0 ? "standard" : "modified");
  if (!table) return 0;
  const auto robot = robot_of(write_yaml(*table), "converted");
  promise(robot.has_value() || !robot.error().what.empty(), "refused without a word");
  return 0;
}
