// Errors of one joint by laws that no effect has, beside effects that look much like them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "diagnosis/diagnosis.h"
#include "diagnosis/evidence/usual_masses.h"
#include "io/files/robot_file.h"
#include "kinematics/robot.h"
#include "tests/diagnosis/two_sessions.h"
#include "tests/recovery/session.h"

namespace selfcal {
namespace {

/// A row as the laws see it: the second joint's reading (rad), its torque over the largest, and how
/// far the warmth has come (-1 to 1).
struct At {
  double q, torque, warm;
};

/// A robot under a tracker, whose second joint is off by `law` (rad).
class OneJointOff {
 public:
  explicit OneJointOff(const std::function<double(const At&)>& law, int rows = 150) {
    auto loaded = load_robot(SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml");
    if (!loaded) std::abort();
    robot_ = with_mass_of_its_size(*std::move(loaded));
    Random random(5);
    const Node tracker = recovery::entry({{"method", "position"}, {"noise", "2e-5"}});
    data_ = recovery::make_session(*robot_, nominal_values(*robot_), {{"tracker", tracker, rows}},
                                   kTrackerNoise, random)
                .data;
    Observations& all = data_.rows;
    all.time = Eigen::VectorXd::LinSpaced(rows, 0, 3600);
    all.temperature.resize(rows);
    Eigen::VectorXd torque(rows);
    for (int i = 0; i < rows; ++i) torque[i] = torque_of_second(all.q.row(i));
    torque /= torque.cwiseAbs().maxCoeff();
    for (int i = 0; i < rows; ++i) {
      // Up and down: it is no drift.
      const double warm = std::sin(12.0 * i / rows);
      all.temperature[i] = 24 + 3 * warm;
      all.q(i, 1) -= law({all.q(i, 1), torque[i], warm});
    }
  }

  Diagnosis diagnose() const { return selfcal::diagnose(robot_, data_, quick()); }

 private:
  double torque_of_second(const Eigen::VectorXd& q) const {
    const Statics& statics = *robot_->statics();
    return joint_torque(statics.mechanics(), statics.link_poses(q), {}, 1);
  }

  std::shared_ptr<const Robot> robot_;
  DataSet data_;
};

constexpr double kSize = 2e-4;  // rad

void expect_unknown(const Diagnosis& found, KernelDomain domain) {
  EXPECT_EQ(found.verdict.effect, kUnknown) << found.why;
  EXPECT_GT(found.verdict.probability, 0.9);
  ASSERT_TRUE(found.unknown) << found.why;
  EXPECT_EQ(found.unknown->domain, domain) << found.why;
  EXPECT_EQ(found.unknown->joint, "j2");
  EXPECT_THAT(found.why, ::testing::HasSubstr("joint j2"));
}

void expect_named(const Diagnosis& found, const char* effect) {
  EXPECT_EQ(found.verdict.effect, effect) << found.why;
  EXPECT_EQ(found.verdict.where, std::vector<std::string>{"j2"});
  EXPECT_GT(found.verdict.probability, 0.9) << found.why;
}

TEST(JointLaws, OfStiffnessThatChangesWithTheAngleAreUnknown) {
  const OneJointOff off([](const At& at) { return kSize * at.torque * std::cos(3 * at.q); });
  expect_unknown(off.diagnose(), KernelDomain::load);
}

TEST(JointLaws, OfAHosePackThatPullsFromSomeAngleOnAreUnknown) {
  const OneJointOff off([](const At& at) { return kSize * (at.q > -1.2 ? 1 : 0); });
  expect_unknown(off.diagnose(), KernelDomain::kinked);
}

TEST(JointLaws, OfAGearWhoseErrorGrowsWithTheWarmthAreUnknown) {
  const OneJointOff off([](const At& at) { return kSize * at.warm * std::cos(at.q + 0.3); });
  expect_unknown(off.diagnose(), KernelDomain::warmth);
}

TEST(JointLaws, OfAPlainSpringAreItsCompliance) {
  const OneJointOff off([](const At& at) { return kSize * at.torque; });
  expect_named(off.diagnose(), "joint_compliance");
}

TEST(JointLaws, OfAZeroThatGoesWithTheWarmthAreItsShift) {
  const OneJointOff off([](const At& at) { return kSize * at.warm; });
  expect_named(off.diagnose(), "zero_shift");
}

TEST(JointLaws, OfAPlainGearAreItsTransmissionError) {
  const OneJointOff off([](const At& at) { return kSize * std::cos(2 * at.q + 0.3); });
  expect_named(off.diagnose(), "transmission_error");
}

}  // namespace
}  // namespace selfcal
