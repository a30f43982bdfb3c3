// Numbers are written with the fewest digits that read back as the same bits (std::to_chars) and
// read without regard to the locale (std::from_chars). An exponent always follows a decimal point
// ("1.0e-04"), because YAML 1.1 readers take "1e-04" for a text.
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "kinematics/description.h"

namespace selfcal {
namespace {

std::string_view without_blanks(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

/// A number without a sign.
std::optional<double> plain_number(std::string_view text) {
  if (text.starts_with('+') || text.starts_with('-')) return std::nullopt;
  return parse_number(text);
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const bool plus = text.starts_with('+') && !text.starts_with("+-");
  const char* const first = text.data() + (plus ? 1 : 0);
  const char* const last = text.data() + text.size();
  double number = 0;
  const auto [end, error] = std::from_chars(first, last, number);
  if (error != std::errc() || end != last || !std::isfinite(number)) return std::nullopt;
  return number + 0.0;  // no negative zero
}

std::optional<double> written_number(std::string_view text) {
  const std::size_t at = text.find("pi");
  if (at == std::string_view::npos) return parse_number(text);
  std::string_view before = text.substr(0, at), after = text.substr(at + 2);
  double number = std::numbers::pi;
  if (before.starts_with('-')) number = -number;
  if (before.starts_with('-') || before.starts_with('+')) before.remove_prefix(1);
  if (!before.empty()) {
    before = without_blanks(before);
    if (!before.ends_with('*')) return std::nullopt;
    const auto factor = plain_number(without_blanks(before.substr(0, before.size() - 1)));
    if (!factor) return std::nullopt;
    number *= *factor;
  }
  if (!after.empty()) {
    after = without_blanks(after);
    if (!after.starts_with('/')) return std::nullopt;
    const auto divisor = plain_number(without_blanks(after.substr(1)));
    if (!divisor) return std::nullopt;
    number /= *divisor;
  }
  return std::isfinite(number) ? std::optional(number + 0.0) : std::nullopt;
}

std::string format_number(double number) {
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  std::string text(buffer.data(), end);
  const std::size_t exponent = text.find('e');
  if (exponent != std::string::npos && text.find('.') == std::string::npos) {
    text.insert(exponent, ".0");
  }
  return text;
}

}  // namespace selfcal
