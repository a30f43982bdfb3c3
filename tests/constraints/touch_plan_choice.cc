// Planned touches tell more than others would.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "constraints/equations/equations.h"
#include "constraints/identifiability/endpoint_sigma.h"
#include "constraints/identifiability/given_doubt.h"
#include "constraints/planning/touch_choice.h"
#include "constraints/sampling/configurations.h"
#include "constraints/sampling/random_poses.h"
#include "kinematics/linear_algebra.h"
#include "tests/constraints/touch_plan_cell.h"

namespace selfcal {
namespace {

/// What rows at these readings, of set `set` each, and the priors say of the robot and the planes.
Eigen::MatrixXd information(const PlannedCell& cell, const std::vector<Eigen::VectorXd>& rows,
                            const std::vector<int>& set) {
  DataSet data;
  data.sets = cell.sets;
  const auto count = static_cast<Eigen::Index>(rows.size());
  data.rows.q.resize(count, 6);
  data.rows.normal.resize(count, 3);
  for (Eigen::Index row = 0; row < count; ++row) {
    data.rows.q.row(row) = rows[row].transpose();
    data.rows.normal.row(row) = cell.targets[set[row]].outward.transpose();
  }
  data.rows.set = set;
  data.rows.group.assign(rows.size(), -1);
  data.rows.check.assign(rows.size(), 0);
  const Equations equations(rx90(), data, Use::fit);
  State state;
  state.xi = values(rx90());
  equations.start(state);
  Weighting weighting;
  weighting.scale.assign(cell.sets.size(), {2e-5, 1});
  weighting.outlier.assign(rows.size(), 0);
  const Eigen::MatrixXd R = equations.linearise(state, weighting).R;
  const Eigen::Index columns = equations.columns();
  Eigen::MatrixXd A = R.leftCols(columns).transpose() * R.leftCols(columns);
  for (Eigen::Index i = 0; i < columns; ++i) {
    const bool nuisance = i >= equations.robot_columns();
    const Parameter* each = nuisance ? nullptr : &rx90().parameters()[i];
    const double sigma = nuisance     ? 1
                         : each->free ? each->tolerance
                                      : std::max(1e-9, doubt_of_fixed(*each));
    A(i, i) += 1 / (sigma * sigma);
  }
  return A;
}

/// Of the end position over all that the joints can do (m), once such rows are taken.
double sigma_after(const PlannedCell& cell, const std::vector<Eigen::VectorXd>& rows,
                   const std::vector<int>& set) {
  const auto parameters = static_cast<Eigen::Index>(rx90().parameters().size());
  EndpointQuestion question;
  question.robot = &rx90();
  question.xi = values(rx90());
  question.unseen = Eigen::MatrixXd::Identity(6, 6);
  question.point_unknown = true;
  question.poses = random_poses(rx90(), nullptr, 500, 1);
  const Eigen::MatrixXd C =
      inverse_of_positive(information(cell, rows, set)).topLeftCorner(parameters, parameters);
  return endpoint_sigma(endpoint_deviations(question), C).rms;
}

TEST(TouchPlan, TellsMoreThanTouchesByChanceDo) {
  constexpr int kTouches = 20;
  PlannedCell cell;
  cell.options.check = 0;
  cell.plane({0.75, 0, 0.15}, {0, 0, 1}, 0.25, kTouches);
  std::vector<Eigen::VectorXd> planned;
  for (const PlannedTouch& each : cell.plan().touches) planned.push_back(each.touch);
  double best_by_chance = HUGE_VAL;
  for (unsigned seed = 1; seed <= 9; ++seed) {
    Random random(seed);
    DataSet data;
    data.sets = cell.sets;
    SampleRequest request;
    request.rows = kTouches;
    request.nuisance = cell.sets[0].method->nuisance_of(*cell.targets[0].plane);
    request.patch = cell.targets[0].within;
    sample_rows(rx90(), values(rx90()), {request}, random, data);
    std::vector<Eigen::VectorXd> rows;
    for (int row = 0; row < data.rows.rows(); ++row)
      rows.push_back(data.rows.q.row(row).transpose());
    best_by_chance = std::min(best_by_chance, sigma_after(cell, rows, data.rows.set));
  }
  // Those by chance may lie anywhere on the plane; the planned ones must be reached from home.
  EXPECT_LT(sigma_after(cell, planned, std::vector<int>(planned.size())), best_by_chance);
}

TEST(TouchPlan, IdentifiesASurfaceWhereverItsOtherTouchesJudge) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    PlannedCell cell;
    cell.options.seed = seed;
    cell.options.check = 0.33;
    cell.plane({0.75, 0, 0.15}, {0, 0, 1}, 0.25, 9).plane({0, 0.9, 0.7}, {0.1, -1, 0}, 0.25, 9);
    cell.plane({0.9, 0.5, 0.4}, {-1, -0.4, 0.3}, 0.2, 9);
    const TouchPlan plan = cell.plan();
    for (int set = 0; set < 3; ++set) {
      std::vector<Eigen::Vector3d> points;
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (const PlannedTouch& each : plan.touches)
        if (each.set == set && !each.check) {
          points.push_back(located(each.touch).p);
          middle += points.back();
        }
      const auto count = static_cast<double>(points.size());
      ASSERT_GE(count, 6);
      Eigen::MatrixXd off(static_cast<Eigen::Index>(points.size()), 3);
      for (Eigen::Index i = 0; i < off.rows(); ++i)
        off.row(i) = (points[static_cast<std::size_t>(i)] - middle / count).transpose();
      const Eigen::VectorXd spread = singular_values(off).values;
      std::printf("seed %u, surface %d: touches spread by %.0f and %.0f mm\n", seed, set,
                  1e3 * spread[0] / std::sqrt(count), 1e3 * spread[1] / std::sqrt(count));
      // Off a line by less than this a touch elsewhere would judge the surface, not the robot.
      EXPECT_GT(spread[1], 0.1 * spread[0]);
    }
  }
}

