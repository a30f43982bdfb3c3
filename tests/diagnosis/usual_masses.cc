#include "diagnosis/evidence/usual_masses.h"

#include <gtest/gtest.h>

#include "diagnosis/evidence/candidates.h"
#include "io/files/robot_file.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

std::shared_ptr<const Robot> arm(const char* before, const char* of_link) {
  return robot_of(std::string(before) + "robot: arm\nkind: serial\nframes:\n" +
                  "  - {name: j1, joint: revolute, alpha: 1.5707963267948966" + of_link + "}\n" +
                  "  - {name: j2, joint: revolute, d: 0.8}\n" +
                  "  - {name: j3, joint: revolute, d: 0.7}\n" +
                  "  - {name: tool, joint: fixed, d: 0.1}\n");
}

double mass_of(const Robot& robot) {
  double sum = 0;
  for (const Link& link : robot.statics()->mechanics().links) sum += link.mass.value_or(0);
  return sum;
}

TEST(MassOfItsSize, IsGivenToARobotWhoseFileIsSilent) {
  const auto silent = arm("", "");
  const auto heavy = with_mass_of_its_size(silent);
  // 60 kg/m^2 x 1.5^2 m^2 = 135 kg, 0.85 of which move, and 0.3 of a payload of 13.5 kg.
  EXPECT_NEAR(mass_of(*heavy), 0.85 * 135 + 0.3 * 13.5, 1e-9);
  EXPECT_TRUE(heavy->statics()->mechanics().masses_assumed);
  EXPECT_EQ(values(*heavy), values(*silent));
  EXPECT_EQ(model_hash(*heavy), model_hash(*silent));
}

TEST(MassOfItsSize, LeavesARobotAloneThatSaysWhatItWeighsOrFeelsNoWeight) {
  for (const auto& robot :
       {arm("", ", mass: 20"), arm("mass: 90\n", ""), arm("gravity: [0, 0, 0]\n", "")})
    EXPECT_EQ(with_mass_of_its_size(robot), robot);
}

TEST(MassOfItsSize, MakesAJointsSagOneNumberAndTheDoubtOfIt) {
  DataSet data;
  data.rows.q.setZero(20, 3);
  data.rows.set.assign(20, 0);
  int free_lumps = 0, one_number = 0, bending = 0;
  const auto robot = with_mass_of_its_size(arm("", ""));
  for (const Candidate& each : candidates(*robot, data, MeasurementContext{}).list) {
    bending += each.effect == "link_compliance";
    if (each.effect != "joint_compliance") continue;
    (each.main.size() == 1 ? one_number : free_lumps) += 1;
    if (!each.slack.empty()) {
      ASSERT_EQ(each.slack.size(), 2u) << "of masses, and of a spring that stiffens";
      EXPECT_GT(each.slack[0].doubt, 0.5) << "of masses that nobody weighed";
    }
  }
  EXPECT_EQ(one_number, 6);  // of three joints: exact, and with doubt
  EXPECT_EQ(free_lumps, 0);
  EXPECT_EQ(bending, 3);
}

}  // namespace
}  // namespace selfcal
