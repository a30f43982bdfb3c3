// A robot of a tenth of the size and one of ten times it, measured with a tenth and ten times the
// noise: the same answer in their own measure.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "constraints/estimation/identification.h"
#include "diagnosis/diagnosis.h"
#include "io/files/robot_file.h"
#include "tests/recovery/session.h"
#include "tests/support/arm_of_size.h"

namespace selfcal::recovery {
namespace {

std::vector<SetPart> sets_of_size(double scale, bool touches, double noise_of_one = 20e-6) {
  const std::string noise = format_number(noise_of_one * scale);
  if (!touches)
    return {{"tracker",
             entry({{"method", "position"}, {"frame", "unknown"}, {"noise", noise.c_str()}}), 90}};
  std::vector<SetPart> parts;
  for (const char* name : {"a", "b", "c", "d"})
    parts.push_back({name, entry({{"method", "plane"}, {"noise", noise.c_str()}}), 60});
  Node gauge = entry({{"method", "plane"}, {"noise", noise.c_str()}});
  gauge.set("parallel_to", entry({{"set", "a"},
                                  {"distance", format_number(0.2 * scale).c_str()},
                                  {"noise", format_number(2e-6 * scale).c_str()}}));
  parts.push_back({"gauge", gauge, 60});
  return parts;
}

/// The same session of a robot `scale` times as large.
DataSet of_size(DataSet data, double scale, const std::vector<SetPart>& parts) {
  Problems problems;
  Node entries = Node::map();
  for (const SetPart& part : parts) entries.set(part.name, part.node);
  const std::vector<Set> sets = read_sets(entries, problems);
  for (size_t s = 0; s < sets.size(); ++s) {
    const auto groups = data.sets[s].groups;
    data.sets[s] = sets[s];
    data.sets[s].groups = groups;
  }
  data.rows.position *= scale;
  data.target *= scale;
  return data;
}

class Scaled : public testing::TestWithParam<bool> {};

TEST_P(Scaled, RobotsOfTenCentimetresAndTenMetresGetTheAnswerOfOneOfOneMetre) {
  const auto usual = arm_of_size(1);
  Random random(7);
  std::normal_distribution<double> normal;
  Eigen::VectorXd truth = nominal_values(*usual);
  for (Eigen::Index i = 0; i < truth.size(); ++i)
    if (usual->parameters()[i].free) truth[i] += 1e-3 * normal(random);
  const Session session = make_session(*usual, truth, sets_of_size(1, GetParam()), 20e-6, random);
  ASSERT_EQ(session.unreached, "");
  const Solution one = identify(*usual, session.data);
  ASSERT_EQ(one.verdict.answer, Answer::improved) << one.verdict.why;

  for (const double scale : {0.1, 10.0}) {
    const auto robot = arm_of_size(scale);
    const DataSet data = of_size(session.data, scale, sets_of_size(scale, GetParam()));
    const Solution other = identify(*robot, data);
    EXPECT_EQ(other.verdict.answer, one.verdict.answer) << other.verdict.why;
    EXPECT_EQ(other.outliers.size(), one.outliers.size());
    EXPECT_EQ(other.gauge.size(), one.gauge.size());
    EXPECT_NEAR(other.endpoint.median / scale, one.endpoint.median, 1e-6 * one.endpoint.median);
    EXPECT_NEAR(other.residual.check.rms_after / scale, one.residual.check.rms_after,
                1e-6 * one.residual.check.rms_after);
    for (size_t i = 0; i < one.parameters.size(); ++i) {
      const ParameterResult& a = one.parameters[i];
      const ParameterResult& b = other.parameters[i];
      const double unit = a.parameter.quantity == Quantity::length ? scale : 1;
      EXPECT_EQ(a.status, b.status) << a.parameter.name << " times " << scale;
      // Where the iteration ends: a ten-thousandth of a sigma.
      EXPECT_LE(std::abs(b.value / unit - a.value), 1e-4 * std::max(a.sigma, 1e-8))
          << a.parameter.name << " times " << scale;
    }
  }
}

// Rows so coarse that they hardly tell some lengths: which, does not hang on the robot's size.
TEST(ScaledRank, CoarseRowsTellTheSameParameters) {
  const auto usual = arm_of_size(1);
  constexpr double kCoarse = 3e-3;  // m
  Random random(7);
  const Session session = make_session(*usual, nominal_values(*usual),
                                       sets_of_size(1, false, kCoarse), kCoarse, random);
  const Solution one = identify(*usual, session.data);
  const auto told = [](const Solution& solution) {
    return std::ranges::count(solution.parameters, Status::identified, &ParameterResult::status);
  };
  const Session fine =
      make_session(*usual, nominal_values(*usual), sets_of_size(1, false), 20e-6, random);
  ASSERT_LT(told(one), told(identify(*usual, fine.data)));
  for (const double scale : {0.1, 10.0}) {
    const Solution other = identify(
        *arm_of_size(scale), of_size(session.data, scale, sets_of_size(scale, false, kCoarse)));
    for (std::size_t i = 0; i < one.parameters.size(); ++i)
      EXPECT_EQ(other.parameters[i].status, one.parameters[i].status)
          << one.parameters[i].parameter.name << " times " << scale;
  }
}

/// An arm with a sliding joint, all its lengths, tolerances and ways `k` times as long.
std::shared_ptr<const Robot> slider_of_size(double k) {
  const auto m = [&](double length) { return format_number(k * length); };
  const std::string believed = ", tolerance: {d: " + m(2e-3) + ", r: " + m(2e-3) + "}}\n";
  const std::string placed = ", tolerance: {d: " + m(50e-3) + ", r: " + m(50e-3) + "}}\n";
  auto robot = selfcal::robot_of(
      "robot: slider\nkind: serial\nframes:\n  - {name: base, joint: fixed, r: " + m(0.4) + placed +
          "  - {name: j1, joint: revolute, limits: [-2.5, 2.5]" + believed +
          "  - {name: j2, joint: revolute, alpha: -pi/2, d: " + m(0.15) + ", limits: [-1.5, 1.5]" +
          believed + "  - {name: j3, joint: prismatic, alpha: pi/2, r: " + m(0.5) + ", limits: [" +
          m(-0.1) + ", " + m(0.3) + "]" + believed +
          "  - {name: j4, joint: revolute, r: " + m(0.1) + ", limits: [-3, 3]" + believed +
          "  - {name: j5, joint: revolute, alpha: pi/2, limits: [-2, 2]" + believed +
          "  - {name: tool, joint: fixed, d: " + m(0.15) + ", r: " + m(0.12) + placed,
      "machine");
  EXPECT_TRUE(robot.has_value()) << robot.error().what;
  return std::move(*robot);
}

/// A session drawn anew on the machine of size `k`, and what is made of it.
struct Measured {
  Solution solution;
  Diagnosis diagnosis;
};
Measured measured(std::string_view kind, double k) {
  const std::shared_ptr<const Robot> robot =
      kind == "slider" ? slider_of_size(k) : delta_of_size(k);
  Random random(11);
  std::normal_distribution<double> normal;
  Eigen::VectorXd truth = nominal_values(*robot);
  for (Eigen::Index i = 0; i < truth.size(); ++i) {
    const Parameter& p = robot->parameters()[static_cast<size_t>(i)];
    const double moved = 1e-3 * normal(random);
    if (p.free) truth[i] += (p.quantity == Quantity::length ? k : 1) * moved;
  }
  const std::string noise = format_number(20e-6 * k);
  const Session session = make_session(
      *robot, truth, {{"tracker", entry({{"method", "position"}, {"noise", noise.c_str()}}), 120}},
      20e-6 * k, random);
  EXPECT_EQ(session.unreached, "") << kind << " times " << k;
  DataSet data = session.data;
  data.target *= k;
  DiagnosisOptions options;
  options.resamples = 39;
  options.simulated_sessions = 0;
  return {identify(*robot, data), diagnose(robot, data, options)};
}

/// A session of the arm of size `k` whose second joint's encoder sits off its axis.
Diagnosis diagnosed(double k) {
  const std::shared_ptr<const Robot> nominal = arm_of_size(k);
  const auto machine = selfcal::robot_of(
      robot_text(*nominal, values(*nominal)) +
          "effects: [{effect: transmission_error, at: j2, sin1: 4.0e-4, cos1: 2.0e-4}]\n",
      "machine");
  EXPECT_TRUE(machine.has_value()) << machine.error().what;
  Random random(13);
  const std::string noise = format_number(20e-6 * k);
  Session session =
      make_session(**machine, values(**machine),
                   {{"tracker", entry({{"method", "position"}, {"noise", noise.c_str()}}), 180}},
                   20e-6 * k, random);
  EXPECT_EQ(session.unreached, "") << k;
  session.data.target *= k;
  DiagnosisOptions options;
  options.resamples = 99;
  options.simulated_sessions = 0;
  return diagnose(nominal, session.data, options);
}

TEST(CauseOfAnySize, IsNamedAtItsPlaceAndClosesAsMuch) {
  const Diagnosis one = diagnosed(1);
  ASSERT_EQ(one.verdict.effect, "transmission_error") << one.why;
  for (const double k : {0.1, 10.0}) {
    const Diagnosis other = diagnosed(k);
    EXPECT_EQ(other.verdict.effect, one.verdict.effect) << k << ": " << other.why;
    EXPECT_EQ(other.verdict.where, one.verdict.where) << k;
    EXPECT_EQ(other.verdict.confounded_with, one.verdict.confounded_with) << k;
    // Configurations are rounded in another way: a thousandth of the figure.
    EXPECT_NEAR(other.verdict.probability, one.verdict.probability, 1e-3) << k;
    ASSERT_EQ(other.verdict.parameters.size(), one.verdict.parameters.size()) << k;
    for (std::size_t i = 0; i < one.verdict.parameters.size(); ++i)
      EXPECT_NEAR(other.verdict.parameters[i].value, one.verdict.parameters[i].value,
                  1e-3 * std::abs(one.verdict.parameters[i].value))
          << k;
    EXPECT_NEAR(other.gap.rms_after / k, one.gap.rms_after, 1e-3 * one.gap.rms_after) << k;
  }
}

class Measure : public testing::TestWithParam<const char*> {};

TEST_P(Measure, IsThatOfTheRobotItselfInRowsAnswersAndCauses) {
  const Measured one = measured(GetParam(), 1);
  ASSERT_EQ(one.solution.verdict.answer, Answer::improved) << one.solution.verdict.why;
  ASSERT_EQ(one.diagnosis.verdict.effect, "none");
  for (const double k : {0.1, 10.0}) {
    const Measured other = measured(GetParam(), k);
    EXPECT_EQ(other.solution.verdict.answer, one.solution.verdict.answer)
        << other.solution.verdict.why;
    EXPECT_EQ(other.diagnosis.verdict.effect, one.diagnosis.verdict.effect);
    EXPECT_NEAR(other.diagnosis.verdict.probability, one.diagnosis.verdict.probability, 0.02);
    // Configurations are drawn anew and rounded in another way: a thousandth of the figure.
    EXPECT_NEAR(other.solution.endpoint.median / k, one.solution.endpoint.median,
                1e-3 * one.solution.endpoint.median);
    EXPECT_NEAR(other.solution.residual.check.rms_after / k, one.solution.residual.check.rms_after,
                1e-3 * one.solution.residual.check.rms_after);
    EXPECT_NEAR(other.diagnosis.gap.rms_before / k, one.diagnosis.gap.rms_before,
                1e-3 * one.diagnosis.gap.rms_before);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Measure, testing::Values("slider", "linear-delta"),
                         [](const auto& each) {
                           return std::string(each.param) == "slider" ? "ArmWithASlidingJoint"
                                                                      : "LinearDelta";
                         });

INSTANTIATE_TEST_SUITE_P(Rows, Scaled, testing::Bool(), [](const auto& each) {
  return each.param ? "TouchesOfPlanes" : "PositionsOfATracker";
});

}  // namespace
}  // namespace selfcal::recovery
