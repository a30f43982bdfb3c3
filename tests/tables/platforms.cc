// Parameters that each method tells of the platforms (Besnard and Khalil 2001; Rauf, Kim and Ryu),
// through the program: ../shared/spec/tables/README.md.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/shared_data.h"
#include "tests/support/program.h"

namespace selfcal {
namespace {

struct PlatformCount {
  const char* title;
  const char* robot;
  const char* options;
  int told;
};

class PlatformCounts : public testing::TestWithParam<PlatformCount> {};

TEST_P(PlatformCounts, AreThePublishedOnesAndWhatIsLostIsAllAccountedFor) {
  SELFCAL_NEED_SHARED();
  const auto robot = shared_dir() / "robots" / (std::string(GetParam().robot) + ".robot.yaml");
  const Ran ran = run_selfcal(
      "identifiable " + robot.string() + " --method " + GetParam().options + " --json", true);
  ASSERT_EQ(ran.status, 0) << ran.out;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["total"], GetParam().told);
  int lost = 0;
  for (const auto& each : json.value("lost", nlohmann::json::array())) {
    lost += each["count"].get<int>();
    EXPECT_NE(each["why"], "");
  }
  EXPECT_EQ(json["total"].get<int>() + lost, json["candidates"]);
}

INSTANTIATE_TEST_SUITE_P(
    Published, PlatformCounts,
    testing::Values(
        PlatformCount{"Location", "stewart", "location", 42},
        PlatformCount{"Position", "stewart", "position", 39},
        PlatformCount{"Inclinometers", "stewart", "inclinometers", 35},
        PlatformCount{"OneUniversal", "stewart", "locked-joint --lock leg=1,joint=universal", 29},
        PlatformCount{"OneSpherical", "stewart", "locked-joint --lock leg=5,joint=spherical", 29},
        PlatformCount{"TwoUniversal", "stewart",
                      "locked-joint --lock leg=1,joint=universal --lock leg=4,joint=universal", 30},
        PlatformCount{"TwoSpherical", "stewart",
                      "locked-joint --lock leg=2,joint=spherical --lock leg=3,joint=spherical", 30},
        PlatformCount{"ThreeOfBothKinds", "stewart",
                      "locked-joint --lock leg=1,joint=universal --lock leg=3,joint=spherical "
                      "--lock leg=6,joint=universal",
                      30},
        PlatformCount{"KnownPlane", "stewart", "plane", 36},
        PlatformCount{"UnknownPlane", "stewart", "plane --unknown", 33},
        PlatformCount{"SliderByTheLink", "hexaslide", "constraint-link", 54},
        PlatformCount{"SliderByLocations", "hexaslide", "location", 54},
        PlatformCount{"SliderByPositions", "hexaslide", "position", 51},
        // A rail's start and the platform's joints as the legs of the other platform.
        PlatformCount{"SliderByAKnownPlane", "hexaslide", "plane", 48},
        PlatformCount{"SliderByAnUnknownPlane", "hexaslide", "plane --unknown", 45}),
    [](const auto& made) { return std::string(made.param.title); });

}  // namespace
}  // namespace selfcal
