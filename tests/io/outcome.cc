// Answers and decisions as the store and the messages have them.
#include "io/outcome.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace selfcal {
namespace {

TEST(Outcome, ReadsBackEveryAnswerAndDecisionFromItsText) {
  std::set<std::string_view> texts;
  for (int i = 0; i <= static_cast<int>(ResultAnswer::no_cause); ++i) {
    const auto answer = static_cast<ResultAnswer>(i);
    EXPECT_EQ(parse_answer(to_string(answer)), answer);
    texts.insert(to_string(answer));
  }
  for (int i = 0; i <= static_cast<int>(ResultDecision::rolled_back); ++i) {
    const auto decision = static_cast<ResultDecision>(i);
    EXPECT_EQ(parse_decision(to_string(decision)), decision);
    texts.insert(to_string(decision));
  }
  EXPECT_EQ(texts.size(), 16);
}

TEST(Outcome, HasNoFigureWhereNothingWasComputed) {
  const ResultFigures stored{.p_value = 0, .check_before = 0, .check_after = 0, .touches = 7};
  const ResultFigures failed = known_figures(stored, ResultAnswer::failed);
  EXPECT_TRUE(std::isnan(failed.p_value));
  EXPECT_TRUE(std::isnan(failed.check_before));
  EXPECT_TRUE(std::isnan(failed.check_after));
  EXPECT_TRUE(std::isnan(failed.endpoint_sigma));
  EXPECT_EQ(failed.touches, 7U);
  EXPECT_TRUE(std::isnan(known_figures(stored, ResultAnswer::not_explained).p_value));

  const ResultFigures check{.p_value = 0.4, .check_before = 2e-5, .check_after = 3e-5};
  const ResultFigures told = known_figures(check, ResultAnswer::explained);
  EXPECT_TRUE(std::isnan(told.endpoint_sigma)) << "a check says nothing of it";
  EXPECT_EQ(told.p_value, 0.4);
  EXPECT_EQ(told.check_after, 3e-5);
  EXPECT_EQ(known_figures(stored, ResultAnswer::improved), stored);
}

TEST(Outcome, KnowsNoOtherText) {
  EXPECT_FALSE(parse_answer("better"));
  EXPECT_FALSE(parse_answer(""));
  EXPECT_FALSE(parse_decision("Applied"));
}

}  // namespace
}  // namespace selfcal
