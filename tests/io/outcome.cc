// Answers and decisions as the store and the messages have them.
#include "io/outcome.h"

#include <gtest/gtest.h>

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
  for (int i = 0; i <= static_cast<int>(ResultDecision::replaced); ++i) {
    const auto decision = static_cast<ResultDecision>(i);
    EXPECT_EQ(parse_decision(to_string(decision)), decision);
    texts.insert(to_string(decision));
  }
  EXPECT_EQ(texts.size(), 15);
}

TEST(Outcome, KnowsNoOtherText) {
  EXPECT_FALSE(parse_answer("better"));
  EXPECT_FALSE(parse_answer(""));
  EXPECT_FALSE(parse_decision("Applied"));
}

}  // namespace
}  // namespace selfcal
