// What planning gains over as many configurations at random, over many seeds, by the end position's
// sigma: whole, without the part that no such row tells, however many (ConfigurationPlan::rest),
// and against what no choice of such rows can undercut.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "constraints/planning/configuration_plan.h"
#include "constraints/planning/plan_system.h"
#include "constraints/statistics.h"
#include "io/files/robot_file.h"
#include "tests/support/cell.h"
#include "tests/support/text.h"

namespace selfcal::recovery {
namespace {

Set set_from(const std::string& name, const Node& entry) {
  Problems problems;
  Set set = make_set(name, entry, problems);
  EXPECT_FALSE(problems.any()) << problems.list.front();
  return set;
}

Node plane_entry() { return Node::map().set("method", Node::of(std::string("plane"))); }

/// What no choice of so many of the pool's units can undercut, each as often as one likes, and
/// parts of them too: by weights that grow where more is gained, less what any others may gain on
/// these at most, since the variance is convex in the weights (the equivalence theorem of Kiefer
/// and Wolfowitz).
double least_sigma(const Robot& robot, const PlanRequest& request) {
  Pool pool = draw_pool(robot, values(robot), request.pool, {});
  const PlanSystem system(robot, request.pool, request.workspace, request.count, pool);
  const Objective objective = system.objective(Criterion::sigma);
  std::vector<Eigen::MatrixXd> rows = system.rows(pool.data, pool.units, Criterion::sigma);
  const Eigen::VectorXd unit = objective.prior.diagonal().cwiseSqrt().cwiseInverse();
  const auto scaled = [&](const Eigen::MatrixXd& A) -> Eigen::MatrixXd {
    return unit.asDiagonal() * A * unit.asDiagonal();
  };
  const Eigen::MatrixXd prior = scaled(objective.prior), weight = scaled(objective.weight);
  for (Eigen::MatrixXd& each : rows) each = (each * unit.asDiagonal()).eval();
  Eigen::VectorXd share = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(rows.size()),
                                                    1.0 / static_cast<double>(rows.size()));
  double least = 0;
  for (int round = 0; round < 300; ++round) {
    Eigen::MatrixXd H = prior;
    for (std::size_t i = 0; i < rows.size(); ++i)
      H += request.count * share[static_cast<Eigen::Index>(i)] * rows[i].transpose() * rows[i];
    const Eigen::LLT<Eigen::MatrixXd> llt(H);
    const Eigen::MatrixXd CA = llt.solve(weight), CAC = llt.solve(CA.transpose());
    Eigen::VectorXd gain(share.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      gain[static_cast<Eigen::Index>(i)] = (rows[i] * CAC).cwiseProduct(rows[i]).sum();
    least = std::max(least, CA.trace() - request.count * (gain.maxCoeff() - share.dot(gain)));
    share = share.cwiseProduct(gain.cwiseSqrt());
    share /= share.sum();
  }
  return std::sqrt(least);
}

struct Gains {
  double sigma = 0;      ///< median over seeds, at random over planned
  double rest = 0;       ///< the same of what rows tell
  double possible = 0;   ///< at random over what no choice can undercut
  double from_best = 0;  ///< planned over that
};

/// Over many seeds, of as many configurations at random.
Gains gains_over_random(const Robot& robot, PlanRequest request) {
  request.speed.setOnes(static_cast<Eigen::Index>(robot.joints().size()));
  const int seeds = repetitions("SELFCAL_SEEDS", 50);
  std::vector<double> gains, before, after, rests;
  for (int seed = 1; seed <= seeds; ++seed) {
    request.pool.seed = static_cast<unsigned long long>(seed);
    const ConfigurationPlan plan = plan_configurations(robot, values(robot), request);
    EXPECT_EQ(plan.problem, "");
    before.push_back(plan.random.sigma);
    after.push_back(plan.planned.sigma);
    gains.push_back(plan.random.sigma / plan.planned.sigma);
    rests.push_back(plan.rest(plan.random.sigma) / plan.rest(plan.planned.sigma));
  }
  PlanRequest wide = request;
  wide.pool.candidates = 2000;
  const double least = least_sigma(robot, wide);
  std::printf(
      "%s, %d seeds: median sigma %.4f mm at random, %.4f mm planned, %.4f mm at least by any "
      "choice; gain %.2f (least %.2f), %.2f of what rows tell\n",
      robot.name().c_str(), seeds, 1e3 * median(before), 1e3 * median(after), 1e3 * least,
      median(gains), *std::ranges::min_element(gains), median(rests));
  return {median(gains), median(rests), median(before) / least, median(after) / least};
}

/// A robot of app/examples with every `what` of its file replaced.
std::shared_ptr<const Robot> example_robot(const std::string& name, const std::string& what = {},
                                           const std::string& by = {}) {
  std::string text = text_of(SELFCAL_SOURCE_DIR "/app/examples/" + name + ".robot.yaml");
  for (std::size_t at = 0; !what.empty() && (at = text.find(what, at)) != std::string::npos;
       at += by.size())
    text.replace(at, what.size(), by);
  return must(selfcal::robot_of(text, name));
}

PlanRequest three_planes() {
  PlanRequest request;
  for (const char* plane : {"plane1", "plane2", "plane3"})
    request.pool.sets.push_back(set_from(plane, plane_entry()));
  request.count = 30;
  request.pool.candidates = 300;
  return request;
}

PlanRequest bed() {
  PlanRequest request;
  const Eigen::VectorXd plane = Eigen::Vector3d(0, 0, -10);
  request.pool.sets.push_back(set_from("bed", plane_entry().set("plane", Node::of(plane))));
  request.count = 16;
  request.pool.candidates = 600;
  return request;
}

// Touches of unknown planes never tell the robot's size, which is then known as well as its maker
// says: with one length known, as the chapter has it, the rest is what the touches tell.
std::shared_ptr<const Robot> rx90_of_a_known_length() {
  return example_robot("rx90", "d: 0.5,", "d: 0.5, tolerance: {d: 1.0e-7},");
}

TEST(Planning, HalvesTheRx90sSigmaAfterRandomTouchesOfThreePlanesWithOneLengthKnown) {
  EXPECT_GE(gains_over_random(*rx90_of_a_known_length(), three_planes()).sigma, 2);
}

// Thirty touches are fewer than the unknowns, ratios and steps in doubt among them: parts of more
// than thirty, which the bound may take, tell what no thirty can. Twice as many have no such lack.
TEST(Planning, IsCloseToWhatAnyTouchesOfThreePlanesTellOfTheRx90WithOneLengthKnown) {
  PlanRequest request = three_planes();
  request.count *= 2;
  EXPECT_LE(gains_over_random(*rx90_of_a_known_length(), std::move(request)).from_best, 1.1);
}

TEST(Planning, TakesOfTheRx90AllThatAnyTouchesOfThreePlanesCanWithoutALength) {
  const Gains gains = gains_over_random(*example_robot("rx90"), three_planes());
  EXPECT_GE(gains.rest, 2);
  EXPECT_LE(gains.from_best, 1.01);
  EXPECT_LT(gains.possible, 1.1) << "no choice of touches halves what the maker's size leaves";
}

// Of where along its bed the tool is no touch of it tells.
TEST(Planning, TakesOfTheDeltaAllThatAnyTouchesOfItsBedCan) {
  const Gains gains = gains_over_random(*example_robot("delta"), bed());
  EXPECT_GE(gains.rest, 2);
  EXPECT_LE(gains.from_best, 1.01);
  EXPECT_LT(gains.possible, 1.5) << "no choice of touches halves what its maker's figures leave";
}

}  // namespace
}  // namespace selfcal::recovery
