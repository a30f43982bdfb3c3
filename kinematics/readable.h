// What people read: numbers without powers of ten, lengths in mm, angles in mrad, ratios in ppm;
// texts of others without what a terminal obeys.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace selfcal {

/// `format`, as printf's, with up to four figures in it; numbers of a thousand and more, up to
/// 1e9, are written out. At most 199 characters.
std::string with_figures(const char* format, double a, double b = 0, double c = 0, double d = 0);

/// So many significant digits, without a power of ten from 1e-6 up to 1e9.
std::string plain_figure(double value, int digits = 3);

/// The unit that a person reads, and by what a number of the SI unit is to be multiplied.
struct ReadableUnit {
  double factor = 1;
  std::string name;
};

/// "m" in mm, "rad" in mrad, "1" in ppm; a compound unit ("rad/(N m)", "m/N", "1/K") with the
/// prefix of its first that makes a figure of one to a thousand of `size` (SI). Others as they are.
ReadableUnit readable_unit(const std::string& unit, double size);

/// "0.0458 mrad": a value of that unit (SI).
std::string in_readable_unit(double value, const std::string& unit);

/// "j1", "j1 and j2", "j1, j2 and j3"; empty of none.
std::string listed(const std::vector<std::string>& names);

/// True where `text` (UTF-8) has a character that a terminal obeys rather than shows: a line's end,
/// an escape. No name has one.
bool has_control(std::string_view text);

/// `text` as a terminal may have it: lines kept, other control characters as '?', and of more than
/// 2000 bytes the first thousand and the last three hundred.
std::string shown(std::string_view text);

}  // namespace selfcal