TEST(TouchPlan, ExpectsOfOppositeFacesWhatTheEquationsFind) {
  PlannedCell cell;
  const Eigen::Vector3d normal(0, 1, 0);
  cell.plane({0.75, 0, 0.15}, {0, 0, 1}, 0.25, 20);
  cell.plane({0.70, 0.1, 0.5}, normal, 0.2, 20).plane({0.70, -0.1, 0.5}, -normal, 0.2, 20);
  Problems problems;
  Node entry = Node::map();
  entry.set("method", Node::of(std::string("plane")));
  Node step = Node::map();
  step.set("set", Node::of(cell.sets[1].name));
  step.set("distance", Node::of(0.2));
  step.set("noise", Node::of(1e-7));
  entry.set("parallel_to", std::move(step));
  cell.sets[2].method = make_set(cell.sets[2].name, entry, problems).method;
  cell.sets[2].reference = 1;
  ASSERT_FALSE(problems.any());
  cell.options.check = 0;
  const TouchPlan plan = cell.plan();
  ASSERT_EQ(plan.touches.size(), 60u);
  std::vector<Eigen::VectorXd> rows;
  std::vector<int> set;
  std::vector<PossibleTouch> touches;
  for (const PlannedTouch& each : plan.touches) {
    rows.push_back(each.touch);
    set.push_back(each.set);
    touches.push_back({each.touch, each.set, -1, cell.targets[each.set].outward});
  }
  const Eigen::MatrixXd exact = information(cell, rows, set).inverse();
  const Eigen::MatrixXd expected = covariance_after(rx90(), values(rx90()), cell.sets, touches);
  for (Eigen::Index i = 0; i < expected.rows(); ++i) {
    if (!rx90().parameters()[i].free) continue;
    EXPECT_NEAR(std::sqrt(expected(i, i) / exact(i, i)), 1, 1e-3) << rx90().parameters()[i].name;
  }
  // The block gives the scale: without its step the end position is known far worse.
  const ExpectedSigma with =
      expected_sigma(rx90(), values(rx90()), cell.sets, cell.targets, plan, {});
  cell.sets[2].reference = -1;
  const ExpectedSigma without =
      expected_sigma(rx90(), values(rx90()), cell.sets, cell.targets, plan, {});
  EXPECT_GT(without.endpoint.median, 3 * with.endpoint.median);
  EXPECT_GT(without.workspace.median, 3 * with.workspace.median);
  EXPECT_LT(with.workspace.rms, with.endpoint.rms);
}

