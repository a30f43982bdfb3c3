// What a search leaves of the sets of causes that it has visited, from weights by hand.
#include "diagnosis/evidence/posterior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace selfcal {
namespace {

/// Structure 0 is noise alone, 1 none of a known cause.
class PosteriorOfSets : public testing::Test {
 protected:
  PosteriorOfSets() {
    candidates_.list = {{.effect = "backlash", .at = "j1"},
                        {.effect = "backlash", .at = "j2"},
                        {.effect = "backlash", .at = "j2"},  // in another shape
                        {.effect = "base_drift", .at = "base", .meant = 0.5}};
    add({}, 0, 1);
    add({0}, 0, 4);
    add({1, 2}, 0, 2);
    add({3}, 0, 2);
    add({}, 1, 6);
    add({0}, 1, 5);
  }

  void add(const std::vector<int>& set, int structure, double weight) {
    CompactHypothesis each{.structure = structure};
    for (const int c : set) each.add(c, 1);
    each.log_weight = std::log(weight);
    visited_.push_back(each);
  }

  Posterior posterior() {
    const CauseNumbers numbers(candidates_);
    return posterior_of(visited_, {candidates_, numbers, {0, 1}});
  }

  Candidates candidates_;
  std::vector<CompactHypothesis> visited_;
};

TEST_F(PosteriorOfSets, CountsASetOnceForEachOfItsCauses) {
  const Posterior all = posterior();
  EXPECT_NEAR(all.log_total, std::log(20.0), 1e-12);
  EXPECT_NEAR(all.none, 1 / 20.0, 1e-12);
  EXPECT_NEAR(all.cause.at({"backlash", "j1"}), 9 / 20.0, 1e-12);
  EXPECT_NEAR(all.cause.at({"backlash", "j2"}), 2 / 20.0, 1e-12);
  EXPECT_NEAR(all.family.at("backlash"), 11 / 20.0, 1e-12);
  // Half of what may be a drift is not.
  EXPECT_NEAR(all.cause.at({"base_drift", "base"}), 1 / 20.0, 1e-12);
  EXPECT_NEAR(all.unknown, 12 / 20.0, 1e-12);
  ASSERT_EQ(all.hypotheses.size(), 6u);
  EXPECT_EQ(all.hypotheses.front().structure, 1);
  EXPECT_TRUE(all.hypotheses.front().candidates.empty());
}

TEST_F(PosteriorOfSets, SharesAmongTheRestWhatStructureHad) {
  const Posterior all = posterior();
  const CauseNumbers numbers(candidates_);
  const Posterior rest = with_less_structure(all, 0, {candidates_, numbers, {0, 1}});
  EXPECT_NEAR(rest.none, 1 / 9.0, 1e-12);
  EXPECT_NEAR(rest.cause.at({"backlash", "j1"}), 4 / 9.0, 1e-12);
  EXPECT_NEAR(rest.unknown, 1 / 9.0, 1e-12);  // the half of a drift that is none
  EXPECT_EQ(rest.hypotheses.size(), 4u);
  EXPECT_NEAR(rest.log_total, all.log_total, 1e-12);
}

TEST_F(PosteriorOfSets, LeavesStructureTheShareThatIsKept) {
  const Posterior all = posterior();
  const CauseNumbers numbers(candidates_);
  const Posterior some = with_less_structure(all, 0.4, {candidates_, numbers, {0, 1}});
  EXPECT_NEAR(some.none, 0.4 * all.none + 0.6 / 9, 1e-12);
  EXPECT_NEAR(some.cause.at({"backlash", "j1"}), 0.4 * 9 / 20 + 0.6 * 4 / 9, 1e-12);
  EXPECT_NEAR(some.unknown, 0.4 * all.unknown + 0.6 / 9, 1e-12);
}

}  // namespace
}  // namespace selfcal
