// A row that is less certain than its set weighs less; a data sheet's noise that is not the rows'.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/estimation/identification.h"
#include "constraints/fitting/noise.h"
#include "kinematics/rotation.h"
#include "tests/sim/simulated_robot.h"
#include "tests/support/end_position.h"

namespace selfcal {
namespace {

constexpr double kRelativeRounding = 1e-9;  // relative

Simulated touches() {
  return made(
      "robot: rx90.robot.yaml\nseed: 3\nerrors: {length: 1.0e-3, angle: 1.0e-3}\nsets:\n"
      "  table: {method: plane, rows: 90, noise: 2.0e-5,\n"
      "    surface: {point: [0.6, 0, 0.2], normal: [0, 0, 1]}}\n"
      "  wall: {method: plane, rows: 90, noise: 2.0e-5,\n"
      "    surface: {point: [0.7, 0, 0.6], normal: [-1, 0, 0]}}\n");
}

TEST(NoiseFactor, OfEveryRowIsThatOfTheSet) {
  const Simulated simulated = touches();
  DataSet data = simulated.data;
  const Equations plain(rx90(), data, Use::fit);
  DataSet uncertain = data;
  uncertain.rows.noise_factor.setConstant(data.rows.rows(), 3);
  const Equations factored(rx90(), uncertain, Use::fit);
  const std::vector<char> none(data.rows.rows(), 0);
  const Weighting wide{{{6e-5, 1}, {6e-5, 1}}, none}, narrow{{{2e-5, 1}, {2e-5, 1}}, none};
  const State& state = simulated.truth;
  const Eigen::MatrixXd ours_R = factored.linearise(state, narrow).R;
  const Eigen::MatrixXd theirs_R = plain.linearise(state, wide).R;
  EXPECT_TRUE(
      (ours_R.transpose() * ours_R).isApprox(theirs_R.transpose() * theirs_R, kRelativeRounding));
  EXPECT_TRUE(factored.dense(state, narrow.scale, none)
                  .W.isApprox(plain.dense(state, wide.scale, none).W, kRelativeRounding));
  const Noise ours = estimate_noise(factored, factored.norms(state), {});
  const Noise theirs = estimate_noise(plain, plain.norms(state), {});
  EXPECT_NEAR(3 * ours.estimated[0].length, theirs.estimated[0].length, 1e-12);
}

TEST(NoiseFactor, KeepsUncertainRowsFromSpoilingTheOthers) {
  const Simulated simulated = made(
      "robot: rx90.robot.yaml\nseed: 3\nerrors: {length: 1.0e-3, angle: 1.0e-3}\n"
      "sets: {tracker: {method: position, rows: 90, noise: 2.0e-5}}\n");
  // Every third reading is off by twenty times the noise, and says so.
  DataSet data = simulated.data;
  Random random(5);
  std::normal_distribution<double> off(0, 4e-4);
  data.rows.noise_factor.setOnes(data.rows.rows());
  for (int row = 0; row < data.rows.rows(); row += 3) {
    data.rows.q(row, 1) += off(random);
    data.rows.noise_factor[row] = 12;
  }
  const auto error = [&](const DataSet& of) {
    const Solution solution = identify(rx90(), of, {}, {});
    Eigen::VectorXd found = values(rx90());
    for (const ParameterResult& each : solution.parameters)
      found[find_parameter(rx90(), each.parameter.name)] = each.value;
    return aligned_errors(rx90(), found, simulated.truth.xi)[250];
  };
  DataSet unsaid = data;
  unsaid.rows.noise_factor.resize(0);
  EXPECT_LT(error(data), 0.8 * error(unsaid));
}

TEST(NoiseFactor, IsTakenOffWhatRepeatsDifferBy) {
  constexpr double kSigma = 2e-5;
  DataSet data = touches().data;
  const int rows = data.rows.rows();
  data.rows.noise_factor.setOnes(rows);
  data.rows.repeat.assign(rows, 0);
  Random random(6);
  std::normal_distribution<double> normal;
  std::vector<RowResidual> residuals;
  for (int row = 0; row < rows; ++row) {
    data.rows.repeat[row] = row / 3;
    RowResidual& r = residuals.emplace_back(RowResidual{row, 0});
    r.lengths = 1;
    r.factor = row % 3 == 0 ? 10 : 1;
    r.scalars.set(0, kSigma * r.factor * normal(random));
  }
  // 120 freedoms tell a sigma to 6 %, three times which is allowed.
  EXPECT_NEAR(repeat_spreads(data, 0, residuals, std::vector<char>(rows, 0)).length.sigma(), kSigma,
              0.19 * kSigma);
}

TEST(StatedNoise, IsToldWhereItIsNotThatOfTheRows) {
  const Simulated simulated = touches();
  const auto found_with = [&](double stated) {
    DataSet data = simulated.data;
    for (Set& set : data.sets) set.noise = stated;
    return identify(rx90(), data, {}, {});
  };
  const auto told_with = [&](double stated) { return found_with(stated).warnings; };
  using testing::AllOf, testing::HasSubstr;
  using testing::Contains;
  EXPECT_THAT(told_with(2e-5), testing::Not(Contains(HasSubstr("data sheet"))));
  EXPECT_THAT(told_with(2e-3),
              Contains(HasSubstr("times what its rows scatter by: is `noise` in metres")));
  EXPECT_THAT(told_with(2e-6), Contains(HasSubstr("times as much as its data sheet says")));
  EXPECT_THAT(told_with(1.1e-5),
              Contains(AllOf(HasSubstr("scatter 2 times as much as its data sheet says"),
                             HasSubstr("the robot strays by 0.019 mm in each direction"))));
  EXPECT_TRUE(found_with(2e-6).sets[0].unexplained);
  EXPECT_FALSE(found_with(2e-5).sets[0].unexplained);
}

/// Orientations that stray by 400 urad from pose to pose and by 40 from repeat to repeat.
TEST(Repeats, TellAnglesThatScatterMoreThanTheyDiffer) {
  constexpr double kPose = 4e-4, kRepeat = 4e-5;
  const Simulated simulated = made(
      "robot: rx90.robot.yaml\nseed: 4\nerrors: {length: 1.0e-3, angle: 1.0e-3}\n"
      "sets: {arm: {method: location, rows: 60, noise_true: 2.0e-5, noise_angle_true: 4.0e-4}}\n");
  const DataSet& once = simulated.data;
  std::vector<int> thrice;
  for (int row = 0; row < once.rows.rows(); ++row) thrice.insert(thrice.end(), 3, row);
  DataSet data = once;
  data.rows = taken(once.rows, thrice);
  data.rows.repeat = thrice;
  Random random(7);
  std::normal_distribution<double> normal;
  for (int row = 0; row < data.rows.rows(); ++row) {
    const Eigen::Vector3d turn(normal(random), normal(random), normal(random));
    const Eigen::Vector4d read = data.rows.orientation.row(row);
    const Eigen::Quaterniond turned = Eigen::Quaterniond(exp_rotation(kRepeat * turn)) *
                                      Eigen::Quaterniond(read[0], read[1], read[2], read[3]);
    data.rows.orientation.row(row) << turned.w(), turned.x(), turned.y(), turned.z();
  }
  const Solution solution = identify(rx90(), data, {}, {});
  const SetResult& arm = solution.sets[0];
  // 360 freedoms tell a sigma to 4 %, three times which is allowed; 60 poses to 8 %.
  EXPECT_NEAR(arm.repeat_angle_sigma, kRepeat, 0.12 * kRepeat);
  EXPECT_NEAR(arm.noise_angle_sigma, kPose, 0.24 * kPose);
  EXPECT_TRUE(arm.unexplained);
  EXPECT_THAT(solution.warnings,
              testing::Contains(testing::AllOf(testing::HasSubstr("set arm: the angles scatter"),
                                               testing::HasSubstr("as their repeats"))));
}

}  // namespace
}  // namespace selfcal
