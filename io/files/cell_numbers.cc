// Between semicolons or tabs the comma of a number is a decimal one. A file that has decimal points
// besides may mean thousands by its commas, or by its points.
#include "io/files/cell_numbers.h"

namespace selfcal {

void CellNumbers::begin(char separator) {
  decimal_commas_ = separator != ',';
  commas_ = points_ = false;
}

tl::expected<double, std::string> CellNumbers::read(std::string_view cell) {
  std::string_view text = cell;
  if (decimal_commas_) {
    const std::size_t comma = cell.find(',');
    points_ = points_ || cell.find('.') != std::string_view::npos;
    if (comma != std::string_view::npos) {
      commas_ = true;
      with_point_ = cell;
      with_point_[comma] = '.';
      text = with_point_;
    }
  }
  const auto number = parse_(text);
  if (!number) return tl::unexpected("expected a number, got '" + std::string(cell) + "'");
  if (commas_ && points_)
    return tl::unexpected("decimal commas and decimal points in one file: '" + std::string(cell) +
                          "' may be thousands");
  return *number;
}

}  // namespace selfcal
