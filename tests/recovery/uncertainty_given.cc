// The doubt of what was given: planes, normals, centres, a probe's radius, gears, what is fixed.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/recovery/rx90.h"
#include "tests/recovery/uncertainty_budget.h"

namespace selfcal::recovery {
namespace {

TEST(Uncertainty, HasTheDoubtOfAGivenPlaneInItUnlessItIsExact) {
  const auto robot = robot_of(kRx90);
  const auto sigma = [&](const char* tolerance) {
    Random random(5);
    const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
    std::vector<SetPart> parts;
    for (const Eigen::Vector3d& abc :
         {Eigen::Vector3d(0, 0, -5), Eigen::Vector3d(-2, 0, 0), Eigen::Vector3d(0, -2, 0)}) {
      Node node = entry({{"method", "plane"}});
      node.set("plane", Node::of(Eigen::VectorXd(abc)));
      Node tolerances = Node::map();
      if (*tolerance) {
        tolerances.set("place", Node::of(std::string(tolerance)));
        tolerances.set("turn", Node::of(std::string(tolerance)));
        node.set("tolerance", tolerances);
      }
      parts.push_back({"p" + std::to_string(parts.size()), node, 120});
    }
    const Session session = make_session(*robot, truth, parts, 20e-6, random);
    EXPECT_EQ(session.unreached, "");
    return identify(*robot, session.data);
  };
  const Solution exact = sigma("0"), silent = sigma(""), rough = sigma("1e-3");
  EXPECT_LT(budget(exact, "what was given"), 0.02e-3);
  EXPECT_GT(budget(silent, "what was given"), 2 * budget(exact, "what was given"));
  // A world that is given by planes is in doubt as they are: a millimetre each.
  EXPECT_GT(budget(rough, "what was given"), 0.5e-3);
  EXPECT_GT(rough.workspace.rms, budget(rough, "what was given"));
  EXPECT_TRUE(rough.values.isApprox(exact.values, 1e-9)) << "given is kept";
  // Touches of planes have no residual vectors: what is expected all over the workspace is said.
  ASSERT_FALSE(rough.uncertainty.grid.empty());
  double squares = 0, poses = 0;
  for (const GridCell& cell : rough.uncertainty.grid) {
    EXPECT_EQ(cell.rows, 0);
    EXPECT_LT(cell.bias, cell.sigma);
    squares += cell.poses * cell.bias * cell.bias;
    poses += cell.poses;
  }
  double lasting = 0;
  for (const char* source : {"the maker's tolerances", "held scale", "what was given",
                             "rows that share errors", "laws that the geometry imitates"})
    lasting += std::pow(budget(rough, source), 2);
  // A part that is the difference of two covariances counts by what of it is positive.
  EXPECT_NEAR(std::sqrt(squares / poses / lasting), 1, 0.02);
}

/// The doubt of what was given where its tolerance is `text`.
double given(const std::vector<SetPart>& parts, const char* text, const Options& options = {},
             const std::string& robot_file = kRx90) {
  const auto robot = robot_of(robot_file);
  Random random(5);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  std::vector<SetPart> sets = parts;
  for (SetPart& part : sets) {
    if (!*text) continue;
    Node tolerances = Node::map();
    for (const char* of : {"place", "turn", "length"})
      if (part.node.find(of == std::string("length") ? "radius"
                         : of == std::string("turn") ? "normal"
                                                     : "center"))
        tolerances.set(of, Node::of(std::string(text)));
    part.node.set("tolerance", tolerances);
  }
  const Session session = make_session(*robot, truth, sets, 20e-6, random);
  EXPECT_EQ(session.unreached, "");
  return budget(identify(*robot, session.data, options), "what was given");
}

TEST(Uncertainty, HasTheDoubtOfGivenNormalsInIt) {
  std::vector<SetPart> parts;
  for (const Eigen::Vector3d& n :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)}) {
    Node node = entry({{"method", "plane-normal"}});
    node.set("normal", Node::of(Eigen::VectorXd(n)));
    parts.push_back({"n" + std::to_string(parts.size()), node, 90});
  }
  const double exact = given(parts, "0"), rough = given(parts, "1e-3");
  EXPECT_LT(exact, 0.02e-3);
  // A milliradian between normals bends the axes of a robot that reaches a metre.
  EXPECT_GT(rough, 0.1e-3);
  EXPECT_NEAR(given(parts, "2e-3") / rough, 2, 0.5);
}

