// The numbers in one file's cells, where commas may be decimal ones.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "kinematics/description.h"

namespace selfcal {

/// Reads one cell after the other, over and over in the same memory.
class CellNumbers {
 public:
  using Parse = std::optional<double>(std::string_view text);

  /// `parse` reads a number with a decimal point.
  explicit CellNumbers(Parse& parse = parse_number) : parse_(parse) {}

  /// Of a file whose cells `separator` parts: unless it is a comma, commas may stand in numbers.
  void begin(char separator);
  /// The cell's number, or what was expected in its place.
  tl::expected<double, std::string> read(std::string_view cell);

 private:
  Parse& parse_;
  bool decimal_commas_ = false;
  bool commas_ = false, points_ = false;  // seen in numbers where both may stand
  std::string with_point_;                // a number with a decimal comma, rewritten
};

}  // namespace selfcal
