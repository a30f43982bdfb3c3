// Plans that must not depend on a robot's size: the same configurations, touches and ways; and rows
// without noise, which tell as much.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <random>

#include "constraints/planning/configuration_plan.h"
#include "constraints/planning/other_approach.h"
#include "constraints/planning/touch_plan.h"
#include "constraints/sampling/random_poses.h"
#include "kinematics/readable.h"
#include "tests/recovery/session.h"
#include "tests/support/arm_of_size.h"

namespace selfcal {
namespace {

constexpr std::array kTenthAndTenfold{0.1, 10.0};
constexpr double kRounded = 1e-9;       // relative
constexpr double kRoundedAlike = 1e-6;  // relative: rounding, times what the equations magnify

Set sized_set(const std::string& method, double noise) {
  Problems problems;
  Node entries = Node::map();
  entries.set("rows", recovery::entry(
                          {{"method", method.c_str()}, {"noise", format_number(noise).c_str()}}));
  return read_sets(entries, problems).front();
}

ConfigurationPlan planned(const std::string& method, double k, unsigned long long seed) {
  const auto robot = arm_of_size(k);
  PlanRequest request;
  request.pool.sets = {sized_set(method, 2e-5 * k)};
  request.pool.candidates = 120;
  request.count = 20;
  request.pool.seed = seed;
  request.speed.setOnes(static_cast<Eigen::Index>(robot->joints().size()));
  return plan_configurations(*robot, values(*robot), request);
}

// Powers of two, which round alike: of two choices that are as good rounding would take either.
TEST(AnySize, IsMeasuredAtTheSameConfigurations) {
  for (const char* method : {"position", "plane"})
    for (const unsigned long long seed : {1, 2, 3}) {
      const ConfigurationPlan one = planned(method, 1, seed);
      ASSERT_EQ(one.problem, "") << method;
      for (const double k : {0.125, 8.0}) {
        SCOPED_TRACE(std::string(method) + " of seed " + std::to_string(seed) + " times " +
                     std::to_string(k));
        const ConfigurationPlan other = planned(method, k, seed);
        EXPECT_EQ(other.parameters, one.parameters);
        EXPECT_NEAR(other.planned.sigma / k, one.planned.sigma, kRounded * one.planned.sigma);
        EXPECT_NEAR(other.sigma_beyond / k, one.sigma_beyond, kRounded * one.planned.sigma);
        ASSERT_EQ(other.data.rows.q.rows(), one.data.rows.q.rows());
        EXPECT_LT((other.data.rows.q - one.data.rows.q).cwiseAbs().maxCoeff(), kRounded);
      }
    }
}

/// A table and a wall before the arm of size `k`, and what is asked of them.
struct SizedCell {
  std::shared_ptr<const Robot> robot;
  Eigen::VectorXd xi;
  std::vector<Set> sets;
  std::vector<TouchTarget> targets;
  std::vector<Obstacle> obstacles;
  TouchPlanOptions options;

  /// At `home` the tip is `above` the table (m, of a robot of 1 m).
  SizedCell(std::shared_ptr<const Robot> machine, Eigen::VectorXd home, double above, double k)
      : robot(std::move(machine)), xi(values(*robot)) {
    options.clearance *= k;
    options.slow *= k;
    options.search *= k;
    options.apart = 0;
    options.touch_speed *= k;
    options.home = std::move(home);
    const Eigen::Vector3d tip = locate(*robot, xi, options.home).p;
    plane(tip - above * k * Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ(), k);
    plane(tip + 0.3 * k * Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitX(), k);
  }

