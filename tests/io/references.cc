// Sets that share another's unknowns.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "io/data_set_file.h"

namespace selfcal {
namespace {

TEST(References, AreRefusedWhenTheOtherSetHasNoFitRows) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "references_without_fit_rows";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.robot.yaml") << "robot: a\nkind: serial\nframes:\n"
                                            "  - {name: j1, joint: revolute}\n"
                                            "  - {name: tool, joint: fixed, d: 0.5}\n";
  std::ofstream(folder / "dataset.yaml")
      << "robot: a.robot.yaml\nobservations: o.csv\nsets:\n"
         "  table: {method: plane}\n"
         "  gauge: {method: plane, parallel_to: {set: table, distance: 0.2, noise: 2.0e-6}}\n";
  std::ofstream(folder / "o.csv") << "set,q1,part\ntable,0.1,check\ngauge,0.2,fit\n";
  const auto loaded = load_data_set(folder);
  ASSERT_FALSE(loaded.has_value());
  EXPECT_NE(loaded.error().what.find("table, which has no `fit` rows"), std::string::npos)
      << loaded.error().what;
}

}  // namespace
}  // namespace selfcal
