// A corrected robot keeps what its effects do to a block: it answers as if it were asked for the
// first time.
#include "tests/effects/by_hand.h"
#include "tests/kinematics/kind_examples.h"

namespace selfcal {
namespace {

TEST(CorrectedRobot, AnswersAsIfAskedForTheFirstTimeWhateverAnotherBlockCarries) {
  const auto soft = [] {
    Problems problems;
    const Node list = parsed("effects: [{effect: joint_compliance, at: j1, c: 1.0e-6}]");
    return correct(std::shared_ptr<const Robot>(robot_of(kPendulum)), list.items[0].items, {},
                   problems);
  };
  const auto tip = [](const Robot& robot, double q, double force, Body body) {
    ConfigurationBlock block = block_of(numbers({q}));
    block.conditions.wrench = numbers({0, force, 0, 0, 0, 0}).transpose();
    Locations X;
    robot.locate(block, values(robot), body, X, nullptr);
    return X.p(0);
  };
  const auto asked = soft();
  const Eigen::Vector3d idle = tip(*asked, 0, 0, Body::endpoint);
  for (int again = 0; again < 2; ++again)
    for (const double q : {0.0, 0.5})
      for (const double force : {0.0, 100.0})
        for (const Body body : {Body::endpoint, Body::last_link})
          EXPECT_EQ(tip(*asked, q, force, body), tip(*soft(), q, force, body));
  EXPECT_NEAR((tip(*asked, 0, 100, Body::endpoint) - idle).z(), -100e-6, kSecondOrder);
}

TEST(CorrectedRobot, DoesNotTakeWhatItSawWhereTheLoopsDidNotClose) {
  const std::string machine =
      kind_examples().at("gough-stewart") + kind_masses().at("gough-stewart");
  const std::shared_ptr<const Robot> geometry = robot_of(machine);
  const auto soft = [&] {
    Problems problems;
    const Node list = parsed("effects: [{effect: leg_compliance, at: leg1, c: 1.0e-5}]");
    return correct(geometry, list.items[0].items, {}, problems);
  };
  ConfigurationBlock block = block_of(Eigen::VectorXd::Constant(6, 0.85));
  const auto tip = [&](const Robot& robot) {
    Locations X;
    EXPECT_TRUE(robot.locate(block, values(robot), Body::endpoint, X, nullptr).closes());
    return X.p(0);
  };
  const auto asked = soft();
  // From below its base it is another machine.
  Location below = *geometry->home();
  below.p.z() = -below.p.z();
  block.start = below;
  Locations X;
  ASSERT_FALSE(asked->locate(block, values(*asked), Body::endpoint, X, nullptr).closes());
  block.start.reset();
  EXPECT_EQ(tip(*asked), tip(*soft()));
  EXPECT_GT((tip(*asked) - tip(*geometry)).norm(), 1e-5) << "the leg gives way";
}

}  // namespace
}  // namespace selfcal
