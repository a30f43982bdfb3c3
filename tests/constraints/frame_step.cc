// An instrument that was moved between two rows, and what looks like it.
#include "constraints/estimation/frame_step.h"

#include <gmock/gmock.h>

#include <functional>

#include "constraints/estimation/identification.h"
#include "io/files/robot_file.h"
#include "tests/recovery/session.h"

namespace selfcal {
namespace {

constexpr int kTrackedRows = 120, kStepAt = 70;

/// Positions of a simulated robot under a tracker, and what is done to them.
class Tracked {
 public:
  Tracked() {
    auto loaded = load_robot(SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml");
    if (!loaded) std::abort();
    robot = *std::move(loaded);
    truth = Eigen::VectorXd(static_cast<Eigen::Index>(robot->parameters().size()));
    std::normal_distribution<double> normal;
    for (Eigen::Index i = 0; i < truth.size(); ++i) {
      const Parameter& p = robot->parameters()[static_cast<std::size_t>(i)];
      truth[i] = p.nominal + (p.part == Part::link ? 5e-4 * normal(random) : 0);
    }
    const Node tracker = recovery::entry(
        {{"method", "position"}, {"frame", "unknown"}, {"point", "unknown"}, {"noise", "2e-5"}});
    data = recovery::make_session(*robot, truth, {{"tracker", tracker, kTrackedRows}}, 2e-5, random)
               .data;
  }

  void disturb(const std::function<Eigen::Vector3d(int row, const Eigen::Vector3d& p)>& moved) {
    for (int row = 0; row < data.rows.rows(); ++row) {
      const Eigen::Vector3d p = data.rows.position.row(row).transpose();
      data.rows.position.row(row) = (p + moved(row, p)).transpose();
    }
  }
  /// From kStepAt on the joint is read otherwise.
  void shift_zero(int joint, double by) {
    for (int row = kStepAt; row < data.rows.rows(); ++row) data.rows.q(row, joint) -= by;
  }
  Solution identified() const { return identify(*robot, data); }

  std::shared_ptr<const Robot> robot;
  Eigen::VectorXd truth;
  DataSet data;
  Random random{3};
};

TEST(FrameStep, NamesTheRowsBetweenWhichTheInstrumentWasMoved) {
  Tracked tracked;
  const Eigen::Vector3d shift(0.003, -0.002, 0.001);
  tracked.disturb([&](int row, const Eigen::Vector3d&) -> Eigen::Vector3d {
    return row < kStepAt ? Eigen::Vector3d::Zero() : shift;
  });
  const Solution solution = tracked.identified();
  ASSERT_EQ(solution.frame_steps.size(), 1U);
  const FrameStep& step = solution.frame_steps[0];
  EXPECT_EQ(step.set, "tracker");
  EXPECT_EQ(step.before, kStepAt - 1);
  EXPECT_EQ(step.after, kStepAt);
  // Some of it the geometry has taken up.
  EXPECT_NEAR(step.shift, shift.norm(), 0.3 * shift.norm());
  EXPECT_GT(step.share, 0.8);
  EXPECT_EQ(solution.verdict.answer, Answer::not_determined);
  EXPECT_THAT(solution.verdict.why, testing::HasSubstr("between rows 70 and 71"));
  EXPECT_THAT(solution.warnings, testing::Contains(testing::HasSubstr("was moved, by ")));
}

TEST(FrameStep, IsNotSeenInNoiseOrFalseRows) {
  Tracked clean;
  EXPECT_TRUE(clean.identified().frame_steps.empty());
  Tracked false_rows;
  std::normal_distribution<double> normal(0, 5e-3);
  false_rows.disturb([&](int row, const Eigen::Vector3d&) -> Eigen::Vector3d {
    return row % 3 ? Eigen::Vector3d::Zero()
                   : Eigen::Vector3d(normal(false_rows.random), normal(false_rows.random), 0);
  });
  EXPECT_TRUE(false_rows.identified().frame_steps.empty());
}

TEST(FrameStep, IsNotTakenFromADrift) {
  Tracked tracked;
  tracked.disturb([](int row, const Eigen::Vector3d&) -> Eigen::Vector3d {
    return Eigen::Vector3d(5e-3, 0, 0) * row / kTrackedRows;
  });
  EXPECT_TRUE(tracked.identified().frame_steps.empty());
}

TEST(FrameStep, IsNotTakenFromAZeroThatShifts) {
  for (const int joint : {0, 1, 2, 3}) {
    Tracked tracked;
    tracked.shift_zero(joint, 5e-3);
    EXPECT_TRUE(tracked.identified().frame_steps.empty()) << "joint " << joint + 1;
  }
}

}  // namespace
}  // namespace selfcal
