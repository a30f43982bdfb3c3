// Plans of configurations for the Stäubli RX-90 by planes, the linear delta by its bed and a
// platform by locked joints, against random choices and against the equations themselves.
#include "constraints/planning/configuration_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>

#include "constraints/identifiability/observability.h"
#include "constraints/planning/detmax.h"
#include "constraints/planning/refinement.h"
#include "constraints/sampling/contact.h"
#include "constraints/statistics.h"
#include "io/files/robot_file.h"

namespace selfcal {
namespace {

std::shared_ptr<const Robot> shipped_robot(const std::string& name) {
  auto robot = load_robot(SELFCAL_SOURCE_DIR "/app/examples/" + name + ".robot.yaml");
  EXPECT_TRUE(robot) << robot.error().what;
  return std::move(*robot);
}

Set planned_set(const std::string& name, const Node& entry) {
  Problems problems;
  Set set = make_set(name, entry, problems);
  EXPECT_FALSE(problems.any()) << problems.list.front();
  return set;
}

Set set_of_method(const std::string& name, const std::string& method) {
  return planned_set(name, Node::map().set("method", Node::of(method)));
}

PlanRequest planes_request(const Robot& robot, int planes, int count, int candidates) {
  PlanRequest request;
  for (int i = 0; i < planes; ++i)
    request.pool.sets.push_back(set_of_method("plane" + std::to_string(i + 1), "plane"));
  request.count = count;
  request.pool.candidates = candidates;
  request.speed.setOnes(static_cast<Eigen::Index>(robot.joints().size()));
  return request;
}

/// Over seeds, the median of what is left of sigma after random configurations over that after the
/// planned ones.
double median_gain(const Robot& robot, PlanRequest request, int seeds) {
  std::vector<double> gains;
  for (int seed = 1; seed <= seeds; ++seed) {
    request.pool.seed = static_cast<unsigned long long>(seed);
    const ConfigurationPlan plan = plan_configurations(robot, values(robot), request);
    EXPECT_EQ(plan.problem, "");
    EXPECT_EQ(plan.units.size(), static_cast<std::size_t>(request.count));
    gains.push_back(plan.rest(plan.random.sigma) / plan.rest(plan.planned.sigma));
  }
  return median(gains);
}

TEST(ConfigurationPlan, KnowsTheEndPositionOfTheRx90TwiceAsWellAsRandomTouchesOfThreePlanes) {
  const auto robot = shipped_robot("rx90");
  EXPECT_GE(median_gain(*robot, planes_request(*robot, 3, 30, 300), 7), 2);
}

TEST(ConfigurationPlan, KnowsTheEndPositionOfTheDeltaTwiceAsWellAsRandomTouchesOfItsBed) {
  const auto robot = shipped_robot("delta");
  PlanRequest request = planes_request(*robot, 0, 16, 600);
  request.pool.sets.push_back(
      planned_set("bed", Node::map()
                             .set("method", Node::of(std::string("plane")))
                             .set("plane", Node::of(Eigen::VectorXd(Eigen::Vector3d(0, 0, -10))))));
  EXPECT_GE(median_gain(*robot, request, 7), 2);
}

TEST(ConfigurationPlan, KeepsConfigurationsOnTheSurfaceAndWithinTheLimits) {
  const auto robot = shipped_robot("rx90");
  const ConfigurationPlan plan =
      plan_configurations(*robot, values(*robot), planes_request(*robot, 1, 25, 300));
  ASSERT_EQ(plan.problem, "");
  // All end positions of one plane: the smallest singular value of their offsets is rounding.
  Eigen::MatrixXd p(25, 3);
  for (int row = 0; row < 25; ++row) {
    const Eigen::VectorXd q = plan.data.rows.q.row(row).transpose();
    EXPECT_TRUE(within_limits(*robot, q));
    p.row(row) = locate(*robot, values(*robot), q).p.transpose();
  }
  const Eigen::MatrixXd offsets = p.rowwise() - p.colwise().mean();
  EXPECT_LT(offsets.jacobiSvd().singularValues()[2], 1e-11);
  EXPECT_LT(plan.way, plan.way_random);
  ASSERT_EQ(plan.curve.size(), 26u);
  EXPECT_NEAR(plan.curve.front(), plan.sigma_before, 1e-6 * plan.sigma_before);
  EXPECT_NEAR(plan.curve.back(), plan.planned.sigma, 1e-6 * plan.planned.sigma);
  for (std::size_t n = 1; n < plan.curve.size(); ++n)
    EXPECT_LE(plan.curve[n], plan.curve[n - 1] * (1 + 1e-9));
}

TEST(ConfigurationPlan, RaisesTheIndexThatItIsAskedFor) {
  const auto robot = shipped_robot("rx90");
  PlanRequest request = planes_request(*robot, 2, 30, 300);
  for (const auto& [criterion, index] : {std::pair{Criterion::o1, &Observability::o1},
                                         {Criterion::o2, &Observability::o2},
                                         {Criterion::o3, &Observability::o3},
                                         {Criterion::o4, &Observability::o4},
                                         {Criterion::o5, &Observability::o5}}) {
    request.criterion = criterion;
    const ConfigurationPlan plan = plan_configurations(*robot, values(*robot), request);
    EXPECT_GT(plan.planned.observability.*index, 1.15 * plan.random.observability.*index)
        << to_string(criterion);
  }
}

TEST(ConfigurationPlan, GoesOnFromWhatIsMeasuredAlready) {
  const auto robot = shipped_robot("rx90");
  PlanRequest request = planes_request(*robot, 2, 20, 300);
  const ConfigurationPlan first = plan_configurations(*robot, values(*robot), request);
  request.pool.taken = first.data;
  request.pool.seed = 2;
  const ConfigurationPlan further = plan_configurations(*robot, values(*robot), request);
  ASSERT_EQ(further.problem, "");
  // The surfaces are those touched already, and what was known is where it begins; planes are
  // fitted to rounding.
  EXPECT_NEAR(further.sigma_before, first.planned.sigma, 1e-5 * first.planned.sigma);
  EXPECT_LT(further.rest(further.planned.sigma), 0.8 * further.rest(further.sigma_before));
}

TEST(ConfigurationPlan, GoesOnFromConfigurationsAloneWhateverInstrumentsReadThere) {
  const auto robot = shipped_robot("rx90");
  Node tracker = Node::map();
  tracker.set("method", Node::of(std::string("position")));
  for (const char* key : {"frame", "point"}) tracker.set(key, Node::of(std::string("unknown")));
  for (const Set& set :
       {set_of_method("tracker", "position"), planned_set("placed", tracker),
        set_of_method("arm", "location"), set_of_method("bar", "distance"),
        set_of_method("tilt", "inclinometers"),
        planned_set("device", Node::map()
                                  .set("method", Node::of(std::string("constraint-link")))
                                  .set("length", Node::of(0.75)))}) {
    PlanRequest request = planes_request(*robot, 0, 15, 80);
    request.pool.sets = {set};
    const ConfigurationPlan first = plan_configurations(*robot, values(*robot), request);
    ASSERT_EQ(first.problem, "") << set.name;
    request.pool.taken.sets = first.data.sets;
    Observations& rows = request.pool.taken.rows;
    rows.q = first.data.rows.q;
    rows.set = first.data.rows.set;
    rows.group = first.data.rows.group;
    rows.check.assign(rows.set.size(), 0);
    const ConfigurationPlan further = plan_configurations(*robot, values(*robot), request);
    ASSERT_EQ(further.problem, "") << set.name;
    // Where an unknown device stands is drawn again, by the same seed.
    EXPECT_NEAR(further.sigma_before, first.planned.sigma, 1e-5 * first.planned.sigma) << set.name;
  }
}

TEST(ConfigurationPlan, PlansForPairsAndForJointsThatAreLocked) {
  const auto arm = shipped_robot("rx90");
  PlanRequest pairs = planes_request(*arm, 0, 20, 200);
  pairs.pool.sets = {set_of_method("bar", "distance")};
  const ConfigurationPlan bars = plan_configurations(*arm, values(*arm), pairs);
  ASSERT_EQ(bars.problem, "");
  EXPECT_EQ(bars.data.rows.rows(), 40);
  EXPECT_EQ(bars.data.sets[0].groups.size(), 20u);
  EXPECT_LT(bars.planned.sigma, 0.7 * bars.random.sigma);

  const auto platform = shipped_robot("stewart");
  PlanRequest locks = planes_request(*platform, 0, 12, 60);
  locks.pool.sets = {
      planned_set("lock", Node::map()
                              .set("method", Node::of(std::string("locked-joint")))
                              .set("lock", Node::map()
                                               .set("leg", Node::of(std::string("1")))
                                               .set("joint", Node::of(std::string("universal")))))};
  const ConfigurationPlan locked = plan_configurations(*platform, values(*platform), locks);
  ASSERT_EQ(locked.problem, "");
  EXPECT_LT(locked.rest(locked.planned.sigma), 0.8 * locked.rest(locked.random.sigma));
}

TEST(ConfigurationPlan, KnowsMoreOnceItsConfigurationsAreMoved) {
  // The same choice of the same candidates, before and after.
  const auto robot = shipped_robot("rx90");
  const PlanRequest request = planes_request(*robot, 3, 20, 120);
  Pool pool = draw_pool(*robot, values(*robot), request.pool);
  const PlanSystem system(*robot, request.pool, {}, request.count, pool);
  const Objective objective = system.objective(Criterion::sigma);
  Design design(system.rows(pool.data, pool.units, Criterion::sigma), objective);
  std::mt19937_64 random(1);
  design.choose(random_choice(design.candidates(), request.count, random));
  exchange(design);
  const double chosen = std::sqrt(-design.merit());
  std::vector<Unit> units;
  for (const int i : design.chosen()) units.push_back(pool.units[static_cast<std::size_t>(i)]);
  const int moves = refine(*robot, system.equations(), objective,
                           {pool.data, units, system.columns(Criterion::sigma), system.most(), {}});
  const double moved = system.figures(pool.data, units).sigma;
  std::printf("sigma %.4f mm chosen, %.4f mm after %d moves\n", 1e3 * chosen, 1e3 * moved, moves);
  EXPECT_GT(moves, request.count);
  const double beyond = system.sigma_beyond(pool, pool.data, units);
  EXPECT_LT(moved * moved - beyond * beyond, 0.9 * (chosen * chosen - beyond * beyond));
}

TEST(ConfigurationPlan, CallsNothingBeyondSuchRowsThatItsOwnTell) {
  // A bed of unknown place: at the edges, where the rods lie flat, a touch tells what a thousand
  // random ones do not.
  const auto robot = shipped_robot("delta");
  const ConfigurationPlan plan =
      plan_configurations(*robot, values(*robot), planes_request(*robot, 1, 24, 1000));
  ASSERT_EQ(plan.problem, "");
  std::printf("sigma %.4f mm planned, %.4f mm of it beyond\n", 1e3 * plan.planned.sigma,
              1e3 * plan.sigma_beyond);
  EXPECT_LT(plan.sigma_beyond, plan.planned.sigma);
  EXPECT_GT(plan.rest(plan.planned.sigma), 0);
}

TEST(ConfigurationPlan, GoesOnFromACovarianceAsFromTheRowsThatGaveIt) {
  // What 30 positions by an instrument tell, as rows and as a matrix.
  const auto robot = shipped_robot("rx90");
  PlanRequest request = planes_request(*robot, 0, 15, 150);
  request.pool.sets = {set_of_method("tracker", "position")};
  const ConfigurationPlan first = plan_configurations(*robot, values(*robot), request);
  ASSERT_EQ(first.problem, "");
  Pool pool = draw_pool(*robot, values(*robot), request.pool);
  const PlanSystem system(*robot, request.pool, {}, request.count, pool);
  const auto parameters = static_cast<Eigen::Index>(robot->parameters().size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(parameters, parameters);
  for (const Eigen::MatrixXd& w : system.equations().of_units(first.data, first.units))
    information += w.leftCols(parameters).transpose() * w.leftCols(parameters);
  const Eigen::VectorXd tolerance = system.equations().tolerance();
  std::vector<int> open;
  for (int i = 0; i < static_cast<int>(parameters); ++i)
    if (tolerance[i] > 0) open.push_back(i);
  Eigen::MatrixXd H = information(open, open);
  H.diagonal() += tolerance(open).cwiseAbs2().cwiseInverse();
  PlanRequest by_rows = request, by_matrix = request;
  by_rows.pool.taken = first.data;
  by_matrix.pool.prior = Eigen::MatrixXd::Zero(parameters, parameters);
  by_matrix.pool.prior(open, open) = Eigen::MatrixXd(H.inverse());
  const double rows = plan_configurations(*robot, values(*robot), by_rows).sigma_before;
  const double matrix = plan_configurations(*robot, values(*robot), by_matrix).sigma_before;
  EXPECT_NEAR(matrix, rows, 1e-3 * rows);
  EXPECT_LT(matrix, 0.1 * first.sigma_before);
}

TEST(ConfigurationPlan, SaysWhyThereIsNone) {
  const auto robot = shipped_robot("rx90");
  PlanRequest request = planes_request(*robot, 1, 5, 50);
  request.workspace.box =
      Eigen::AlignedBox3d(Eigen::Vector3d(9, 9, 9), Eigen::Vector3d(9.1, 9.1, 9.1));
  EXPECT_EQ(plan_configurations(*robot, values(*robot), request).problem,
            "the robot reaches no pose of the workspace");
}

}  // namespace
}  // namespace selfcal
