// Planned touches lie where they should, and the ways between them are free.
#include "constraints/touch_plan.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "constraints/equations.h"
#include "kinematics/linear_algebra.h"
#include "tests/sim/pretend.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

const Eigen::VectorXd kXi = values(rx90());

Eigen::VectorXd home() { return (Eigen::VectorXd(6) << 0.0, -0.6, 0.9, 0.0, 1.2, 0.0).finished(); }

Location located(const Eigen::VectorXd& q) {
  ConfigurationBlock block{q.transpose().replicate(kLanes, 1).array(), 1};
  Locations X;
  rx90().locate(block, kXi, Body::endpoint, X, nullptr);
  return {X.R(0), X.p(0)};
}

Set set_of(const std::string& name, const std::string& method) {
  Problems none;
  Node entry = Node::map();
  entry.set("method", Node::of(method));
  return make_set(name, entry, none);
}

/// Planes and sockets around the robot.
struct Cell {
  std::vector<Set> sets;
  std::vector<TouchTarget> targets;
  std::vector<Obstacle> obstacles;
  TouchPlanOptions options;
  Cell() { options.home = home(); }

  Cell& plane(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double radius,
              int touches) {
    TouchTarget target;
    target.set = static_cast<int>(sets.size());
    target.touches = touches;
    target.outward = normal.normalized();
    target.own = (Eigen::VectorXd(4) << target.outward, target.outward.dot(point)).finished();
    target.within = {point, radius};
    sets.push_back(set_of("plane" + std::to_string(sets.size()), "plane"));
    target.obstacle = static_cast<int>(obstacles.size());
    targets.push_back(target);
    obstacles.push_back({point, target.outward, target.within});
    return *this;
  }
  Cell& sockets(const std::string& method, const std::vector<Location>& places, int touches) {
    TouchTarget target;
    target.set = static_cast<int>(sets.size());
    target.touches = touches;
    target.outward = Eigen::Vector3d::UnitZ();
    target.places = places;
    sets.push_back(set_of("nests", method));
    targets.push_back(target);
    return *this;
  }
  TouchPlan plan() const { return plan_touches(rx90(), kXi, sets, targets, obstacles, options); }
};

Cell table_and_wall(int touches = 12) {
  Cell cell;
  cell.plane({0.75, 0, 0.15}, {0, 0, 1}, 0.25, touches);
  cell.plane({0, 0.9, 0.7}, {0.1, -1, 0}, 0.25, touches);
  return cell;
}

// Newton steps end when the residual is below the 1e-9 m that contact.cc calls met.
constexpr double kMet = 1e-8;

TEST(TouchPlan, TouchesItsPlanesWithinPatchLimitsAndTilt) {
  const Cell cell = table_and_wall();
  const TouchPlan plan = cell.plan();
  EXPECT_EQ(plan.unreached, "");
  ASSERT_EQ(plan.touches.size(), 24u);
  for (const PlannedTouch& each : plan.touches) {
    const Obstacle& plane = cell.obstacles[each.set];
    const Location X = located(each.touch);
    EXPECT_NEAR(plane.outward.dot(X.p - plane.point), 0, kMet);
    EXPECT_LE((X.p - plane.within.centre).norm(), plane.within.radius + kMet);
    EXPECT_LE(std::acos(X.R.col(2).dot(-plane.outward)), cell.options.tilt + kMet);
    for (const Eigen::VectorXd& q : {each.start, each.end})
      for (Eigen::Index j = 0; j < 6; ++j) {
        const Joint& joint = rx90().joints()[j];
        EXPECT_GE(q[j], joint.lower + cell.options.limit_margin);
        EXPECT_LE(q[j], joint.upper - cell.options.limit_margin);
      }
  }
}

TEST(TouchPlan, BeginsItsClearanceBeforeTheSurfaceAndGivesUpItsSearchBehindIt) {
  const Cell cell = table_and_wall();
  for (const PlannedTouch& each : cell.plan().touches) {
    const Obstacle& plane = cell.obstacles[each.set];
    const auto height = [&](const Eigen::VectorXd& q) {
      return plane.outward.dot(located(q).p - plane.point);
    };
    EXPECT_NEAR(height(each.start), cell.options.clearance, kMet);
    EXPECT_NEAR(height(each.end), -cell.options.search, kMet);
    // The joint path in is straight: it passes the planned place by what it is bent, at most an
    // eighth of way^2 over the arm's length about 1 m, 2e-4 m, and joints of opposite turns.
    double nearest = HUGE_VAL;
    for (int i = 0; i <= 1000; ++i)
      nearest = std::min(nearest, (located(each.start + i * 1e-3 * (each.end - each.start)).p -
                                   located(each.touch).p)
                                      .norm());
    EXPECT_LT(nearest, 2e-3);
  }
}

