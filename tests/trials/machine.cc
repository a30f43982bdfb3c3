// The machine of a trial: reproducible, as visible as asked, unlike any candidate.
#include <gtest/gtest.h>

#include <cmath>

#include "constraints/equations/equations.h"
#include "constraints/estimation/identification.h"
#include "sim/trials/trial_machine.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

TrialRequest request(const std::string& effect, double r, bool touches) {
  TrialRequest out;
  out.effect = effect;
  out.r = r;
  out.touches = touches;
  out.least_rows = 150;
  out.most_rows = 200;
  out.seed = 11;
  return out;
}

TEST(TrialMachine, MakesOneTrialOfOneSeed) {
  TrialRequest asked = request("", 1, true);
  asked.effect.clear();
  const MadeTrial a = make_trial(asked), b = make_trial(asked);
  ASSERT_TRUE(a.unreached.empty()) << a.unreached;
  EXPECT_EQ(a.truth.effect, b.truth.effect);
  EXPECT_TRUE(a.data.rows.q == b.data.rows.q);
  asked.number = 1;
  EXPECT_FALSE(make_trial(asked).data.rows.q.topRows(1) == a.data.rows.q.topRows(1));
}

TEST(TrialMachine, GivesWhatATrialAsksFor) {
  const MadeTrial made = make_trial(request("backlash", 1, true));
  ASSERT_TRUE(made.unreached.empty()) << made.unreached;
  const Observations& rows = made.data.rows;
  EXPECT_EQ(made.data.sets.size(), 4u);
  EXPECT_EQ(rows.rows(), made.truth.rows);
  EXPECT_TRUE(rows.normal.allFinite() && rows.velocity.allFinite() && rows.temperature.allFinite());
  EXPECT_TRUE(
      (rows.time.tail(rows.rows() - 1).array() > rows.time.head(rows.rows() - 1).array()).all());
  int repeated = 0, check = 0;
  for (int i = 0; i < rows.rows(); ++i) {
    repeated += rows.repeat[i] >= 0;
    check += rows.check[i];
  }
  EXPECT_GT(repeated, rows.rows() / 10);
  EXPECT_GT(check, rows.rows() / 6);
}

/// Rms over the noise of what the geometry's columns leave of the trial's shifts, from the normal
/// equations at the nominal robot: another way than the generator's.
double visible_again(const MadeTrial& made) {
  const Equations equations(*made.robot, made.data, Use::fit);
  State state{values(*made.robot), {}, {}};
  for (const Set& set : made.data.sets) {
    state.nuisance.emplace_back(Eigen::VectorXd::Zero(set.name == "tracker" ? 0 : 4));
    state.groups.emplace_back();
  }
  equations.start(state);
  const double noise = made.truth.noise;
  const DenseEquations dense =
      equations.dense(state, std::vector<Scale>(made.data.sets.size(), Scale{noise, 1}),
                      std::vector<char>(static_cast<size_t>(made.data.rows.rows()), 0));
  Eigen::MatrixXd N = dense.W.transpose() * dense.W;
  for (int c = 0; c < equations.robot_columns(); ++c)
    N(c, c) += std::pow(made.robot->parameters()[static_cast<size_t>(c)].tolerance, -2);
  Eigen::VectorXd seen(dense.W.rows());
  for (Eigen::Index i = 0; i < seen.size(); ++i) {
    const int row = dense.row[static_cast<size_t>(i)];
    const Eigen::Vector3d shift = made.shifts.row(row).transpose();
    const int axis = i > 0 && dense.row[static_cast<size_t>(i - 1)] == row
                         ? (i > 1 && dense.row[static_cast<size_t>(i - 2)] == row ? 2 : 1)
                         : 0;
    const Eigen::VectorXd& nuisance = state.nuisance[static_cast<size_t>(made.data.rows.set[row])];
    seen[i] = (nuisance.size() == 4 ? nuisance.head<3>().dot(shift) : shift[axis]) / noise;
  }
  const Eigen::VectorXd left = seen - dense.W * N.ldlt().solve(dense.W.transpose() * seen).eval();
  return left.norm() / std::sqrt(static_cast<double>(seen.size()));
}

TEST(TrialMachine, MakesEveryCauseAsVisibleAsAsked) {
  const std::vector<std::string> anywhere{"joint_compliance",   "link_compliance", "backlash",
                                          "transmission_error", "joint_coupling",  "zero_shift",
                                          "thermal_expansion",  "base_drift",      "tool_shift",
                                          "tool_compliance",    "unknown"};
  const std::vector<std::string> touched{"probe_pretravel", "trigger_latency", "plane_form_error",
                                         "fixture_shift"};
  const auto expect = [](const std::string& effect, bool touches) {
    SCOPED_TRACE(effect);
    const MadeTrial made = make_trial(request(effect, 1.5, touches));
    ASSERT_TRUE(made.unreached.empty()) << made.unreached;
    EXPECT_EQ(made.truth.effect, effect);
    // The size is set at the rows before they move by the deviation itself: second order.
    EXPECT_NEAR(made.visible, 1.5, 0.01);
    // Another linearisation (nominal robot, fitted planes): millimetres over a metre.
    EXPECT_NEAR(visible_again(made), 1.5, 0.05);
  };
  for (const std::string& effect : anywhere) {
    expect(effect, true);
    expect(effect, false);
  }
  for (const std::string& effect : touched) expect(effect, true);
  expect("scale_error", false);
}

class TrialOnLegs : public testing::TestWithParam<const char*> {};

