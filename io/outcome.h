// What a session came to: the answer of its rows, and what became of the parameters found.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace selfcal {

enum class ResultAnswer : std::uint8_t {
  improved,
  not_improved,
  not_determined,
  explained,      ///< of a check: the active parameters explain its touches
  not_explained,  ///< of a check: they do not
  failed,         ///< it could not be computed
  cause_named,    ///< of a look for the cause: a known effect
  cause_unknown,  ///< structure of no known one
  no_cause,       ///< noise explains what is left
};

enum class ResultDecision : std::uint8_t {
  none,       ///< of a check: there is nothing to decide
  rejected,   ///< by the acceptance decision, or by a person
  candidate,  ///< waits for a person
  applying,   ///< by the acceptance decision alone; begun, and after a power cut still to be done
  applied,
  replaced,     ///< by a newer candidate, before anybody had decided
  rolled_back,  ///< applied, and given up by a person afterwards
};

/// Figures of a session's result, as they are decided on, stored and published.
struct ResultFigures {
  double p_value = 0;         ///< of the paired test, or that the active model explains the touches
  double check_before = 0;    ///< m, rms on rows kept aside with the active model; of a check, what
                              ///< is expected
  double check_after = 0;     ///< m, with the candidate; of a check, of its touches
  double endpoint_sigma = 0;  ///< m, rms over the workspace
  std::uint32_t touches = 0;  ///< that count as rows, those put aside too
  std::uint32_t outliers = 0;    ///< of them put aside when identifying; outliers that judge count
  std::uint32_t identified = 0;  ///< parameters
  bool operator==(const ResultFigures&) const = default;
};

/// NaN where a result of this answer has no such figure.
ResultFigures known_figures(ResultFigures figures, ResultAnswer answer);

/// As the store and the messages have it: "not-improved".
std::string_view to_string(ResultAnswer answer);
std::string_view to_string(ResultDecision decision);
/// Nothing for a text that is none of them.
std::optional<ResultAnswer> parse_answer(std::string_view text);
std::optional<ResultDecision> parse_decision(std::string_view text);

}  // namespace selfcal
