// Many small gains do not outvote one great loss.
#include "constraints/judgement.h"

#include <gtest/gtest.h>

namespace selfcal {
namespace {

constexpr double kMicrometre = 1e-6;

struct Rows {
  /// `count` rows of a set whose residual goes from `before` to `after` (m).
  void add(int set, int count, double before, double after) {
    for (int i = 0; i < count; ++i) {
      RowResidual row;
      row.row = static_cast<int>(nominal.check.size());
      row.set = set;
      row.lengths = 1;
      row.length = before + i * kMicrometre / 100;  // no ties
      nominal.check.push_back(row);
      row.length = after + i * kMicrometre / 50;
      calibrated.check.push_back(row);
      residual.check_rows.push_back({row.length, false});
      ++residual.check.rows;
    }
  }

  Answer answer() {
    nominal.aligned = calibrated.aligned = {0, 1};  // the second set only judges
    EndpointSigma known;
    known.rms = kMicrometre;
    return verdict(nominal, calibrated, residual, known, 1e-3, true, false).answer;
  }

  Judged nominal, calibrated;
  Residuals residual;
};

TEST(Verdict, IsImprovedWhereTheRowsAreMetBetter) {
  Rows rows;
  rows.add(0, 60, 100 * kMicrometre, 30 * kMicrometre);
  rows.add(1, 10, 200 * kMicrometre, 150 * kMicrometre);
  EXPECT_EQ(rows.answer(), Answer::improved);
}

TEST(Verdict, IsNotImprovedWhereTheSquaresGrow) {
  Rows rows;
  rows.add(0, 60, 100 * kMicrometre, 90 * kMicrometre);
  rows.add(0, 5, 100 * kMicrometre, 3000 * kMicrometre);
  EXPECT_EQ(rows.answer(), Answer::not_improved);
}

TEST(Verdict, IsNotImprovedWhereASetThatOnlyJudgesIsMetWorse) {
  Rows rows;
  rows.add(0, 60, 500 * kMicrometre, 30 * kMicrometre);
  rows.add(1, 10, 200 * kMicrometre, 300 * kMicrometre);
  EXPECT_EQ(rows.answer(), Answer::not_improved);
}

}  // namespace
}  // namespace selfcal