TEST_P(TrialOnLegs, MakesTheirCausesAsVisibleAsAsked) {
  const std::shared_ptr<const Robot> robot = robot_of(kind_examples().at(GetParam()));
  const auto expect = [&](const std::string& effect, bool touches) {
    SCOPED_TRACE(effect + (touches ? ", touched" : ", tracked"));
    TrialRequest asked = request(effect, 1.5, touches);
    asked.robot = robot;
    const MadeTrial made = make_trial(asked);
    ASSERT_EQ(made.unreached, "");
    EXPECT_NEAR(made.visible, 1.5, 0.02);
    EXPECT_NEAR(visible_again(made), 1.5, 0.08);
  };
  for (const char* effect :
       {"leg_thermal_growth", "zero_shift", "backlash", "tool_shift", "base_drift", "unknown"}) {
    expect(effect, false);
    expect(effect, true);
  }
  // Touches carry no loads.
  for (const char* effect : {"leg_compliance", "joint_clearance"}) expect(effect, false);
  TrialRequest idle = request("joint_clearance", 1.5, true);
  idle.robot = robot;
  EXPECT_NE(make_trial(idle).unreached, "");
}

INSTANTIATE_TEST_SUITE_P(Kinds, TrialOnLegs,
                         testing::Values("gough-stewart", "hexaslide", "linear-delta"),
                         [](const auto& made) {
                           std::string kind = made.param;
                           std::erase(kind, '-');
                           return kind;
                         });

/// Legs are in balance with what they carry: with n the way of each leg as it pushes the tip, the
/// pushes together are the load.
TEST(TrialWorld, PullsItsLegsInBalanceWithTheLoad) {
  const auto robot = robot_of(kind_examples().at("gough-stewart"));
  TrialWorld world;
  world.robot = robot.get();
  world.mass = {20};
  world.com = {{0.01, -0.02, 0.05}};
  Instant at;
  at.q = Eigen::VectorXd::Constant(6, 0.85);
  at.force = {30, -50, 10};
  at.moment = {1, 2, -3};
  look(*robot, values(*robot), at);
  Eigen::Matrix<double, 6, 1> pushed = Eigen::Matrix<double, 6, 1>::Zero();
  for (int leg = 0; leg < 6; ++leg) {
    const auto place = [&](const std::string& field) {
      return values(*robot)[find_parameter(*robot, robot->joints()[leg].name + "." + field)];
    };
    const Eigen::Vector3d a(place("bx"), place("by"), place("bz")),
        arm = at.poses[0].linear() * Eigen::Vector3d(place("px"), place("py"), place("pz"));
    const Eigen::Vector3d n = (at.poses[0].translation() + arm - a).normalized();
    pushed.head<3>() -= world.torque(at, leg) * n;
    pushed.tail<3>() -= world.torque(at, leg) * arm.cross(n);
  }
  const Eigen::Vector3d weight(0, 0, -20 * 9.81);
  EXPECT_LT((pushed.head<3>() + at.force + weight).norm(), 1e-9);
  EXPECT_LT(
      (pushed.tail<3>() + at.moment + (at.poses[0].linear() * world.com[0]).cross(weight)).norm(),
      1e-9);
}

TEST(TrialWorld, AddsToTheVariablesOfCoupledJointsAndNotToTheirReadings) {
  const auto robot = robot_of(
      "robot: parallelogram\nkind: serial\ncoupling: [[1, 0], [-1, 1]]\nframes:\n"
      "  - {name: j1, joint: revolute, limits: [-3, 3]}\n"
      "  - {name: j2, joint: revolute, d: 0.5, limits: [-3, 3]}\n"
      "  - {name: tip, joint: fixed, d: 0.4}\n");
  const Eigen::VectorXd xi = values(*robot);
  const Eigen::Vector2d q(0.3, 0.8), shift(0.01, 0);
  // The second variable is the second reading less the first: j1 alone moves where both readings
  // do.
  const Eigen::Vector3d moved = tip_of(*robot, xi, q, nullptr, shift);
  EXPECT_LT((moved - tip_of(*robot, xi, q + Eigen::Vector2d(0.01, 0.01), nullptr)).norm(), 1e-12);
  EXPECT_GT((moved - tip_of(*robot, xi, q + shift, nullptr)).norm(), 1e-3);
}

TEST(TrialMachine, TakesAnotherLawOfAnEffectWhereItIsGivenOne) {
  TrialRequest asked = request("joint_coupling", 1.5, false);
  const auto law = [](const TrialWorld&, Random&) -> TrialCause {
    return {.where = {"elsewhere"}, .act = [](const Instant& at, Deviation& out) {
              out.joints[0] += 1e-4 * at.q[1] * at.q[2];
            }};
  };
  asked.laws = {{"joint_coupling", law}};
  const MadeTrial made = make_trial(asked);
  ASSERT_EQ(made.unreached, "");
  EXPECT_EQ(made.truth.where.at("joint_coupling"), std::vector<std::string>{"elsewhere"});
  EXPECT_NEAR(made.visible, 1.5, 0.01);
}

TEST(TrialMachine, LeavesItsNoiseAloneWhereThereIsNoCause) {
  const MadeTrial made = make_trial(request("none", 0, true));
  ASSERT_TRUE(made.unreached.empty()) << made.unreached;
  Options options;
  options.free = {"K*"};
  const Solution solution = identify(*made.robot, made.data, options);
  for (const SetResult& set : solution.sets)
    // Encoder steps of up to 1e-5 rad at a metre add to it; 3 sigma of 25 rows and more.
    EXPECT_NEAR(set.noise_sigma, made.truth.noise, 0.5 * made.truth.noise) << set.name;
}

}  // namespace
}  // namespace selfcal