TEST(TouchPlan, ChoosesWaysThatAreFree) {
  const Cell cell = table_and_wall();
  const TouchPlan plan = cell.plan();
  const auto free = [&](const Eigen::VectorXd& from, const Eigen::VectorXd& to, int touched = -1) {
    return path_is_free(rx90(), kXi, from, to, cell.obstacles, cell.options.apart, touched);
  };
  Eigen::VectorXd here = home();
  for (const PlannedTouch& each : plan.touches) {
    if (each.via_home) {
      EXPECT_TRUE(free(here, home()) && free(home(), each.start));
    } else {
      EXPECT_TRUE(free(here, each.start));
    }
    EXPECT_TRUE(free(home(), each.start)) << "every touch can be begun at home";
    EXPECT_TRUE(free(each.start, each.end, each.set));
    here = each.start;
  }
}

TEST(TouchPlan, FinishesASetBeforeItBeginsTheNext) {
  int changes = 0, last = -1;
  for (const PlannedTouch& each : table_and_wall().plan().touches) {
    changes += each.set != last;
    last = each.set;
  }
  EXPECT_EQ(changes, 2);
}

TEST(TouchPlan, KeepsTheShareOfEverySetAsideToJudge) {
  Cell cell = table_and_wall(20);
  cell.options.check = 0.3;
  std::map<int, int> checks;
  for (const PlannedTouch& each : cell.plan().touches) checks[each.set] += each.check;
  EXPECT_EQ(checks[0], 6);
  EXPECT_EQ(checks[1], 6);
}

TEST(TouchPlan, IsTheSameForTheSameSeedAndAnotherForAnother) {
  Cell cell = table_and_wall(6);
  const TouchPlan one = cell.plan(), again = cell.plan();
  cell.options.seed = 2;
  const TouchPlan other = cell.plan();
  ASSERT_EQ(one.touches.size(), again.touches.size());
  for (std::size_t i = 0; i < one.touches.size(); ++i)
    EXPECT_EQ(one.touches[i].touch, again.touches[i].touch);
  EXPECT_NE(one.touches[0].touch, other.touches[0].touch);
}

/// log det of what rows at these readings and the priors say of the robot and the plane.
double information(const Cell& cell, const std::vector<Eigen::VectorXd>& rows) {
  DataSet data;
  data.sets = cell.sets;
  const auto count = static_cast<Eigen::Index>(rows.size());
  data.rows.q.resize(count, 6);
  for (Eigen::Index row = 0; row < count; ++row) data.rows.q.row(row) = rows[row].transpose();
  data.rows.set.assign(rows.size(), 0);
  data.rows.group.assign(rows.size(), -1);
  data.rows.check.assign(rows.size(), 0);
  const Equations equations(rx90(), data, Use::fit);
  State state;
  state.xi = kXi;
  equations.start(state);
  Weighting weighting;
  weighting.scale = {{2e-5, 1}};
  weighting.put_aside.assign(rows.size(), 0);
  const Eigen::MatrixXd R = equations.linearise(state, weighting).R;
  const Eigen::Index columns = equations.columns();
  Eigen::MatrixXd A = R.leftCols(columns).transpose() * R.leftCols(columns);
  for (Eigen::Index i = 0; i < columns; ++i) {
    const bool own = i >= equations.robot_columns();
    const Parameter* each = own ? nullptr : &rx90().parameters()[i];
    const double sigma = own ? 1 : each->free ? each->tolerance : 1e-9;
    A(i, i) += 1 / (sigma * sigma);
  }
  return symmetric_eigen(A).values.array().max(1e-12).log().sum();
}

TEST(TouchPlan, TellsMoreThanTouchesByChanceDo) {
  constexpr int kTouches = 20;
  Cell cell;
  cell.plane({0.75, 0, 0.15}, {0, 0, 1}, 0.25, kTouches);
  std::vector<Eigen::VectorXd> planned;
  for (const PlannedTouch& each : cell.plan().touches) planned.push_back(each.touch);
  double best_by_chance = -HUGE_VAL;
  for (unsigned seed = 1; seed <= 9; ++seed) {
    Random random(seed);
    DataSet data;
    data.sets = cell.sets;
    SampleRequest request;
    request.rows = kTouches;
    request.own = cell.targets[0].own;
    request.patch = cell.targets[0].within;
    sample_rows(rx90(), kXi, {request}, random, data);
    std::vector<Eigen::VectorXd> rows;
    for (int row = 0; row < data.rows.rows(); ++row)
      rows.push_back(data.rows.q.row(row).transpose());
    best_by_chance = std::max(best_by_chance, information(cell, rows));
  }
  // Those by chance may lie anywhere on the plane; the planned ones must be reached from home.
  EXPECT_GT(information(cell, planned), best_by_chance);
}

TEST(TouchPlan, TouchesBothOfTwoParallelFaces) {
  Cell cell;
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 0, 0.2).normalized();
  const Eigen::Vector3d near(-0.60, -0.18, 0.6);
  const Eigen::Vector3d far(-0.796, 0.18, 0.561);
  cell.plane(near, normal, 0.12, 8).plane(far, normal, 0.12, 8);
  cell.sets[1].reference = 0;  // its normal is the other's: the plan takes the nominal one
  const TouchPlan plan = cell.plan();
  EXPECT_EQ(plan.unreached, "");
  std::map<int, int> count;
  for (const PlannedTouch& each : plan.touches) {
    const Eigen::Vector3d p = located(each.touch).p;
    EXPECT_NEAR(normal.dot(p - (each.set == 0 ? near : far)), 0, kMet);
    ++count[each.set];
  }
  EXPECT_EQ(count[0], 8);
  EXPECT_EQ(count[1], 8);
}

