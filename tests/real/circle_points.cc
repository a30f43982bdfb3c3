// Circle points of a FANUC R-2000iC by a laser tracker: the axes that they say against its maker's.
#include <gmock/gmock.h>

#include "constraints/axes/axis_model.h"
#include "tests/real/real_data.h"

namespace selfcal::real {
namespace {

TEST(RealCircles, GiveTheAxesOfTheMakersTable) {
  SELFCAL_NEED_SHARED();
  const LoadedDataSet loaded = load("r2000ic-circlepoint");
  Problems problems;
  const Robot& robot = *loaded.robot;
  const serial::Model file = serial::read(robot.text().describe(values(robot)), problems);
  std::vector<std::string> lacking;
  const auto model = axis_model(file, loaded.data, lacking);
  ASSERT_TRUE(model) << lacking.front();
  const std::vector<serial::Frame>& found = model->found.frames;
  const std::vector<serial::Frame>& made = model->made.frames;
  for (std::size_t j = 1; j < 7; ++j) {
    const Eigen::VectorXd off = found[j].value - made[j].value;
    std::printf("circles, %s: alpha %+.2f mrad, d %+.2f mm, theta %+.2f mrad, r %+.2f mm\n",
                found[j].name.c_str(), 1e3 * off[serial::kAlpha], 1e3 * off[serial::kD],
                1e3 * off[serial::kTheta], 1e3 * off[serial::kR]);
    // What robots of this size differ from their tables: 1 mm and 1 mrad, at 3 sigma.
    EXPECT_LT(std::abs(off[serial::kAlpha]), 3e-3) << found[j].name;
    EXPECT_LT(std::abs(off[serial::kD]), 3e-3) << found[j].name;
    EXPECT_LT(std::abs(off[serial::kTheta]), 6e-3) << found[j].name;  // the zeros of its joints
  }
  // Distances of neighbouring axes as the data's own page has them from screw axes.
  EXPECT_NEAR(found[2].value[serial::kD], 0.3116, 1e-3);
  EXPECT_NEAR(found[3].value[serial::kD], 1.0756, 1e-3);
  EXPECT_NEAR(found[4].value[serial::kD], 0.2262, 1e-3);
}

}  // namespace
}  // namespace selfcal::real
