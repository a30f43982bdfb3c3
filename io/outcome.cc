#include "io/outcome.h"

#include <array>

namespace selfcal {
namespace {

// In the order of the enumerations.
constexpr std::array<std::string_view, 9> kAnswers = {
    "improved", "not-improved", "not-determined", "explained", "not-explained",
    "failed",   "cause-named",  "cause-unknown",  "no-cause"};
constexpr std::array<std::string_view, 7> kDecisions = {
    "none", "rejected", "candidate", "applying", "applied", "replaced", "rolled-back"};

template <class E, std::size_t n>
std::optional<E> parse_name(const std::array<std::string_view, n>& names, std::string_view text) {
  for (std::size_t i = 0; i < n; ++i)
    if (names[i] == text) return static_cast<E>(i);
  return std::nullopt;
}

}  // namespace

std::string_view to_string(ResultAnswer answer) {
  return kAnswers[static_cast<std::size_t>(answer)];
}

std::string_view to_string(ResultDecision decision) {
  return kDecisions[static_cast<std::size_t>(decision)];
}

std::optional<ResultAnswer> parse_answer(std::string_view text) {
  return parse_name<ResultAnswer>(kAnswers, text);
}

std::optional<ResultDecision> parse_decision(std::string_view text) {
  return parse_name<ResultDecision>(kDecisions, text);
}

}  // namespace selfcal
