// What the rows that judge are better off without is not in the corrected model.
#include "diagnosis/report/carry_over.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinematics/corrected_robot.h"
#include "tests/diagnosis/two_sessions.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

struct Found {
  Found() {
    const TwoSessions sessions;
    data = sessions.before;
    diagnosis.found = {
        {.what = {"joint_compliance", "j2", {}}, .sigma = {1e-6}, .named = true},
        {.what = {"joint_coupling", "j3", {.from = "j2"}}, .sigma = {1e-3}, .named = false}};
    Problems problems;
    diagnosis.model = correct(sessions.robot, entries_of(diagnosis.found), {}, problems);
    EXPECT_FALSE(problems.any());
  }

  /// Squares of ten rows (mm^2).
  std::string judged_by(double before, double after, double all) {
    diagnosis.validation_rows.clear();
    for (int row = 0; row < 10; ++row)
      diagnosis.validation_rows.push_back({.before = 1e-6 * before,
                                           .after = 1e-6 * after,
                                           .all = 1e-6 * all,
                                           .floor = 1e-6,
                                           .block = row});
    diagnosis.gap = gap_of(diagnosis.validation_rows, 1);
    diagnosis.gap.validated_on = "folds";
    return leave_out_what_does_not_carry_over(data, quick(), diagnosis);
  }

  DataSet data;
  Diagnosis diagnosis;
};

TEST(CarryOver, KeepsWhatLeavesNoMoreOfTheRowsThatJudge) {
  Found found;
  EXPECT_THAT(found.judged_by(100, 16, 9), IsEmpty());
  EXPECT_THAT(found.judged_by(100, 16, 16.5), IsEmpty()) << "by chance";
  EXPECT_EQ(found.diagnosis.found.size(), 2U);
}

TEST(CarryOver, LeavesOutOfTheModelAndTheFiguresWhatLeavesMore) {
  Found found;
  EXPECT_THAT(found.judged_by(100, 16, 36),
              HasSubstr("everything found leaves 6 mm of the rows kept aside, and 4 mm without the "
                        "effect that is not named"));
  EXPECT_EQ(found.diagnosis.found.size(), 1U);
  const auto entries = effect_entries(*found.diagnosis.model);
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_EQ(entries.front().find("effect")->text, "joint_compliance");
  EXPECT_EQ(static_cast<std::size_t>(found.diagnosis.values.size()),
            found.diagnosis.model->parameters().size());
  EXPECT_EQ(found.diagnosis.gap.rms_all, found.diagnosis.gap.rms_after);
  EXPECT_EQ(found.diagnosis.gap.closed_all.fraction, found.diagnosis.gap.closed.fraction);
  EXPECT_EQ(found.diagnosis.gap.validated_on, "folds");
}

TEST(CarryOver, LeavesTheGeometryAloneWhereNothingIsNamed) {
  Found found;
  for (FoundEffect& each : found.diagnosis.found) each.named = false;
  EXPECT_THAT(found.judged_by(4, 4, 3600), HasSubstr("2 effects"));
  EXPECT_TRUE(found.diagnosis.found.empty());
  EXPECT_TRUE(effect_entries(*found.diagnosis.model).empty());
  EXPECT_EQ(found.diagnosis.gap.rms_all, found.diagnosis.gap.rms_before);
}

}  // namespace
}  // namespace selfcal
