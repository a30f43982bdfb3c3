// A robot of a tenth of the size and one of ten times it, measured with a tenth and ten times the
// noise: the same answer in their own measure.
#include <gtest/gtest.h>

#include <cmath>

#include "constraints/estimation/identification.h"
#include "io/files/robot_file.h"
#include "tests/recovery/session.h"

namespace selfcal::recovery {
namespace {

/// A six-axis arm whose lengths and their tolerances are `scale` times those of a robot of 1 m.
std::unique_ptr<Robot> arm_of_size(double scale) {
  const auto length = [&](double m) { return format_number(scale * m); };
  const auto believed = [&](double m) {
    return ", tolerance: {d: " + length(m) + ", r: " + length(m) + "}}\n";
  };
  auto robot = selfcal::robot_of(
      "robot: arm\nkind: serial\nframes:\n"
      "  - {name: base, joint: fixed, theta: pi/2, r: " +
          length(0.5) + believed(50e-3) +
          "  - {name: j1, joint: revolute, alpha: 0.1, limits: [-2.79, 2.79]" + believed(2e-3) +
          "  - {name: j2, joint: revolute, alpha: -pi/2, limits: [-2.4, 2.4]" + believed(2e-3) +
          "  - {name: j3, joint: revolute, d: " + length(0.5) + ", limits: [-2.5, 2.5]" +
          believed(2e-3) + "  - {name: j4, joint: revolute, alpha: pi/2, r: " + length(0.5) +
          ", limits: [-4.7, 4.7]" + believed(2e-3) +
          "  - {name: j5, joint: revolute, alpha: -pi/2, limits: [-1.8, 2.1]" + believed(2e-3) +
          "  - {name: j6, joint: revolute, alpha: pi/2, r: " + length(0.3) +
          ", limits: [-4.7, 4.7]" + believed(2e-3) +
          "  - {name: tool, joint: fixed, alpha: 1.3, d: " + length(0.2) +
          ", theta: pi/2, r: " + length(0.1) + believed(50e-3),
      "arm");
  EXPECT_TRUE(robot.has_value()) << robot.error().what;
  return std::move(*robot);
}

std::vector<SetPart> sets_of_size(double scale, bool touches) {
  const std::string noise = format_number(20e-6 * scale);
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
    DataSet data = session.data;
    Problems problems;
    Node entries = Node::map();
    for (const SetPart& part : sets_of_size(scale, GetParam())) entries.set(part.name, part.node);
    const std::vector<Set> sets = read_sets(entries, problems);
    for (size_t s = 0; s < sets.size(); ++s) {
      const auto groups = data.sets[s].groups;
      data.sets[s] = sets[s];
      data.sets[s].groups = groups;
    }
    data.rows.position *= scale;
    data.target *= scale;
    const Solution other = identify(*robot, data);
    EXPECT_EQ(other.verdict.answer, one.verdict.answer) << other.verdict.why;
    EXPECT_EQ(other.rejected.size(), one.rejected.size());
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

INSTANTIATE_TEST_SUITE_P(Rows, Scaled, testing::Bool(), [](const auto& each) {
  return each.param ? "TouchesOfPlanes" : "PositionsOfATracker";
});

}  // namespace
}  // namespace selfcal::recovery
