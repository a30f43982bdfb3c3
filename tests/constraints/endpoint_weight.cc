// One matrix in place of the deviations of every pose.
#include <gtest/gtest.h>

#include "constraints/identifiability/endpoint_sigma.h"
#include "constraints/sampling/random_poses.h"
#include "tests/constraints/touch_plan_cell.h"

namespace selfcal {
namespace {

EndpointQuestion question_of_rx90() {
  EndpointQuestion question;
  question.robot = &rx90();
  question.xi = values(rx90());
  question.unseen = Eigen::MatrixXd::Identity(6, 3);
  question.point_unknown = true;
  question.poses = random_poses(rx90(), nullptr, 100, 1);
  return question;
}

Eigen::MatrixXd covariance_of_rx90() {
  const auto parameters = static_cast<Eigen::Index>(rx90().parameters().size());
  const Eigen::MatrixXd L = Eigen::MatrixXd::Random(parameters, parameters) * 1e-3;
  return L * L.transpose();
}

TEST(EndpointWeight, GivesTheRmsOfAnyCovariance) {
  const EndpointDeviations deviations = endpoint_deviations(question_of_rx90());
  const Eigen::MatrixXd C = covariance_of_rx90();
  const double rms = endpoint_sigma(deviations, C).rms;
  EXPECT_GT(rms, 1e-4);
  EXPECT_NEAR(endpoint_rms(deviations.weight, C), rms, 1e-9 * rms);
}

TEST(EndpointWeight, TakesWhatTakesMoreAwayThanItGivesAsNothing) {
  const Eigen::MatrixXd weight = endpoint_deviations(question_of_rx90()).weight;
  EXPECT_EQ(endpoint_rms(weight, -covariance_of_rx90()), 0);
}

TEST(EndpointWeight, IsZeroWithoutPoses) {
  EndpointQuestion question = question_of_rx90();
  question.poses.resize(0, 6);
  EXPECT_EQ(endpoint_rms(endpoint_deviations(question).weight, covariance_of_rx90()), 0);
}

}  // namespace
}  // namespace selfcal
