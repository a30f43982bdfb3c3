#include "kinematics/readable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace selfcal {
namespace {

constexpr double kPlainLeast = 1e-6, kPlainMost = 1e9;
constexpr std::size_t kMostShown = 2000, kFirstShown = 1000, kLastShown = 300;  // bytes

/// The first byte at or behind `at` that begins a character (UTF-8, of at most four bytes).
std::size_t start_of_character(std::string_view text, std::size_t at) {
  const std::size_t last = std::min(at + 3, text.size());
  while (at < last && (text[at] & 0xC0) == 0x80) ++at;
  return at;
}

/// The text with each number that has a positive power of ten below kPlainMost written out.
std::string written_out(std::string text) {
  for (std::size_t e = text.find("e+0"); e != std::string::npos; e = text.find("e+0", e)) {
    const auto is_of_number = [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-'; };
    std::size_t first = e;
    while (first > 0 && is_of_number(text[first - 1])) --first;
    std::size_t end = e + 3;
    while (end < text.size() && text[end] >= '0' && text[end] <= '9') ++end;
    const double value = std::strtod(text.substr(first, end - first).c_str(), nullptr);
    if (first == e || !(std::abs(value) < kPlainMost)) {
      ++e;
      continue;
    }
    std::array<char, 32> plain{};
    std::snprintf(plain.data(), plain.size(), "%.0f", value);
    text.replace(first, end - first, plain.data());
    e = first;
  }
  return text;
}

/// Bytes of the control character at the start of `text`, which is not empty; 0 of another one.
std::size_t length_of_control(std::string_view text) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (at(0) < 0x20 || at(0) == 0x7F) return 1;
  // U+0080 to U+009F, an escape's second form among them.
  return at(0) == 0xC2 && text.size() > 1 && at(1) < 0xA0 ? 2 : 0;
}

}  // namespace

std::string with_figures(const char* format, double a, double b, double c, double d) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), format, a, b, c, d);
  return written_out(text.data());
}

std::string plain_figure(double value, int digits) {
  std::array<char, 64> text{};
  const double size = std::abs(value);
  if (!std::isfinite(value) || value == 0 || size < kPlainLeast || size >= kPlainMost) {
    std::snprintf(text.data(), text.size(), "%.*g", digits, value);
    return text.data();
  }
  // As %g does it: the digits count after rounding, and zeros at the end fall away.
  std::snprintf(text.data(), text.size(), "%.*e", digits - 1, value);
  const double rounded = std::strtod(text.data(), nullptr);
  const int whole = static_cast<int>(std::floor(std::log10(std::abs(rounded)) + 1e-9));
  std::snprintf(text.data(), text.size(), "%.*f", std::max(0, digits - 1 - whole), rounded);
  std::string plain = text.data();
  if (plain.find('.') != std::string::npos) {
    plain.erase(plain.find_last_not_of('0') + 1);
    if (plain.back() == '.') plain.pop_back();
  }
  return plain;
}

ReadableUnit readable_unit(const std::string& unit, double size) {
  if (unit == "m") return {1e3, "mm"};
  if (unit == "rad") return {1e3, "mrad"};
  if (unit == "1") return {1e6, "ppm"};
  const std::size_t slash = unit.find('/');
  const std::string first = unit.substr(0, slash);
  if (slash == std::string::npos || !(size > 0)) return {1, unit};
  if (first == "1")
    return size < 0.1 ? ReadableUnit{1e6, "ppm" + unit.substr(1)} : ReadableUnit{1, unit};
  if (first != "m" && first != "rad") return {1, unit};
  constexpr std::array<std::pair<double, const char*>, 3> kPrefixes = {
      {{1e3, "m"}, {1e6, "u"}, {1e9, "n"}}};
  for (const auto& [factor, prefix] : kPrefixes)
    if (factor * size >= 1 || factor == kPrefixes.back().first) return {factor, prefix + unit};
  return {1, unit};
}

std::string in_readable_unit(double value, const std::string& unit) {
  const ReadableUnit readable = readable_unit(unit, std::abs(value));
  const std::string figure = plain_figure(readable.factor * value);
  return readable.name.empty() ? figure : figure + " " + readable.name;
}

bool has_control(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i)
    if (length_of_control(text.substr(i)) > 0) return true;
  return false;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

std::string shown(std::string_view text) {
  const auto without_control = [](std::string_view part) {
    std::string harmless;
    while (!part.empty()) {
      const std::size_t control = part.front() == '\n' ? 0 : length_of_control(part);
      harmless += control > 0 ? '?' : part.front();
      part.remove_prefix(std::max<std::size_t>(control, 1));
    }
    return harmless;
  };
  if (text.size() <= kMostShown) return without_control(text);
  const std::size_t end = start_of_character(text, kFirstShown);
  const std::size_t on = start_of_character(text, text.size() - kLastShown);
  return without_control(text.substr(0, end)) + " … (" + std::to_string(on - end) +
         " bytes left out) … " + without_control(text.substr(on));
}

}  // namespace selfcal
