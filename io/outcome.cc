#include "io/outcome.h"

#include <array>
#include <cmath>

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

ResultFigures known_figures(ResultFigures figures, ResultAnswer answer) {
  const double none = std::nan("");
  const bool check = answer == ResultAnswer::explained || answer == ResultAnswer::not_explained;
  const bool failed = answer == ResultAnswer::failed;
  if (failed) figures.check_before = figures.check_after = none;
  if (failed || check) figures.endpoint_sigma = none;
  // What nothing was compared with has no probability.
  if (failed || (check && !(figures.check_before > 0))) figures.p_value = none;
  return figures;
}

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