TEST(TouchPlan, KnowsAPlaneThatIsGivenAsFarAsItIsBelieved) {
  PlannedCell cell = table_and_wall(20);
  cell.options.check = 0;
  const TouchPlan plan = cell.plan();
  std::vector<Eigen::VectorXd> rows;
  std::vector<int> set;
  std::vector<PossibleTouch> touches;
  for (const PlannedTouch& each : plan.touches) {
    rows.push_back(each.touch);
    set.push_back(each.set);
    touches.push_back({each.touch, each.set, -1, cell.targets[each.set].outward});
  }
  const auto expected = [&] {
    return covariance_after(rx90(), values(rx90()), cell.sets, touches);
  };
  const auto unseen = [&] {
    return unseen_by_touches(rx90(), values(rx90()), cell.sets, touches).cols();
  };
  const Eigen::MatrixXd unknown = expected();
  EXPECT_EQ(unseen(), 6);
  Problems problems;
  Node entry = Node::map();
  entry.set("method", Node::of(std::string("plane")));
  // a x + b y + c z + 1 = 0 of the table, z = 0.15 m
  entry.set("plane", Node::of(std::vector<double>{0, 0, -1 / 0.15}));
  cell.sets[0].method = make_set(cell.sets[0].name, entry, problems).method;
  ASSERT_FALSE(problems.any());
  EXPECT_EQ(unseen(), 3);  // a table places the robot's height and tilt
  cell.sets[0].given = {0, 0, 0};
  const Eigen::MatrixXd exact = information(cell, rows, set).inverse(), told = expected();
  cell.sets[0].given = {1e-3, 1e-3, 0};
  const Eigen::MatrixXd doubted = expected();
  double better = 0;
  for (Eigen::Index i = 0; i < told.rows(); ++i) {
    const Parameter& each = rx90().parameters()[i];
    if (!each.free) continue;
    EXPECT_NEAR(std::sqrt(told(i, i) / exact(i, i)), 1, 1e-3) << each.name;
    EXPECT_LE(told(i, i), 1.000001 * doubted(i, i)) << each.name;
    EXPECT_LE(doubted(i, i), 1.000001 * unknown(i, i)) << each.name;
    better = std::max(better, doubted(i, i) / told(i, i));
  }
  EXPECT_GT(better, 1.1);
}

TEST(TouchPlan, IsGivenUpWhileItsTouchesAreExchanged) {
  PlannedCell cell;
  cell.plane({0.75, 0, 0.15}, {0, 0, 1}, 0.3, 12).plane({1.05, 0, 0.8}, {-1, 0.1, 0}, 0.3, 12);
  struct GivenUp {};
  std::vector<std::string> stages;
  const Progress give_up = [&](std::string_view stage, double) {
    stages.emplace_back(stage);
    if (stage == "exchanging configurations") throw GivenUp();
  };
  EXPECT_THROW(plan_touches(rx90(), values(rx90()), cell.sets, cell.targets, cell.obstacles, {},
                            cell.options, give_up),
               GivenUp);
  EXPECT_EQ(stages.back(), "exchanging configurations");
}

TEST(TouchPlan, ChoosesWhatTellsMostBesideTheTouchesThatAreMade) {
  PlannedCell first = table_and_wall(10);
  first.options.check = 0;
  std::vector<Eigen::VectorXd> made;
  std::vector<int> set;
  std::vector<PossibleTouch> known;
  for (const PlannedTouch& each : first.plan().touches) {
    made.push_back(each.touch);
    set.push_back(each.set);
    known.push_back({each.touch, each.set, -1, first.targets[each.set].outward});
  }
  const auto together = [&](const TouchPlan& plan) {
    std::vector<Eigen::VectorXd> rows = made;
    std::vector<int> sets = set;
    for (const PlannedTouch& each : plan.touches) {
      rows.push_back(each.touch);
      sets.push_back(each.set);
    }
    return sigma_after(first, rows, sets);
  };
  PlannedCell next = table_and_wall(6);
  next.options.check = 0;
  next.options.seed = 2;
  const double alone = together(next.plan());
  next.options.known.made = known;
  const double beside = together(next.plan());
  std::printf(
      "%.4f mm after ten touches of two surfaces each, %.4f mm with six more chosen as if "
      "there were none, %.4f mm with six chosen beside them\n",
      1e3 * sigma_after(first, made, set), 1e3 * alone, 1e3 * beside);
  EXPECT_LT(beside, alone);
}

}  // namespace
}  // namespace selfcal