  void plane(const Eigen::Vector3d& point, const Eigen::Vector3d& outward, double k) {
    TouchTarget target;
    target.set = static_cast<int>(sets.size());
    target.touches = 8;
    target.outward = outward;
    target.plane = Plane{outward, outward.dot(point)};
    target.within = {point, 0.25 * k};
    target.obstacle = target.set;
    sets.push_back(sized_set("plane", 2e-5 * k));
    targets.push_back(target);
    obstacles.push_back({point, outward, target.within});
  }
};

SizedCell arm_cell(double k) {
  return {arm_of_size(k), (Eigen::VectorXd(6) << 0, -0.6, 0.9, 0, 1.2, 0).finished(), 0.25, k};
}

TEST(AnySize, IsPlannedTheSameTouchesAndWays) {
  const auto touches = [](double k) {
    const SizedCell cell = arm_cell(k);
    const TouchPlan plan = plan_touches(*cell.robot, cell.xi, cell.sets, cell.targets,
                                        cell.obstacles, {}, cell.options);
    EXPECT_EQ(plan.unreached, "") << k;
    return plan.touches;
  };
  const std::vector<PlannedTouch> one = touches(1);
  ASSERT_FALSE(one.empty());
  for (const double k : kTenthAndTenfold) {
    const std::vector<PlannedTouch> other = touches(k);
    ASSERT_EQ(other.size(), one.size()) << k;
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(other[i].set, one[i].set) << k << " " << i;
      EXPECT_EQ(other[i].via_home, one[i].via_home) << k << " " << i;
      EXPECT_LT((other[i].touch - one[i].touch).cwiseAbs().maxCoeff(), kRoundedAlike)
          << k << " " << i;
      EXPECT_LT((other[i].outside - one[i].outside).cwiseAbs().maxCoeff(), kRoundedAlike)
          << k << " " << i;
    }
  }
}

/// Ways into a contact of the delta of size `k` with its bed.
std::vector<PlannedTouch> other_ways(double k) {
  const std::shared_ptr<const Robot> robot = delta_of_size(k);
  SizedCell cell(robot, Eigen::Vector3d::Constant(-0.2 * k), 0.08, k);
  cell.targets.pop_back();
  cell.obstacles.pop_back();
  cell.options.clearance /= 10;
  cell.options.slow /= 10;
  cell.options.search /= 10;
  Random random(2);
  const TouchCandidates candidates(*robot, cell.xi, cell.sets, cell.obstacles, cell.options);
  std::vector<PlannedTouch> list;
  const auto usable = usable_touches(candidates, cell.targets, random);
  for (const PlannedTouch& touch : usable.front())
    std::ranges::move(other_approaches(*robot, cell.xi, cell.targets.front(), cell.obstacles,
                                       cell.options, touch, 2, random),
                      std::back_inserter(list));
  return list;
}

TEST(AnySize, HasTheSameWaysIntoAContact) {
  const std::vector<PlannedTouch> one = other_ways(1);
  ASSERT_FALSE(one.empty());
  for (const double k : {1e-3, 10.0}) {
    const std::vector<PlannedTouch> other = other_ways(k);
    ASSERT_EQ(other.size(), one.size()) << k;
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_LT((other[i].start / k - one[i].start).cwiseAbs().maxCoeff(), kRoundedAlike) << k;
      EXPECT_LT((other[i].end / k - one[i].end).cwiseAbs().maxCoeff(), kRoundedAlike) << k;
    }
  }
}

/// What exact locations tell of the arm of size `k`.
Solution told_without_noise(double k) {
  const auto usual = arm_of_size(1);
  Random random(6);
  std::normal_distribution<double> normal;
  Eigen::VectorXd truth = nominal_values(*usual);
  for (Eigen::Index i = 0; i < truth.size(); ++i)
    if (usual->parameters()[static_cast<std::size_t>(i)].free) truth[i] += 1e-3 * normal(random);
  const Node set = recovery::entry({{"method", "location"}});
  DataSet data = recovery::make_session(*usual, truth, {{"rows", set, 60}}, 0, random).data;
  data.rows.position *= k;
  data.target *= k;
  return identify(*arm_of_size(k), data);
}

TEST(AnySize, IsToldAsMuchByRowsWithoutNoise) {
  const Solution one = told_without_noise(1);
  for (const double k : kTenthAndTenfold) {
    const Solution other = told_without_noise(k);
    ASSERT_EQ(other.sets.size(), one.sets.size());
    EXPECT_NEAR(other.sets[0].noise_sigma / k, one.sets[0].noise_sigma,
                kRoundedAlike * one.sets[0].noise_sigma)
        << k;
    // What halves of rows that fit exactly differ by is rounding.
    EXPECT_NEAR(other.endpoint.median / k, one.endpoint.median, 0.3 * one.endpoint.median) << k;
  }
}

}  // namespace
}  // namespace selfcal
