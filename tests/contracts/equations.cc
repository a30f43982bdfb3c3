// The whole system against a dense one from central differences: R^T R = W^T W once the groups'
// columns are eliminated, that is the Schur complement.
#include "constraints/equations/equations.h"

#include <gtest/gtest.h>

#include "constraints/identifiability/excitation.h"
#include "kinematics/linear_algebra.h"
#include "tests/contracts/equations_case.h"

namespace selfcal {
namespace {

// W by differences of step 1e-6 errs by 1e-9 (rounding, metres) over the sigmas of 0.02, 5e-8;
// third derivatives of the unknown device frames are of the same size. Products are compared
// relative to the longest column, where 1e-6 leaves a factor of 20.
constexpr double kRelative = 1e-6;

Eigen::MatrixXd gram(const Eigen::MatrixXd& A) { return A.transpose() * A; }

/// W^T W over [global | Delta Y] after eliminating the columns [global, global + local).
Eigen::MatrixXd schur(const Eigen::MatrixXd& W, int global) {
  const Eigen::Index local = W.cols() - 1 - global;
  Eigen::MatrixXd kept(W.rows(), global + 1);
  kept << W.leftCols(global), W.rightCols(1);
  return gram(beyond(W.middleCols(global, local), kept));
}

/// Largest difference of two Gram matrices, each entry relative to its two columns' lengths before
/// the elimination.
double difference(const Eigen::MatrixXd& N, const Eigen::MatrixXd& M,
                  const Eigen::VectorXd& lengths) {
  double most = 0;
  for (Eigen::Index i = 0; i < N.rows(); ++i)
    for (Eigen::Index j = 0; j < N.cols(); ++j)
      most = std::max(most, std::abs(N(i, j) - M(i, j)) / ((lengths[i] + 1) * (lengths[j] + 1)));
  return most;
}

void expect_dense_system(const EquationsCase& made) {
  const Equations equations(*made.robot, made.data, Use::fit);
  const Linearised at = equations.linearise(made.state, made.weighting);
  const int global = equations.columns();
  const Eigen::MatrixXd W = made.dense(equations);
  Eigen::VectorXd lengths(global + 1);
  lengths << W.leftCols(global).colwise().norm().transpose(), W.rightCols(1).norm();
  ASSERT_EQ(at.R.rows(), global + 1);
  ASSERT_EQ(at.R.cols(), global + 1);
  EXPECT_TRUE(at.R.isUpperTriangular(0));
  EXPECT_LT(difference(gram(at.R), schur(W, global), lengths), kRelative);
}

TEST(Equations, HaveTheProductOfTheDenseSystem) {
  EquationsCase made(1);
  made.weighting.soft_quantile = 1 - 1e-12;  // nothing is weighed down
  expect_dense_system(made);
}

TEST(Equations, HaveTheProductOfTheDenseSystemOfWholePoses) {
  EquationsCase made(8, arm_of_whole_poses());
  made.weighting.soft_quantile = 1 - 1e-12;
  expect_dense_system(made);
}

TEST(Equations, WeighDownFarRowsAndLeaveOutThosePutAside) {
  EquationsCase made(2);
  made.weighting.soft_quantile = 0.5;  // about half of the rows are beyond
  for (int row = 0; row < made.data.rows.rows(); row += 7) made.weighting.outlier[row] = 1;
  const Equations equations(*made.robot, made.data, Use::fit);
  const Eigen::VectorXd weights = made.root_weights(equations);
  ASSERT_TRUE((weights.array() == 0).any());
  ASSERT_TRUE((weights.array() == 1).any());
  ASSERT_TRUE((weights.array() > 0 && weights.array() < 1).any());
  expect_dense_system(made);
}

TEST(Equations, LoseNothingWhereOneOfTwoLinkedGroupsHasNoRowThatCounts) {
  constexpr int kSockets = 3;  // of the case's sets
  for (const int silent : {0, 1}) {
    EquationsCase made(10);
    made.weighting.soft_quantile = 1 - 1e-12;
    for (int row = 0; row < made.data.rows.rows(); ++row)
      if (made.data.rows.set[row] == kSockets && made.data.rows.group[row] == silent)
        made.weighting.outlier[row] = 1;
    expect_dense_system(made);
  }
}

TEST(Equations, CostTheSquaresWithinTheQuantileAndLinesBeyond) {
  EquationsCase made(3);
  made.weighting.soft_quantile = 0.5;
  made.weighting.outlier[3] = 1;
  const Equations equations(*made.robot, made.data, Use::fit);
  const Linearised at = equations.linearise(made.state, made.weighting);
  double cost = 0;
  int scalars = 0, rows = 0;
  for (const RowResidual& row : equations.residuals(made.state)) {
    const int count = row.lengths + row.angles;
    rows += count;
    if (made.weighting.outlier[row.row]) continue;
    const double t = row.sigmas(made.weighting.scale[row.set]), soft = chi_quantile(count, 0.5);
    cost += t <= soft ? t * t : 2 * soft * t - soft * soft;  // Huber
    scalars += count;
  }
  const Eigen::VectorXd all = made.residuals(equations, made.state);
  const Eigen::Index beside = all.size() - rows;  // own equations and links
  ASSERT_EQ(beside, 2);
  EXPECT_NEAR(at.cost, cost + all.tail(beside).squaredNorm(), 1e-10 * at.cost);  // rounding
  EXPECT_EQ(at.equations, scalars + 2);
  EXPECT_EQ(at.norms.size(), equations.residuals(made.state).size());
}

TEST(Equations, StepGroupsToWhereTheDenseSystemPutsThem) {
  EquationsCase made(4);
  const Equations equations(*made.robot, made.data, Use::fit);
  const Linearised at = equations.linearise(made.state, made.weighting);
  const Eigen::MatrixXd W = made.dense(equations);
  const int global = equations.columns();
  const Eigen::Index local = W.cols() - 1 - global;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, 0.01);
  Eigen::VectorXd step(global + local);
  for (double& v : step) v = normal(random);
  step.tail(local) = least_squares(W.middleCols(global, local),
                                   W.rightCols(1) - W.leftCols(global) * step.head(global));
  const State expected = made.stepped(equations, step);
  const State found = equations.stepped(made.state, at, step.head(global));
  EXPECT_LT((found.xi - expected.xi).norm(), 1e-15);
  for (size_t s = 0; s < made.data.sets.size(); ++s) {
    EXPECT_LT((found.nuisance[s] - expected.nuisance[s]).norm(), 1e-15) << made.data.sets[s].name;
    // Differences of 5e-8 in W times steps of 0.1 m.
    if (found.groups[s].size() > 0) {
      EXPECT_LT((found.groups[s] - expected.groups[s]).norm(), 1e-7) << made.data.sets[s].name;
    }
  }
}

/// `motions`: shifts along x, y, z and turns about them.
void expect_motions(EquationsCase made, const std::vector<std::string>& motions) {
  made.state.xi = values(*made.robot);  // base frames as in the file: along the world's axes
  const Equations equations(*made.robot, made.data, Use::fit);
  const Eigen::MatrixXd R = equations.linearise(made.state, made.weighting, true).R;
  const int global = equations.columns();
  ASSERT_EQ(R.cols(), global + 6 + equations.known_lengths() + 1);
  for (int i = 0; i < 6; ++i) {
    const int p = find_parameter(*made.robot, motions[i]);
    EXPECT_GT(R.col(p).norm(), 1) << motions[i];
    // Rounding of columns of length 1000.
    EXPECT_LT((R.col(global + i) - R.col(p)).norm(), 1e-10) << motions[i];
  }
}

TEST(Equations, MoveTheWorldAsTheBaseFramesDo) {
  expect_motions(EquationsCase(6), {"d0", "r1", "r0", "alpha0", "beta0", "theta0"});
  expect_motions(EquationsCase(9, arm_of_whole_poses()),
                 {"base.x", "base.y", "base.z", "base.rx", "base.ry", "base.rz"});
}

TEST(Equations, HaveAColumnForEachLengthThatAnEntryGives) {
  // What the residuals gain where a given length is shorter than its entry says, a metre for one.
  constexpr double h = 1e-3;  // lengths are taken as they are: no curvature
  const std::vector<std::pair<int, const char*>> given = {
      {3,
       "s: {method: position-constraint, apart: [{groups: [g0, g1], distance: 0.299,"
       " noise: 0.01}]}"},
      {5,
       "s: {method: plane, parallel_to: {set: table, distance: 0.199, noise: 0.01}}\n"
       "table: {method: plane}"},
      {8, "s: {method: sphere, radius: 0.149}"}};
  EquationsCase made(9);
  const Equations equations(*made.robot, made.data, Use::fit);
  ASSERT_EQ(equations.known_lengths(), 3);
  const Eigen::MatrixXd R = equations.linearise(made.state, made.weighting, true).R;
  const Eigen::MatrixXd W = made.dense(equations);
  const int global = equations.columns();
  const Eigen::Index local = W.cols() - 1 - global;
  Eigen::MatrixXd all(W.rows(), W.cols() + 3);
  all << W.leftCols(global), Eigen::MatrixXd::Zero(W.rows(), 3), W.rightCols(local + 1);
  const Eigen::VectorXd r = made.residuals(equations, made.state);
  for (const auto& [set, text] : given) {
    EquationsCase shorter(9);
    shorter.data.sets[set].method = make_sets(text)[0].method;
    if (set == 8) shorter.state.nuisance[set][3] -= h;
    const Equations then(*shorter.robot, shorter.data, Use::fit);
    const Eigen::VectorXd gain = (shorter.residuals(then, shorter.state) - r) / h;
    all.col(global + equations.known_at(set)) = made.root_weights(equations).cwiseProduct(gain);
  }
  std::vector<int> kept;
  for (int c = 0; c < static_cast<int>(R.cols()); ++c)
    if (c < global || c >= global + 6) kept.push_back(c);
  Eigen::VectorXd lengths(global + 4);
  lengths << all.leftCols(global + 3).colwise().norm().transpose(), all.rightCols(1).norm();
  EXPECT_LT(difference(gram(R(Eigen::all, kept)), schur(all, global + 3), lengths), kRelative);
}

TEST(Equations, HaveTheSameFactorWithAndWithoutMotions) {
  EquationsCase made(7);
  const Equations equations(*made.robot, made.data, Use::fit);
  const Eigen::MatrixXd with = equations.linearise(made.state, made.weighting, true).R;
  const Eigen::MatrixXd without = equations.linearise(made.state, made.weighting).R;
  const int global = equations.columns();
  const Eigen::MatrixXd N = gram(with.leftCols(global)), M = gram(without.leftCols(global));
  EXPECT_LT((N - M).norm(), 1e-13 * M.norm());  // rounding
}

TEST(Equations, NameTheOwnValuesThatCarryAParameterEachWithItsSign) {
  const auto robot = six_axis_arm();
  const std::vector<Set> sets = make_sets("wall: {method: plane}\n");
  const std::vector<char> all(robot->parameters().size(), 1);
  const Identifiability rank = structural(*robot, sets, all, 80, 1).rank;
  const int shift = find_parameter(*robot, "d0");  // of the whole robot along the world's x
  ASSERT_EQ(rank.status[shift], Status::grouped);
  ASSERT_EQ(rank.grouped_with[shift].size(), 1u);  // n and so its x stay: d moves by n_x
  EXPECT_EQ(rank.grouped_with[shift][0].name, "wall.d");
  for (size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(rank.status[i] == Status::grouped, !rank.grouped_with[i].empty());
    for (const Carrier& each : rank.grouped_with[i]) EXPECT_NE(each.name, "wall");
  }
}

}  // namespace
}  // namespace selfcal
