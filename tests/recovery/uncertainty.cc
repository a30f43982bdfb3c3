// What a result says of its own doubt: parts that add up, tests that see what is no noise, and the
// doubt of what was given.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "constraints/estimation/controller_sigma.h"
#include "constraints/identifiability/endpoint_sigma.h"
#include "constraints/sampling/workspace_poses.h"
#include "tests/recovery/rx90.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal::recovery {
namespace {

std::vector<SetPart> tracked(int rows) {
  return {{"tracker", entry({{"method", "position"}}), rows}};
}

/// The session of `parts` with each row twice, and noise of its own: repeats.
Session repeated(const Robot& robot, const Eigen::VectorXd& truth, int rows, Random& random) {
  Session session = make_session(robot, truth, tracked(rows), 0, random);
  std::vector<int> twice;
  for (int row = 0; row < rows; ++row) twice.insert(twice.end(), 2, row);
  session.data.rows = taken(session.data.rows, twice);
  Observations& o = session.data.rows;
  std::normal_distribution<double> noise(0, 20e-6);
  o.repeat.clear();
  for (int row = 0; row < o.rows(); ++row) {
    o.repeat.push_back(row / 2);
    o.check[static_cast<size_t>(row)] = row / 2 % 3 == 0;
    for (int k = 0; k < 3; ++k) o.position(row, k) += noise(random);
  }
  return session;
}

double budget(const Solution& solution, const std::string& source) {
  for (const BudgetLine& line : solution.uncertainty.budget)
    if (line.source == source) return line.sigma;
  return -1;
}

TEST(Uncertainty, SaysThatAWorkspaceIsHardlyReached) {
  const auto robot = robot_of(kRx90);
  Random random(4);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  Session session = make_session(*robot, truth, tracked(90), 20e-6, random);
  EXPECT_EQ(identify(*robot, session.data).verdict.answer, Answer::improved);
  // A room in whose corner alone the robot works.
  session.data.workspace.box =
      Eigen::AlignedBox3d(Eigen::Vector3d(0.4, -9, 0.2), Eigen::Vector3d(30, 9, 30));
  const Solution solution = identify(*robot, session.data);
  EXPECT_GT(solution.workspace.poses, 0);
  EXPECT_LT(solution.workspace.poses, kFewestPoses);
  EXPECT_LT(solution.workspace.rms, session.data.target);
  EXPECT_EQ(solution.verdict.answer, Answer::not_determined);
  EXPECT_TRUE(std::ranges::any_of(solution.warnings, [&](const std::string& each) {
    return each.starts_with("workspace: only " + std::to_string(solution.workspace.poses));
  }));
}

TEST(Uncertainty, HasABudgetThatAddsUpAndResidualsThatAreNoise) {
  const auto robot = robot_of(kRx90);
  Random random(4);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  const Session session = repeated(*robot, truth, 150, random);
  const Solution solution = identify(*robot, session.data);
  const Uncertainty& u = solution.uncertainty;
  double squares = 0;
  for (const BudgetLine& line : u.budget) squares += line.sigma * line.sigma;
  EXPECT_NEAR(std::sqrt(squares), solution.workspace.rms, 1e-9);
  EXPECT_NEAR(u.expanded, u.k * solution.workspace.rms, 1e-12);
  EXPECT_NEAR(u.k, 1.96, 0.02);
  // 200 rows of three coordinates, of which 33 parameters are determined, some by their priors.
  EXPECT_NEAR(u.freedoms, 600 - 33, 12);
  EXPECT_EQ(u.lack_of_fit.repeat_freedoms, 300);
  EXPECT_GT(u.lack_of_fit.p_value, 0.001);
  EXPECT_GT(u.residuals.normality_p, 0.001);
  EXPECT_GT(u.residuals.autocorrelation_p, 0.001);
  EXPECT_EQ(u.repeats.poses, 150);
  // Two readings apart by sqrt(2) of their noise, each half of it from their mean.
  EXPECT_NEAR(u.repeats.repeatability, 60e-6, 40e-6);
  EXPECT_LT(u.repeats.accuracy, 100e-6);
  for (const GridCell& cell : u.grid) {
    if (cell.rows > 0) {
      EXPECT_LT(cell.bias, 60e-6);
    }
  }
}

TEST(Uncertainty, SeesAnEffectThatTheModelLacks) {
  const auto robot = robot_of(kRx90);
  Random random(4);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  Session session = repeated(*robot, truth, 150, random);
  const Solution without = identify(*robot, session.data);
  Observations& o = session.data.rows;  // a gear that is off by 0.5 mrad twice a turn
  for (int row = 0; row < o.rows(); ++row) o.q(row, 1) -= 5e-4 * std::sin(2 * o.q(row, 1));
  const Solution with = identify(*robot, session.data);
  EXPECT_LT(with.uncertainty.lack_of_fit.p_value, 1e-6);
  EXPECT_GT(with.uncertainty.lack_of_fit.F, 5);
  EXPECT_GT(with.workspace.rms, 2 * without.workspace.rms);
}

TEST(Uncertainty, FindsNoLackOfFitInLocationsWhosePositionsAreBetterThanSaid) {
  const Simulated simulated = made(
      "robot: rx90.robot.yaml\nseed: 3\nerrors: {length: 1.0e-3, angle: 1.0e-3}\n"
      "repeats: {share: 1, times: 3}\nsets: {nest: {method: location, rows: 60, noise: 1.0e-4,\n"
      "  noise_angle: 1.0e-4, noise_true: 1.0e-5, noise_angle_true: 1.0e-4}}\n");
  const LackOfFit fit = identify(rx90(), simulated.data).uncertainty.lack_of_fit;
  EXPECT_EQ(fit.repeat_freedoms, 156);  // 13 configurations identify: two each, times six scalars
  EXPECT_GT(fit.p_value, 0.01);
}

TEST(Uncertainty, GrowsWhereHalvesOfTheRowsDisagree) {
  const auto robot = robot_of(kRx90);
  Random random(8);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  Session session = make_session(*robot, truth, tracked(200), 20e-6, random);
  const Solution steady = identify(*robot, session.data);
  Observations& o = session.data.rows;
  // Half way a joint slips by 0.3 mrad: independent rows would not tell, for it looks like noise.
  for (int row = o.rows() / 2; row < o.rows(); ++row) o.q(row, 2) += 3e-4;
  const Solution slipped = identify(*robot, session.data);
  EXPECT_GT(budget(slipped, "rows that share errors"), 2 * budget(slipped, "noise of the rows"));
  EXPECT_LT(budget(steady, "rows that share errors"), 1.5 * budget(steady, "noise of the rows"));
}

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
  for (const char* source :
       {"the maker's tolerances", "held scale", "what was given", "rows that share errors"})
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

TEST(Uncertainty, IsRepeatedByAReaderOfTheExportedCovariance) {
  const auto robot = robot_of(kRx90);
  Random random(6);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  const Session session = make_session(*robot, truth, tracked(150), 20e-6, random);
  const Solution solution = identify(*robot, session.data);
  const auto n = static_cast<Eigen::Index>(robot->parameters().size());
  std::vector<int> at;
  for (const std::string& name : solution.covariance_order)
    at.push_back(find_parameter(*robot, name));
  EndpointQuestion question;
  question.robot = robot.get();
  question.xi = solution.values;
  question.covariance = Eigen::MatrixXd::Zero(n, n);
  question.covariance(at, at) = solution.covariance;
  question.unseen = Eigen::MatrixXd(6, 0);
  question.poses = workspace_poses(*robot, solution.values, {}, session.data.rows.q, 500, 1);
  ASSERT_FALSE(solution.workspace.aligned);
  EXPECT_NEAR(endpoint_sigma(question).rms / solution.workspace.rms, 1, 1e-6);
  for (const Correlation& each : solution.uncertainty.correlations) {
    const int a = find_parameter(*robot, each.a), b = find_parameter(*robot, each.b);
    const Eigen::MatrixXd& C = question.covariance;
    EXPECT_GT(std::abs(each.value), 0.9);
    EXPECT_NEAR(each.value, C(a, b) / std::sqrt(C(a, a) * C(b, b)), 1e-9) << each.a << each.b;
  }
}

TEST(Uncertainty, IsOfHowTheEndIsTurnedWhereTheRowsSeeIt) {
  const auto robot = robot_of(kRx90);
  for (const bool seen : {true, false}) {
    Random random(7);
    const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
    const Node node = entry({{"method", seen ? "location" : "position"}});
    const Session session = make_session(*robot, truth, {{"arm", node, 120}}, 20e-6, random);
    const Solution solution = identify(*robot, session.data);
    EXPECT_EQ(solution.orientation_seen, seen);
    EXPECT_EQ(solution.verdict.why.find(" mrad (over the whole") != std::string::npos, seen)
        << solution.verdict.why;
    if (!seen) continue;
    const Eigen::MatrixXd q =
        workspace_poses(*robot, solution.values, {}, session.data.rows.q, 300, 1);
    double squares = 0;
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const Eigen::Matrix3d turned = locate(*robot, truth, q.row(i).transpose()).R.transpose() *
                                     locate(*robot, solution.values, q.row(i).transpose()).R;
      squares += std::pow(Eigen::AngleAxisd(turned).angle(), 2);
    }
    const double error = std::sqrt(squares / static_cast<double>(q.rows()));
    // Of one draw of some thirty directions: within a factor of two either way.
    EXPECT_LT(error, 2 * solution.workspace.angle);
    EXPECT_GT(error, 0.5 * solution.workspace.angle);
  }
}

