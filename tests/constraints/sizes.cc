// What must not depend on a robot's size, on one of a millimetre, where thresholds in m would show,
// and one of ten metres.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "constraints/estimation/controller_sigma.h"
#include "constraints/estimation/frame_step.h"
#include "constraints/fitting/fit.h"
#include "constraints/slips/two_planes.h"
#include "kinematics/readable.h"
#include "tests/recovery/session.h"
#include "tests/support/arm_of_size.h"

namespace selfcal {
namespace {

constexpr std::array kOtherSizes{1e-3, 10.0};
constexpr double kSame = 1e-6;  // relative: rounding, times what the equations magnify

Set one_set(std::initializer_list<std::pair<const char*, const char*>> fields) {
  Problems problems;
  Node entries = Node::map();
  entries.set("rows", recovery::entry(fields));
  return read_sets(entries, problems).front();
}

/// Configurations in the middle of what a machine takes, the same ones in proportion to its size.
Eigen::MatrixXd drawn(const Robot& robot, int rows) {
  Random random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  Eigen::MatrixX2d span(static_cast<Eigen::Index>(robot.joints().size()), 2);
  for (Eigen::Index j = 0; j < span.rows(); ++j)
    span.row(j) = Eigen::RowVector2d(0.6, 0.4) * robot.joints()[static_cast<std::size_t>(j)].lower +
                  Eigen::RowVector2d(0.4, 0.6) * robot.joints()[static_cast<std::size_t>(j)].upper;
  Eigen::MatrixXd q(rows, span.rows());
  for (int row = 0; row < rows; ++row)
    q.row(row) = robot.draw(span, [&] { return uniform(random); }).transpose();
  return q;
}

DataSet data_of(const Eigen::MatrixXd& q, Set set) {
  DataSet data;
  data.sets = {std::move(set)};
  data.rows.q = q;
  const auto rows = static_cast<std::size_t>(q.rows());
  data.rows.set.assign(rows, 0);
  data.rows.group.assign(rows, -1);
  data.rows.check.assign(rows, 0);
  data.rows.position.setZero(q.rows(), 3);
  return data;
}

/// Rows that `moved` tells of their configuration and place, with noise, after the 60th.
template <class Moved>
std::vector<FrameStep> steps_in(const Robot& robot, double noise, const Moved& moved) {
  const DataSet data = data_of(drawn(robot, 120), one_set({{"method", "position"}}));
  Random random(8);
  std::normal_distribution<double> normal(0, noise);
  std::vector<RowFigure> figures;
  for (int row = 0; row < data.rows.rows(); ++row) {
    const Eigen::VectorXd q = data.rows.q.row(row).transpose();
    RowFigure figure;
    figure.row = row;
    figure.at = locate(robot, values(robot), q).p;
    for (double& each : figure.way_after) each = normal(random);
    if (row >= 60) figure.way_after += moved(q, figure.at);
    figures.push_back(figure);
  }
  return frame_steps(robot, values(robot), data, figures);
}

std::vector<FrameStep> moved_instrument(const Robot& robot, double k) {
  return steps_in(robot, 1e-4 * k, [&](const Eigen::VectorXd&, const Eigen::Vector3d& p) {
    return Eigen::Vector3d(k * Eigen::Vector3d(1e-3, -2e-3, 1e-3) +
                           Eigen::Vector3d(2e-3, 1e-3, 2e-2).cross(p));
  });
}

std::vector<FrameStep> shifted_zero(const Robot& robot, double k) {
  return steps_in(robot, 5e-6 * k, [&](Eigen::VectorXd q, const Eigen::Vector3d& p) {
    q[0] += 2e-3 * k;
    return Eigen::Vector3d(locate(robot, values(robot), q).p - p);
  });
}

void expect_the_same_step(const std::vector<FrameStep>& one, const std::vector<FrameStep>& other,
                          double k) {
  ASSERT_EQ(one.size(), 1U);
  ASSERT_EQ(other.size(), 1U) << k;
  EXPECT_EQ(other[0].before, one[0].before) << k;
  EXPECT_NEAR(other[0].shift / k, one[0].shift, kSame * one[0].shift) << k;
  EXPECT_NEAR(other[0].turn, one[0].turn, kSame * one[0].turn) << k;
  EXPECT_NEAR(other[0].share, one[0].share, kSame) << k;
}

TEST(AnySize, HasTheInstrumentsStepWhereItIs) {
  const auto arm = moved_instrument(*arm_of_size(1), 1);
  const auto delta = moved_instrument(*delta_of_size(1), 1);
  for (const double k : kOtherSizes) {
    expect_the_same_step(arm, moved_instrument(*arm_of_size(k), k), k);
    expect_the_same_step(delta, moved_instrument(*delta_of_size(k), k), k);
  }
}

TEST(AnySize, HasNoInstrumentMovedWhereASlidesZeroShifts) {
  // So small, too, that steps for the derivatives of a printer's slides would break its loops.
  for (const double k : {1e-5, 1.0, 10.0})
    EXPECT_TRUE(shifted_zero(*delta_of_size(k), k).empty()) << k;
}

TEST(AnySize, HasTwoPlanesApart) {
  const auto usual = arm_of_size(1);
  Random random(3);
  const recovery::Session session =
      recovery::make_session(*usual, values(*usual),
                             {{"a", recovery::entry({{"method", "plane"}}), 30},
                              {"b", recovery::entry({{"method", "plane"}}), 20}},
                             0, random);
  ASSERT_EQ(session.unreached, "");
  const DataSet data = data_of(session.data.rows.q, one_set({{"method", "plane"}}));
  const auto one = parted_planes(*usual, data, 0);
  ASSERT_TRUE(one.has_value());
  for (const double k : kOtherSizes) {
    const auto other = parted_planes(*arm_of_size(k), data, 0);
    ASSERT_TRUE(other.has_value()) << k;
    EXPECT_EQ(other->rows.set, one->rows.set) << k;
  }
}

double left_by_a_controller(double k) {
  const auto robot = arm_of_size(k);
  const DataSet data = data_of(drawn(*robot, 60), one_set({{"method", "position"}}));
  Random random(9);
  std::normal_distribution<double> normal(0, 1e-3);
  Solution solution;
  solution.values = nominal_values(*robot);
  for (Eigen::Index i = 0; i < solution.values.size(); ++i) {
    const Parameter& p = robot->parameters()[static_cast<std::size_t>(i)];
    const double moved = normal(random);
    if (p.part == Part::link && p.free)
      solution.values[i] += (p.quantity == Quantity::length ? k : 1) * moved;
  }
  solution.workspace.poses = 1;
  solution.workspace.aligned = true;
  return controller_sigma(*robot, data, solution).left;
}

TEST(AnySize, IsFollowedByItsControllerAsFar) {
  const double one = left_by_a_controller(1);
  EXPECT_GT(one, 1e-4);
  for (const double k : kOtherSizes)
    EXPECT_NEAR(left_by_a_controller(k) / k, one, kSame * one) << k;
}

/// Distances from a point, from a start among the rows, which no whole step leaves.
Fit fitted_from_afar(double k, int most_iterations) {
  const auto robot = arm_of_size(k);
  DataSet data = data_of(drawn(*robot, 80), one_set({{"method", "fixed-point-distance"},
                                                     {"noise", format_number(2e-5 * k).c_str()}}));
  Random random(4);
  std::normal_distribution<double> normal(0, 2e-5 * k);
  const Eigen::Vector3d centre = k * Eigen::Vector3d(2, -1, 0.5);
  Eigen::VectorXd& distance = data.rows.measured["distance"];
  distance.resize(data.rows.rows());
  for (int row = 0; row < data.rows.rows(); ++row)
    distance[row] =
        (locate(*robot, values(*robot), data.rows.q.row(row).transpose()).p - centre).norm() +
        normal(random);
  const Equations equations(*robot, data, Use::fit);
  Prior prior{nominal_values(*robot), Eigen::VectorXd(robot->parameters().size()), {}, true};
  for (std::size_t i = 0; i < robot->parameters().size(); ++i) {
    prior.sigma[static_cast<Eigen::Index>(i)] = robot->parameters()[i].tolerance;
    prior.free.push_back(robot->parameters()[i].free);
  }
  State start{nominal_values(*robot), {{}}, {{}}};
  equations.start(start);
  start.nuisance[0].head<3>() = k * Eigen::Vector3d(-0.4, 0.3, 0.6);
  return fit(equations, start, prior, {.most_iterations = most_iterations});
}

TEST(AnySize, IsFittedOnTheSameWay) {
  constexpr int kDamped = 5, kMany = 100;  // steps, the first damped ones among them; to the end
  const Fit begun = fitted_from_afar(1, kDamped), one = fitted_from_afar(1, kMany);
  ASSERT_TRUE(one.converged) << one.stop_reason;
  for (const double k : kOtherSizes) {
    const Eigen::Vector3d centre = fitted_from_afar(k, kDamped).state.nuisance[0].head<3>() / k;
    EXPECT_LT((centre - begun.state.nuisance[0].head<3>()).norm(), kSame) << k;
    const Fit other = fitted_from_afar(k, kMany);
    EXPECT_EQ(other.iterations, one.iterations) << k << ": " << other.stop_reason;
  }
}

}  // namespace
}  // namespace selfcal
