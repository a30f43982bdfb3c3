// What a method says it can never see: the scale. Rows that hold are made smaller, robot and own
// unknowns alike; a method whose equations still hold must say so, or the identification would
// shrink the robot.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "kinematics/linear_algebra.h"
#include "tests/contracts/method_case.h"

namespace selfcal {
namespace {

constexpr double kScale = 0.5;
constexpr double kHolds = 1e-9;   // m or rad: Newton steps end at rounding, far below
constexpr double kBroken = 1e-3;  // half of lengths of 0.1 m and more cannot hide below it

Eigen::MatrixXd of_lane(const MethodOutput::Block& D, int lane, int equations) {
  const Eigen::Index m = D.cols() / equations;
  Eigen::MatrixXd J(equations, m);
  for (int a = 0; a < equations; ++a) J.row(a) = D.row(lane).segment(a * m, m).matrix();
  return J;
}

/// Moves the locations to where every row holds, or lets the instrument read them.
void satisfy(Instance& at) {
  if (!at.method().constrains()) {
    for (int lane = 0; lane < kLanes; ++lane)
      at.method().measure(at.now.at(lane), at.before.at(lane), at.nuisance, at.data, lane);
    return;
  }
  for (int step = 0; step < 30; ++step) {
    const MethodOutput out = at.evaluate();
    for (int lane = 0; lane < kLanes; ++lane) {
      const Eigen::VectorXd r = out.r.row(lane).matrix().transpose();
      const Eigen::VectorXd dX = least_squares(of_lane(out.G_now, lane, at.equations()), -r);
      place(at.now, lane,
            {exp_rotation(dX.tail<3>()) * at.now.R(lane), at.now.p(lane) + dX.head<3>()});
    }
  }
}

std::vector<Location> locations_of(const Instance& at, int group) {
  std::vector<Location> list;
  for (int lane = 0; lane < kLanes; ++lane)
    if (group < 0 || at.data.group[lane] == group) list.push_back(at.now.at(lane));
  return list;
}

/// Own and group values that fit the locations best: the method's start, then Gauss-Newton steps.
void fit_own(Instance& at) {
  const Eigen::VectorXd* reference = at.referred() ? &at.reference : nullptr;
  at.nuisance = at.method().start(locations_of(at, -1), at.rows, at.data, reference, {});
  for (Eigen::Index g = 0; g < at.groups.cols(); ++g)
    at.groups.col(g) = at.method().start_group(locations_of(at, static_cast<int>(g)));
  const int m = at.method().tangent_dimension(), equations = at.equations();
  for (int step = 0; m > 0 && step < 30; ++step) {
    const MethodOutput out = at.evaluate();
    Eigen::MatrixXd J(kLanes * equations, m);
    Eigen::VectorXd r(kLanes * equations);
    for (int lane = 0; lane < kLanes; ++lane) {
      J.middleRows(lane * equations, equations) = of_lane(out.D_own, lane, equations);
      r.segment(lane * equations, equations) = out.r.row(lane).matrix().transpose();
    }
    at.method().retract(at.nuisance, least_squares(J, -r));
  }
}

/// Largest residual of rows, of equations between nuisance parameters and of links between groups.
double misfit(const Instance& at) {
  double most = at.evaluate().r.abs().maxCoeff();
  for (const OwnEquation& each :
       at.method().own_equations(at.nuisance, at.referred() ? &at.reference : nullptr))
    most = std::max(most, std::abs(each.residual));
  for (const GroupDistance& link : at.method().links()) {
    Eigen::VectorXd D_a, D_b;
    most = std::max(most, std::abs(at.method().link_residual(link, at.groups.col(link.a),
                                                             at.groups.col(link.b), D_a, D_b)));
  }
  return most;
}

/// An instance that holds: one plane's normal for all touches, linked groups at their distance.
Instance satisfied_instance(const MethodCase& each, Random& random) {
  Instance at = random_instance(each, random);
  at.data.normal.rowwise() = Eigen::RowVector3d(0.6, 0, 0.8);
  for (const GroupDistance& link : at.method().links())
    at.groups.col(link.b) = at.groups.col(link.a) + link.distance * Eigen::Vector3d::UnitY();
  satisfy(at);
  return at;
}

void shrink(Instance& at) {
  at.now.position *= kScale;
  at.before.position *= kScale;
  if (at.referred() && at.referred()->tangent_dimension() > 0)
    at.reference[3] *= kScale;  // a plane's d
  fit_own(at);
}

class Gauge : public testing::TestWithParam<MethodCase> {};

TEST_P(Gauge, IsDeclaredByEveryMethodThatHoldsForARobotOfAnySize) {
  Random random(81);
  Instance at = satisfied_instance(GetParam(), random);
  ASSERT_LT(misfit(at), kHolds);
  shrink(at);
  if (misfit(at) < kBroken) {
    EXPECT_TRUE(at.method().may_leave_scale_free());
  }
}

TEST_P(Gauge, IsLeftFreeWithoutAKnownLengthAndClosedByOne) {
  Random random(82);
  Instance at = satisfied_instance(GetParam(), random);
  shrink(at);
  if (GetParam().scale_free) {
    EXPECT_LT(misfit(at), kHolds);
  } else {
    EXPECT_GT(misfit(at), kBroken);
  }
}

TEST_P(Gauge, DoesNotKeepOwnValuesFromBeingFoundFromRowsThatHold) {
  Random random(83);
  Instance at = satisfied_instance(GetParam(), random);
  if (at.method().point_unknown()) return;  // its start is the tool, which these locations lack
  fit_own(at);
  EXPECT_LT(misfit(at), kHolds);
}

TEST_P(Gauge, SaysWhetherARowTellsHowTheEndpointIsTurned) {
  Random random(85);
  const Instance at = random_instance(GetParam(), random);
  const MethodOutput out = at.evaluate();
  bool angular = false;
  for (int a = 0; a < at.equations(); ++a)
    for (const MethodOutput::Block* G : {&out.G_now, &out.G_before})
      angular = angular || (G->middleCols(6 * a + 3, 3) != 0).any();
  EXPECT_EQ(at.method().sees_orientation(), angular && at.method().body() == Body::endpoint);
}

TEST(GaugeOfAllCases, IsDeclaredByNoMethodThatNeverHoldsForARobotOfAnySize) {
  std::map<std::string, bool> declared, holds;
  Random random(84);
  for (const MethodCase& each : method_cases()) {
    Instance at = satisfied_instance(each, random);
    const std::string name(at.method().name());
    declared[name] |= at.method().may_leave_scale_free();
    shrink(at);
    holds[name] |= misfit(at) < kHolds;
  }
  EXPECT_EQ(declared, holds);
}

INSTANTIATE_TEST_SUITE_P(Methods, Gauge, testing::ValuesIn(method_cases()), title_of);

}  // namespace
}  // namespace selfcal