TEST(Uncertainty, HasTheResolutionOfTheEncodersAndWhatRepeatsShowInItsBudget) {
  const auto robot = robot_of(kRx90);
  Random random(4);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  Session session = repeated(*robot, truth, 150, random);
  const Solution fine = identify(*robot, session.data);
  EXPECT_EQ(budget(fine, "resolution of the encoders"), 0);
  // Rows scatter by their repeats alone: all of the noise is theirs.
  EXPECT_GT(budget(fine, "repeatability, from repeats"), 2 * budget(fine, "noise of the rows"));
  constexpr double kStep = 2e-4;
  session.data.rows.q = (session.data.rows.q / kStep).array().round().matrix() * kStep;
  const Solution coarse = identify(*robot, session.data);
  // Half a metre from the joints 0.2 mrad / sqrt(12) is 0.03 mm and more, over noise of 0.02 mm.
  EXPECT_GT(budget(coarse, "resolution of the encoders"),
            budget(coarse, "repeatability, from repeats"));
  EXPECT_GT(budget(coarse, "resolution of the encoders"), budget(coarse, "noise of the rows"));
}

TEST(Uncertainty, IsGreaterWhereAControllerTakesItsUsualParametersAlone) {
  const auto robot = robot_of(kRx90);
  Random random(9);
  const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
  const Session session = make_session(*robot, truth, tracked(150), 20e-6, random);
  const Solution solution = identify(*robot, session.data);
  const ControllerSigma takes = controller_sigma(*robot, session.data, solution);
  EXPECT_LT(takes.parameters.size(), robot->parameters().size() - 6);
  EXPECT_NEAR(takes.sigma, std::hypot(takes.left, solution.workspace.rms), 1e-12);
  // Axes askew by a milliradian, a metre from the tool, are what it cannot follow.
  EXPECT_GT(takes.left, 0.1e-3);
  EXPECT_LT(takes.left, 5e-3);
  // A robot that is off in what it takes alone is followed to the end.
  Solution simple = solution;
  simple.values = nominal_values(*robot);
  for (const std::string& name : takes.parameters)
    simple.values[find_parameter(*robot, name)] += 1e-3;
  EXPECT_LT(controller_sigma(*robot, session.data, simple).left, 1e-7);
}

}  // namespace
}  // namespace selfcal::recovery
