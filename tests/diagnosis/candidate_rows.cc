// Rows to measure next are what their words say.
#include "diagnosis/report/candidate_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "diagnosis/findings.h"
#include "kinematics/make_robot.h"
#include "kinematics/rotation.h"
#include "tests/diagnosis/two_sessions.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

/// Made once: it takes seconds.
class Arm {
 public:
  Arm() : data_(TwoSessions().before), robot_(TwoSessions().robot) {
    const Eigen::Index rows = data_.rows.q.rows(), joints = data_.rows.q.cols();
    data_.rows.velocity = Eigen::MatrixXd::Constant(rows, joints, 0.1);
    data_.rows.wrench.setZero(rows, 6);
    data_.rows.wrench.col(0).setConstant(30);
    linearised_ = std::make_unique<LinearisedModel>(robot_, data_, DiagnosisOptions{}, Progress{});
    all_ = candidate_rows(*linearised_, data_);
  }

  const DataSet& having(const std::string& words) const {
    for (const CandidateRows& each : all_)
      if (each.what.find(words) != std::string::npos) return each.both;
    ADD_FAILURE() << words;
    return all_.front().both;
  }

  Eigen::Isometry3d tip(const Eigen::VectorXd& q) const {
    return robot_with_values()->statics()->link_poses(q).back();
  }

  /// The geometry as it was fitted.
  std::shared_ptr<const Robot> robot_with_values() const {
    Problems problems;
    return make_robot(
        linearised_->geometry().text().describe(linearised_->adjusted().fitted.state.xi), problems);
  }

  /// How far the tip is from that of the nearest row at hand (m), and where that is.
  double nearest_tip(const Eigen::Isometry3d& there, Eigen::Isometry3d& of) const {
    double least = INFINITY;
    for (Eigen::Index row = 0; row < data_.rows.q.rows(); ++row) {
      const Eigen::Isometry3d each = tip(data_.rows.q.row(row).transpose());
      const double far = (each.translation() - there.translation()).norm();
      if (far >= least) continue;
      least = far;
      of = each;
    }
    return least;
  }

  DataSet data_;
  std::shared_ptr<const Robot> robot_;
  std::unique_ptr<LinearisedModel> linearised_;
  std::vector<CandidateRows> all_;
};

class FurtherRowsOfAnArm : public testing::Test {
 protected:
  static void SetUpTestSuite() { arm_ = std::make_unique<Arm>(); }
  static void TearDownTestSuite() { arm_.reset(); }
  static inline std::unique_ptr<Arm> arm_;
  const Arm& arm() const { return *arm_; }
};

TEST_F(FurtherRowsOfAnArm, RollTheToolAtTheSamePoint) {
  const DataSet& both = arm().having("tool rolled");
  const Eigen::Index first = arm().data_.rows.q.rows();
  ASSERT_GE(both.rows.q.rows() - first, 3);
  for (Eigen::Index row = first; row < both.rows.q.rows(); ++row) {
    const Eigen::Isometry3d there = arm().tip(both.rows.q.row(row).transpose());
    Eigen::Isometry3d before;
    EXPECT_LT(arm().nearest_tip(there, before), 1e-9);
    const Eigen::Matrix3d turn = before.linear().transpose() * there.linear();
    EXPECT_LT((turn.col(2) - Eigen::Vector3d::UnitZ()).norm(), 1e-9) << "about the tool's axis";
    EXPECT_LT(turn.trace(), 1 + 1e-9) << "by a quarter turn at least";
    // 30 N along the tool's x before; where it points in the world is as it was.
    const Eigen::Vector3d force = both.rows.wrench.row(row).head<3>().transpose();
    EXPECT_LT((there.linear() * force - before.linear() * Eigen::Vector3d(30, 0, 0)).norm(), 1e-6);
  }
}

TEST_F(FurtherRowsOfAnArm, ReachTheSameLocationInAnotherPosture) {
  const DataSet& both = arm().having("in another posture");
  const Eigen::Index first = arm().data_.rows.q.rows();
  ASSERT_GE(both.rows.q.rows() - first, 3);
  for (Eigen::Index row = first; row < both.rows.q.rows(); ++row) {
    const Eigen::VectorXd q = both.rows.q.row(row).transpose();
    Eigen::Isometry3d before;
    EXPECT_LT(arm().nearest_tip(arm().tip(q), before), 1e-9);
    EXPECT_LT((before.linear() - arm().tip(q).linear()).norm(), 1e-9);
    double nearest = INFINITY;
    for (Eigen::Index other = 0; other < first; ++other)
      nearest =
          std::min(nearest, (arm().data_.rows.q.row(other).transpose() - q).cwiseAbs().maxCoeff());
    EXPECT_GE(nearest, 0.3);
    for (int j = 0; j < q.size(); ++j) {
      const Joint& joint = arm().robot_->joints()[static_cast<size_t>(j)];
      if (!joint.limited()) continue;
      EXPECT_GE(q[j], joint.lower);
      EXPECT_LE(q[j], joint.upper);
    }
  }
}

TEST_F(FurtherRowsOfAnArm, LoadTheToolBesideWhatItHolds) {
  const DataSet& both = arm().having("with a payload within");
  const Eigen::Index last = both.rows.q.rows() - 1;
  const Eigen::Vector3d more =
      arm().tip(both.rows.q.row(last).transpose()).linear() *
      (both.rows.wrench.row(last).head<3>().transpose() - Eigen::Vector3d(30, 0, 0));
  EXPECT_NEAR(more.head<2>().norm(), 0, 1e-6);
  EXPECT_LT(more.z(), -9) << "a kilogram at least, downwards";
}

TEST_F(FurtherRowsOfAnArm, RepeatEachRowAtOnce) {
  const DataSet& both = arm().having("twice at once");
  const Eigen::Index first = arm().data_.rows.q.rows();
  ASSERT_EQ((both.rows.q.rows() - first) % 2, 0);
  for (Eigen::Index row = first; row < both.rows.q.rows(); row += 2) {
    EXPECT_EQ(both.rows.q.row(row), both.rows.q.row(row + 1));
    EXPECT_GE(both.rows.repeat[row], 0);
    EXPECT_EQ(both.rows.repeat[row], both.rows.repeat[row + 1]);
    if (row > first) {
      EXPECT_NE(both.rows.repeat[row], both.rows.repeat[row - 1]);
    }
  }
}

TEST_F(FurtherRowsOfAnArm, ComeFromTheOtherSide) {
  EXPECT_EQ(arm().having("from the other side").rows.velocity.bottomRows(1).maxCoeff(), -0.1);
}

}  // namespace
}  // namespace selfcal
