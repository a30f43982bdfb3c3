// Measurements of real robots: what geometry reaches, what a left-out placement says, and the
// answers that must be no.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/real/real_data.h"

namespace selfcal::real {
namespace {

class RealData : public testing::TestWithParam<Known> {
 protected:
  void SetUp() override { SELFCAL_NEED_SHARED(); }
};

TEST_P(RealData, ReachesTheKnownGeometryWithTheDefaults) {
  const Known known = GetParam();
  const LoadedDataSet loaded = load(known.name);
  const Solution solution = identify(*loaded.robot, loaded.data);
  const Figures check = solution.residual.check;
  std::printf("| %s | %d | %.3g | %.3g | %.3g | %.4g / %.3g | %s, end position %.3g |\n",
              known.name, loaded.data.rows.rows(), known.before, 1e3 * check.rms_before,
              known.geometry, 1e3 * check.rms_after, 1e3 * check.max_after,
              std::string(to_string(solution.verdict.answer)).c_str(), 1e3 * solution.endpoint.rms);
  EXPECT_TRUE(solution.converged) << solution.stop_reason;
  EXPECT_LE(1e3 * check.rms_after, 1.05 * known.geometry);
}

INSTANTIATE_TEST_SUITE_P(Sets, RealData, testing::ValuesIn(kKnown), [](const auto& each) {
  std::string name = each.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

struct Range {
  const char* name;
  double least, most;  // mm, of two other programs
  double held;         // what the defaults, gear ratios held, must reach
};

class LeftOut : public testing::TestWithParam<Range> {
 protected:
  void SetUp() override { SELFCAL_NEED_SHARED(); }
};

TEST_P(LeftOut, PlacementsStayWithinTheKnownRange) {
  Options gears;
  gears.free = {"K*"};
  const double held = 1e3 * left_out(GetParam().name);
  const double freed = 1e3 * left_out(GetParam().name, gears);
  std::printf("| %s | left out, pooled | %.2f to %.2f | %.3f | %.3f |\n", GetParam().name,
              GetParam().least, GetParam().most, held, freed);
  // The range is of two programs; below it is better still. mukca-panda-1 has three placements
  // only, and reaches it where gear ratios are free.
  EXPECT_LE(held, GetParam().held);
  EXPECT_LE(freed, GetParam().most);
}

INSTANTIATE_TEST_SUITE_P(Sets, LeftOut,
                         testing::Values(Range{"mukca-panda-1", 0.74, 0.80, 0.90},
                                         Range{"mukca-panda-3", 0.21, 0.23, 0.23},
                                         Range{"mukca-panda-6", 0.24, 0.28, 0.28},
                                         Range{"mukca-kuka-14", 0.30, 0.35, 0.35}),
                         [](const auto& each) {
                           std::string name = each.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(RealAnswers, ATouchedPatchDoesNotDetermineTheWorkspace) {
  SELFCAL_NEED_SHARED();
  const LoadedDataSet loaded = load("motoman-planes-judged");
  const Solution solution = identify(*loaded.robot, loaded.data);
  EXPECT_EQ(solution.verdict.answer, Answer::not_determined) << solution.verdict.why;
  const auto leica =
      std::find_if(solution.residual.check_by_set.begin(), solution.residual.check_by_set.end(),
                   [](const SetFigures& set) { return set.name == "leica"; });
  ASSERT_NE(leica, solution.residual.check_by_set.end());
  EXPECT_TRUE(leica->aligned);
  std::printf("tracker %.3g to %.3g mm, stated end position %.3g mm\n",
              1e3 * leica->figures.rms_before, 1e3 * leica->figures.rms_after,
              1e3 * solution.endpoint.rms);
  EXPECT_GE(solution.endpoint.rms, leica->figures.rms_after / 2);
}

TEST(RealAnswers, TwentyThreeNoisyRowsDoNotImproveTheRobot) {
  SELFCAL_NEED_SHARED();
  const LoadedDataSet loaded = load("ur10-mocap");
  const Solution solution = identify(*loaded.robot, loaded.data);
  EXPECT_EQ(solution.verdict.answer, Answer::not_improved) << solution.verdict.why;
}

TEST(RealAnswers, NoMovementIsAskedForOfMotionsOfTheWorldWhereDistancesAreKnown) {
  SELFCAL_NEED_SHARED();
  const LoadedDataSet loaded = load("mukca-panda-1");
  for (const Note& note : identify(*loaded.robot, loaded.data).unexcited)
    for (const char* const motion : {"alpha1", "alpha2", "theta2"})
      EXPECT_NE(note.parameter, motion) << note.text;
}

TEST(RealAnswers, AFreedGearRatioThatSwallowsComplianceIsWarnedOfByName) {
  SELFCAL_NEED_SHARED();
  const LoadedDataSet loaded = load("motoman-tracker");
  Options options;
  options.free = {"K*"};
  const Solution solution = identify(*loaded.robot, loaded.data, options);
  const bool warned = std::any_of(
      solution.warnings.begin(), solution.warnings.end(),
      [](const std::string& w) { return w.find("K3 ") == 0 && w.find("tolerances") != w.npos; });
  std::printf("gears free: %.3g mm\n", 1e3 * solution.residual.check.rms_after);
  EXPECT_TRUE(warned) << testing::PrintToString(solution.warnings);
}

}  // namespace
}  // namespace selfcal::real