TEST(TouchPlan, VisitsEverySocketAndComesInFromItsWayOut) {
  Cell cell;
  const std::vector<Location> places = {{Eigen::Matrix3d::Identity(), {0.7, 0.1, 0.3}},
                                        {Eigen::Matrix3d::Identity(), {0.6, -0.2, 0.3}},
                                        {Eigen::Matrix3d::Identity(), {0.5, 0.3, 0.35}}};
  cell.sockets("position-constraint", places, 12);
  const TouchPlan plan = cell.plan();
  EXPECT_EQ(plan.unreached, "");
  std::map<int, int> count;
  for (const PlannedTouch& each : plan.touches) {
    ASSERT_GE(each.group, 0);
    ASSERT_LT(each.group, 3);
    ++count[each.group];
    const Eigen::Vector3d place = places[each.group].p;
    EXPECT_LT((located(each.touch).p - place).norm(), kMet);
    EXPECT_EQ(each.end, each.touch);
    // As far as the clearance; the way is that of the tool's axes, which turn by the clearance over
    // the shortest lever from a joint to the endpoint, about 0.3 m.
    const Eigen::Vector3d way = located(each.start).p - place;
    EXPECT_NEAR(way.norm(), cell.options.clearance, kMet);
    EXPECT_LT(std::acos(way.normalized().z()), cell.options.clearance / 0.3);
  }
  for (int group = 0; group < 3; ++group) EXPECT_EQ(count[group], 4);
}

TEST(TouchPlan, SitsInANestAsItIsTurned) {
  Cell cell;
  cell.options.tilt = 3.2;
  Location nest = located(home());
  nest.p.z() -= 0.05;
  cell.sockets("location-constraint", {nest}, 6);
  const TouchPlan plan = cell.plan();
  ASSERT_GT(plan.touches.size(), 0u);
  for (const PlannedTouch& each : plan.touches) {
    const Location X = located(each.touch);
    EXPECT_LT((X.p - nest.p).norm(), kMet);
    EXPECT_LT((X.R - nest.R).norm(), kMet);
  }
}

TEST(TouchPlan, SaysWhichSetIsOutOfReach) {
  Cell cell;
  cell.plane({0.75, 0, 0.15}, {0, 0, 1}, 0.25, 4);
  cell.plane({5, 0, 0.15}, {0, 0, 1}, 0.25, 4);
  const TouchPlan plan = cell.plan();
  EXPECT_THAT(plan.unreached, HasSubstr("set plane1: only 0 of 4"));
  EXPECT_EQ(plan.touches.size(), 4u);
}

// -------------------------------------------------------------------------------- ways

TEST(PathIsFree, KeepsOutOfTheHalfBallBehindASurface) {
  const Eigen::VectorXd q = home();
  const Eigen::Vector3d p = located(q).p, up = Eigen::Vector3d::UnitZ();
  const auto free = [&](const Eigen::Vector3d& point, double radius, double apart,
                        int touched = -1) {
    return path_is_free(rx90(), kXi, q, q, {{point, up, {point, radius}}}, apart, touched);
  };
  EXPECT_TRUE(free(p - 0.10 * up, 0.5, 0.05));
  EXPECT_FALSE(free(p - 0.04 * up, 0.5, 0.05)) << "too near";
  EXPECT_FALSE(free(p + 0.10 * up, 0.5, 0.05)) << "behind it";
  EXPECT_TRUE(free(p + 0.10 * up, 0.04, 0.05)) << "out of its ball";
  EXPECT_FALSE(free(p + 0.10 * up, 0.06, 0.05)) << "the ball and what is kept from it";
  EXPECT_FALSE(free(p + 10 * up, 0, 0)) << "a surface without an end";
  EXPECT_TRUE(free(p + 0.10 * up, 0.5, 0.05, 0)) << "the one that is touched";
}

TEST(PathIsFree, SeesWhatLiesBetweenTheEnds) {
  Eigen::VectorXd from = home(), to = home();
  from[0] = -1;
  to[0] = 1;
  const Eigen::Vector3d middle = located(home()).p;
  const Obstacle post{
      middle + Eigen::Vector3d(0, 0, 0.1), Eigen::Vector3d::UnitZ(), {middle, 0.15}};
  EXPECT_TRUE(path_is_free(rx90(), kXi, from, from, {post}, 0.01));
  EXPECT_TRUE(path_is_free(rx90(), kXi, to, to, {post}, 0.01));
  EXPECT_FALSE(path_is_free(rx90(), kXi, from, to, {post}, 0.01));
  EXPECT_TRUE(path_is_free(rx90(), kXi, from, to, {}, 0.01));
}

}  // namespace
}  // namespace selfcal
