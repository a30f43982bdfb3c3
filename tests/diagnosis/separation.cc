// How far rows hold two causes apart: row by row it comes to what all of them say together.
#include "diagnosis/report/separation.h"

#include <gtest/gtest.h>

#include "diagnosis/report/candidate_rows.h"
#include "diagnosis/report/row_choice.h"
#include "tests/diagnosis/two_sessions.h"

namespace selfcal {
namespace {

// Rounding over the ridge that holds what no row tells, 1e-16 / 1e-5^2, and some hundred
// operations.
constexpr double kRounding = 1e-4;

class SeparationOfAnArm : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    data_ = std::make_unique<DataSet>(TwoSessions(30).before);
    Observations& rows = data_->rows;
    rows.velocity = Eigen::MatrixXd::Constant(rows.q.rows(), rows.q.cols(), 0.1);
    for (Eigen::Index row = 0; row < rows.q.rows(); row += 2) rows.velocity.row(row) *= -1;
    linearised_ =
        std::make_unique<LinearisedModel>(TwoSessions(2).robot, *data_, quick(), Progress{});
    both_ = std::make_unique<DataSet>(candidate_rows(*linearised_, *data_).front().both);
  }
  static void TearDownTestSuite() {
    both_.reset();
    linearised_.reset();
    data_.reset();
  }

  static std::vector<Node> backlash() {
    return {recovery::entry({{"effect", "backlash"}, {"at", "j3"}, {"play", "2.0e-5"}})};
  }
  static std::vector<Node> coupling() {
    return {recovery::entry(
        {{"effect", "joint_coupling"}, {"at", "j3"}, {"from", "j2"}, {"kappa_j2", "2.0e-5"}})};
  }
  static int first() { return data_->rows.rows(); }

  static inline std::unique_ptr<DataSet> data_, both_;
  static inline std::unique_ptr<LinearisedModel> linearised_;
};

TEST_F(SeparationOfAnArm, GrowsByWhatEachRowSaysThatItAdds) {
  Separation causes(*linearised_, backlash(), coupling(), *both_, first());
  for (int row = first(); row < both_->rows.rows(); ++row) {
    const double before = causes.apart(), gain = causes.gain(row);
    EXPECT_GE(gain, 0);
    causes.take(row);
    EXPECT_NEAR(causes.apart(), before + gain, kRounding * (1 + before + gain)) << row;
  }
}

TEST_F(SeparationOfAnArm, ComesToTheSameInAnyOrder) {
  Separation up(*linearised_, backlash(), coupling(), *both_, first()), down = up;
  up.take_all();
  for (int row = both_->rows.rows(); row-- > first();) down.take(row);
  EXPECT_NEAR(up.apart(), down.apart(), kRounding * (1 + up.apart()));
}

TEST_F(SeparationOfAnArm, ChoosesRowsThatTellMoreThanTheFirstOnes) {
  const RowChoice choice =
      choose_rows(*linearised_, *both_, first(), {{backlash(), coupling(), 0.5}}, 4);
  Separation chosen(*linearised_, backlash(), coupling(), *both_, first()), any = chosen;
  for (const int row : choice.rows) chosen.take(row);
  for (int i = 0; i < static_cast<int>(choice.rows.size()); ++i) any.take(first() + i);
  EXPECT_GE(chosen.apart(), any.apart());
}

}  // namespace
}  // namespace selfcal