TEST(Uncertainty, HasTheDoubtOfAGivenCentreAndRadiusInIt) {
  Node node = entry({{"method", "sphere"}, {"radius", "0.3"}});
  node.set("center", Node::of(Eigen::VectorXd(Eigen::Vector3d(0.6, 0.1, 0.6))));
  const std::vector<SetPart> ball{{"ball", node, 240}};
  const double exact = given(ball, "0"), rough = given(ball, "1e-3");
  EXPECT_LT(exact, 0.02e-3);
  EXPECT_GT(rough, 0.5e-3);
}

/// The doubt of what was given, of touches of the two faces of a plate 0.2 m thick by a ball of 3
/// mm whose radius is given to `tolerance`; or of two steps seen from one side.
double given_by_probe(const char* tolerance, bool opposite) {
  const auto robot = robot_of(kRx90);
  Random random(5);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  const auto parts = [&](const char* distance) {
    Node other = entry({{"set", "table"}, {"noise", "2e-6"}});
    other.set("distance", Node::of(std::string(distance)));
    Node step = entry({{"method", "plane"}, {"probe_radius", "3e-3"}});
    step.set("parallel_to", other);
    Node tolerances = Node::map();
    tolerances.set("length", Node::of(std::string(tolerance)));
    step.set("tolerance", tolerances);
    return std::vector<SetPart>{
        {"table", entry({{"method", "plane"}, {"probe_radius", "3e-3"}}), 150},
        {"step", step, 150}};
  };
  Session session = make_session(*robot, truth, parts("0.2"), 20e-6, random);
  EXPECT_EQ(session.unreached, "");
  if (opposite) {  // the same touches, from the other side of a plate that is a ball thicker
    Node all = Node::map();
    for (const SetPart& part : parts("0.206")) all.set(part.name, part.node);
    Problems problems;
    session.data.sets = read_sets(all, problems);
    EXPECT_FALSE(problems.any());
    Observations& rows = session.data.rows;
    for (int row = 0; row < rows.rows(); ++row)
      if (rows.set[static_cast<size_t>(row)] == 1) rows.normal.row(row) *= -1;
  }
  const Solution solution = identify(*robot, session.data);
  EXPECT_TRUE(solution.converged);
  for (const BudgetLine& line : solution.uncertainty.budget) EXPECT_LT(line.sigma, 5e-3);
  return budget(solution, "what was given");
}

TEST(Uncertainty, HasTheDoubtOfAProbesRadiusInItWhereItTouchesOppositeFaces) {
  const double exact = given_by_probe("0", true), rough = given_by_probe("1e-4", true);
  // 0.2 mm of 0.206 m are a thousandth of a robot that reaches a metre.
  EXPECT_GT(rough, 0.2e-3);
  EXPECT_LT(exact, 0.1 * rough);
  EXPECT_NEAR(given_by_probe("1e-4", false), given_by_probe("0", false), 1e-6);
}

TEST(Uncertainty, HasTheDoubtOfGearsAndOfWhatIsFixedInIt) {
  std::string exact = kRx90;
  for (const char* joint : {"j1", "j2", "j3", "j4", "j5", "j6"}) {
    const std::string entry = std::string("{name: ") + joint + ",";
    exact.replace(exact.find(entry), entry.size(), entry + " tolerance: {gear: 0},");
  }
  const std::vector<SetPart> parts = tracked(150);
  Options link;
  link.fix = {"theta3"};
  // Tooth counts are believed to 2e-5, which the rows of a metre's reach know about as well.
  const double silent = given(parts, "");
  EXPECT_GT(silent, 1e-6);
  EXPECT_LT(given(parts, "", {}, exact), 0.1 * silent);
  EXPECT_GT(given(parts, "", link), 2 * silent);
}

}  // namespace
}  // namespace selfcal::recovery
