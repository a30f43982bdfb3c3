// Where the end position counts: what a file may say, and the poses that follow.
#include "constraints/workspace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "constraints/estimation/identification.h"
#include "constraints/sampling/workspace_poses.h"
#include "io/files/yaml.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {
namespace {

Workspace read(const std::string& text, std::string* problem = nullptr) {
  Problems problems;
  const Workspace workspace = read_workspace(*parse_yaml(text, "w"), problems);
  EXPECT_EQ(problems.any(), problem != nullptr) << (problems.any() ? problems.list[0] : "");
  if (problem && problems.any()) *problem = problems.list[0];
  return workspace;
}

TEST(Workspace, PosesLieInTheBoxWithTheToolInTheConeAndWithinTheLimits) {
  const Workspace workspace =
      read("{box: [[0.3, -0.4, 0.1], [0.7, 0.4, 0.6]], approach: [0, 0, -2], cone: 0.8}");
  const Eigen::VectorXd xi = values(rx90());
  const Eigen::MatrixXd q = workspace_poses(rx90(), xi, workspace, {}, 200, 1);
  ASSERT_EQ(q.rows(), 200);
  Eigen::AlignedBox3d reached;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Location X = locate(rx90(), xi, q.row(i).transpose());
    EXPECT_TRUE(within_limits(rx90(), q.row(i).transpose()));
    EXPECT_LT(workspace.box->exteriorDistance(X.p), 2e-6);
    EXPECT_GE((X.R * rx90().tool_axis()).dot(-Eigen::Vector3d::UnitZ()), std::cos(0.8));
    reached.extend(X.p);
  }
  EXPECT_GT((reached.sizes().array() / workspace.box->sizes().array()).minCoeff(), 0.8);
}

TEST(Workspace, HasNoPosesWhereTheRobotDoesNotReach) {
  const Workspace far = read("{box: [[5, 5, 5], [6, 6, 6]]}");
  EXPECT_EQ(workspace_poses(rx90(), values(rx90()), far, {}, 20, 1).rows(), 0);
  EXPECT_EQ(workspace_poses(rx90(), values(rx90()), {}, Eigen::MatrixXd(0, 6), 20, 1).rows(), 0);
}

TEST(Workspace, ThatNoPoseIsInIsTold) {
  Simulated simulated = made(
      "robot: rx90.robot.yaml\nsets: {tracker: {method: position, rows: 60, noise: 2.0e-5}}\n");
  simulated.data.workspace = read("{box: [[5, 5, 5], [6, 6, 6]]}");
  const Solution solution = identify(rx90(), simulated.data);
  EXPECT_NE(solution.verdict.answer, Answer::improved);
  EXPECT_NE(solution.verdict.why.find("no configuration within the joint limits reaches"),
            std::string::npos)
      << solution.verdict.why;
}

TEST(Workspace, IsTheRegionThatTheRowsSpanByDefault) {
  Eigen::MatrixXd rows(2, 6);
  rows << 0, 0.1, 0.2, 0, 0, 0, 1, 0.5, 0.4, 0, 0, 0.3;
  const Eigen::MatrixXd q = workspace_poses(rx90(), values(rx90()), {}, rows, 50, 1);
  ASSERT_EQ(q.rows(), 50);
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Eigen::RowVectorXd on = rows.row(0) + q(i, 0) * (rows.row(1) - rows.row(0));
    EXPECT_LT((q.row(i) - on).norm(), 1e-12);
  }
}

TEST(Workspace, RefusesWhatIsNoBoxOrCone) {
  std::string problem;
  for (const char* text : {"{approach: [0, 0, 1], cone: 1}", "{box: [[0, 0, 0]]}",
                           "{box: [[0, 0, 0], [1, 1, -1]]}", "{box: [[0, 0, 0], [4000, 1, 1]]}",
                           "{box: [[0, 0], [1, 1]]}", "{box: [[0, 0, 0], [1, 1, 1]], cone: 1}",
                           "{box: [[0, 0, 0], [1, 1, 1]], approach: [0, 0, 0], cone: 1}",
                           "{box: [[0, 0, 0], [1, 1, 1]], approach: [0, 0, 1], cone: 4}",
                           "{box: [[0, 0, 0], [1, 1, 1]], boxes: 1}"}) {
    problem.clear();
    read(text, &problem);
    EXPECT_NE(problem.find("workspace"), std::string::npos) << text << ": " << problem;
  }
}

}  // namespace
}  // namespace selfcal
