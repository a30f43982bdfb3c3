// Does the stated certainty hold? Two halves of one set, calibrated apart, may differ in the end
// position by the root of the sum of the squares of their own sigmas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "constraints/identifiability/endpoint_sigma.h"
#include "constraints/sampling/random_poses.h"
#include "constraints/sampling/workspace_poses.h"
#include "kinematics/linear_algebra.h"
#include "kinematics/rotation.h"
#include "tests/real/real_data.h"

namespace selfcal::real {
namespace {

constexpr int kPoses = 500;
constexpr int kBlock = 10;  // rows

/// The covariance of all parameters as result.json has it.
Eigen::MatrixXd exported(const Robot& robot, const Solution& solution) {
  const auto n = static_cast<Eigen::Index>(robot.parameters().size());
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
  std::vector<int> at;
  for (const std::string& name : solution.covariance_order)
    at.push_back(find_parameter(robot, name));
  for (size_t i = 0; i < at.size(); ++i)
    for (size_t j = 0; j < at.size(); ++j)
      C(at[i], at[j]) =
          solution.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return C;
}

/// A calibration of some rows of a set, all of them to identify.
Solution calibrated(const LoadedDataSet& loaded, const std::vector<int>& rows) {
  DataSet part = loaded.data;
  part.rows = taken(loaded.data.rows, rows);
  std::ranges::fill(part.rows.check, char{0});
  return identify(*loaded.robot, part);
}

struct Pair {
  Solution a, b;
};

/// The share of the stated squares that halves can differ by: a length that contradicts the others
/// is the same in both, and so is the error that it may bring.
double apart_share(const Solution& solution) {
  double squares = 0;
  for (const BudgetLine& line : solution.uncertainty.budget)
    if (line.source == "a length given that is contradicted") squares += line.sigma * line.sigma;
  return 1 - squares / std::pow(solution.workspace.rms, 2);
}

/// Ratio of how far the end positions of the two differ (rms over `poses`) to what they state.
double ratio(const Robot& robot, const Pair& halves, const Eigen::MatrixXd& poses, double* stated) {
  EndpointQuestion question;
  question.robot = &robot;
  question.poses = poses;
  const bool aligned = halves.a.endpoint.aligned || halves.b.endpoint.aligned;
  question.unseen = aligned ? Eigen::MatrixXd::Identity(6, 6) : Eigen::MatrixXd(6, 0);
  double squares = 0;
  for (const Solution* each : {&halves.a, &halves.b}) {
    question.xi = each->values;
    const EndpointSigma sigma =
        endpoint_sigma(endpoint_deviations(question), exported(robot, *each));
    squares += apart_share(*each) * std::pow(sigma.rms, 2);
  }
  Eigen::VectorXd apart(3 * poses.rows());
  Eigen::MatrixXd motion(3 * poses.rows(), 6);
  for (Eigen::Index i = 0; i < poses.rows(); ++i) {
    const Eigen::Vector3d p = locate(robot, halves.a.values, poses.row(i).transpose()).p;
    apart.segment<3>(3 * i) = p - locate(robot, halves.b.values, poses.row(i).transpose()).p;
    motion.middleRows<3>(3 * i) << Eigen::Matrix3d::Identity(), -skew(p);
  }
  if (aligned) apart -= motion * least_squares(motion, apart);
  *stated = std::sqrt(squares);
  return apart.norm() / std::sqrt(static_cast<double>(poses.rows())) / *stated;
}

/// Of a ratio.
struct Bounds {
  double least = 0.5, most = 1.3;  ///< wanted everywhere
};

struct Expected {
  const char* name;
  Bounds blocks_range = {}, blocks_region = {}, halves_range = {}, halves_region = {};
};

class Halves : public testing::TestWithParam<Expected> {
 protected:
  void SetUp() override { SELFCAL_NEED_SHARED(); }
};

TEST_P(Halves, DifferByWhatTheyState) {
  const LoadedDataSet loaded = load(GetParam().name);
  const Robot& robot = *loaded.robot;
  const int rows = loaded.data.rows.rows();
  const Eigen::MatrixXd range = random_poses(robot, &loaded.data.rows, kPoses, 1);
  const Eigen::MatrixXd region =
      workspace_poses(robot, values(robot), {}, loaded.data.rows.q, kPoses, 1);
  for (const bool blocks : {true, false}) {
    std::vector<int> first, second;
    for (int row = 0; row < rows; ++row)
      ((blocks ? row / kBlock % 2 == 0 : row < rows / 2) ? first : second).push_back(row);
    const Pair halves{calibrated(loaded, first), calibrated(loaded, second)};
    double over_range = 0, over_region = 0;
    const double wide = ratio(robot, halves, range, &over_range);
    const double near = ratio(robot, halves, region, &over_region);
    std::printf("| %s | %s | %.2f (%.3g) | %.2f (%.3g) |\n", GetParam().name,
                blocks ? "blocks of ten" : "first, second half", wide, 1e3 * over_range, near,
                1e3 * over_region);
    const Bounds& range_bounds = blocks ? GetParam().blocks_range : GetParam().halves_range;
    const Bounds& region_bounds = blocks ? GetParam().blocks_region : GetParam().halves_region;
    EXPECT_GE(wide, range_bounds.least);
    EXPECT_LE(wide, range_bounds.most);
    EXPECT_GE(near, region_bounds.least);
    EXPECT_LE(near, region_bounds.most);
  }
}

// Where the bounds are others, README.md says why.
INSTANTIATE_TEST_SUITE_P(
    Sets, Halves,
    testing::Values(Expected{"motoman-tracker", {}, {}, {0.5, 2.6}, {0.5, 2.6}},
                    Expected{"ipa-ur10-random", {0.45, 1.3}, {}, {0.45, 1.3}, {}},
                    Expected{"ipa-ur10-joint", {0.3, 1.3}, {0.15, 1.3}, {0.45, 1.3}, {0.5, 1.8}},
                    Expected{"mukca-panda-1"},
                    Expected{"mukca-panda-3", {0.25, 1.3}, {0.3, 1.3}, {}, {}},
                    Expected{"mukca-panda-6", {}, {0.3, 1.3}, {}, {}}, Expected{"mukca-kuka-14"},
                    Expected{"talos-contact"}),
    [](const auto& each) {
      std::string name = each.param.name;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

}  // namespace
}  // namespace selfcal::real
