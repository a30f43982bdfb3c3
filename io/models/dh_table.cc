#include "io/models/dh_table.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "io/files/cell_numbers.h"
#include "io/files/csv.h"
#include "io/files/file.h"
#include "io/files/units.h"
#include "io/files/utf8.h"
#include "kinematics/description.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostTableBytes = std::size_t{1} << 20;

std::string lower(std::string_view text) {
  std::string list(text);
  std::ranges::transform(list, list.begin(), [](unsigned char c) { return std::tolower(c); });
  return list;
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(' ') - first + 1));
}

/// A heading: its name in small letters, and what stands in brackets behind it.
struct Heading {
  std::string name, unit;
};
Heading heading_of(std::string_view cell) {
  const auto open = cell.find_first_of("[(");
  if (open == std::string_view::npos) return {lower(trimmed(cell)), {}};
  const auto close = cell.find_first_of("])", open);
  const std::size_t length = close == std::string_view::npos ? close : close - open - 1;
  return {lower(trimmed(cell.substr(0, open))), trimmed(cell.substr(open + 1, length))};
}

/// What a column is of a frame, in the robot file's words.
/// An offset is of the joint's own variable: an angle of one that turns, a length of one that
/// slides.
enum class Place { name, type, alpha, along_x, theta, along_z, offset, least, most, passed_over };

bool is_number(Place place) {
  return place != Place::name && place != Place::type && place != Place::passed_over;
}

const std::map<std::string, Place>& places() {
  static const std::map<std::string, Place> list{
      {"joint", Place::name},  {"name", Place::name},     {"i", Place::name},
      {"j", Place::name},      {"link", Place::name},     {"type", Place::type},
      {"alpha", Place::alpha}, {"a", Place::along_x},     {"r", Place::along_z},
      {"theta", Place::theta}, {"offset", Place::offset}, {"theta offset", Place::theta},
      {"min", Place::least},   {"lower", Place::least},   {"max", Place::most},
      {"upper", Place::most},  {"", Place::passed_over},
  };
  return list;
}

struct Column {
  Place place = Place::passed_over;
  std::string unit;
};

class Table {
 public:
  std::optional<RowFault> take_header(Cells cells, char separator) {
    numbers_.begin(separator);
    std::vector<Heading> headings;
    for (const std::string_view cell : cells) headings.push_back(heading_of(cell));
    const bool has_a = std::ranges::find(headings, "a", &Heading::name) != headings.end();
    const bool has_r = std::ranges::find(headings, "r", &Heading::name) != headings.end();
    if (has_a && has_r)
      return RowFault{"has columns a and r: of a and d, or of d and r, one pair is meant"};
    for (std::size_t i = 0; i < headings.size(); ++i) {
      const std::string& name = headings[i].name;
      Place place = has_r ? Place::along_x : Place::along_z;  // of a column d
      if (name != "d") {
        const auto found = places().find(name);
        if (found == places().end())
          return RowFault{"is none of joint, alpha, a, d, r, theta, type, min and max", i};
        place = found->second;
      }
      if (is_number(place) && std::ranges::find(columns_, place, &Column::place) != columns_.end())
        return RowFault{"says the same as an earlier one", i};
      columns_.push_back({place, headings[i].unit});
    }
    for (const auto& [place, what] :
         {std::pair{Place::alpha, "alpha"}, std::pair{Place::along_x, "a (or d beside r)"},
          std::pair{Place::along_z, "d (or r)"}})
      if (std::ranges::find(columns_, place, &Column::place) == columns_.end())
        return RowFault{std::string("no column ") + what + ": a table has alpha, a and d"};
    return std::nullopt;
  }

  std::optional<RowFault> take_row(Cells cells, int row) {
    std::string name = "j" + std::to_string(row), type = "revolute";
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (columns_[i].place == Place::name && !cells[i].empty()) name = named(cells[i]);
      if (columns_[i].place != Place::type || cells[i].empty()) continue;
      const auto kind = type_of(lower(cells[i]));
      if (!kind) return RowFault{"expected revolute, prismatic or fixed", i};
      type = *kind;
    }
    std::map<Place, double> number;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!is_number(columns_[i].place) || cells[i].empty()) continue;
      const auto value = value_of(cells[i], columns_[i], type == "prismatic", i);
      if (!value) return value.error();
      number[columns_[i].place] = *value;
    }
    if (number.contains(Place::least) != number.contains(Place::most))
      return RowFault{"has one of min and max, where limits are both"};
    if (number.contains(Place::least) && number[Place::least] >= number[Place::most])
      return RowFault{"has a min that is not below its max"};
    number[type == "prismatic" ? Place::along_z : Place::theta] += number[Place::offset];
    Node frame = Node::map();
    frame.set("name", Node::of(name)).set("joint", Node::of(type));
    for (const auto& [place, key] :
         {std::pair{Place::alpha, "alpha"}, std::pair{Place::along_x, "d"},
          std::pair{Place::theta, "theta"}, std::pair{Place::along_z, "r"}})
      if (number[place] != 0) frame.set(key, Node::of(number[place]));
    if (number.contains(Place::least) && number.contains(Place::most) && type != "fixed")
      frame.set("limits", Node::of(std::vector<double>{number[Place::least], number[Place::most]}));
    frames_.push_back(std::move(frame));
    return std::nullopt;
  }

  std::vector<Node> frames() && { return std::move(frames_); }

 private:
  /// A joint called 3 is j3: a name is no number.
  static std::string named(std::string_view cell) {
    std::string name(cell);
    std::ranges::replace_if(
        name, [](char c) { return c == ' ' || c == '.' || c == '*'; }, '_');
    return std::isdigit(static_cast<unsigned char>(name.front())) ? "j" + name : name;
  }

  static std::optional<std::string> type_of(const std::string& cell) {
    for (const char* kind : {"revolute", "prismatic", "fixed"})
      if (cell == kind || cell == std::string(1, kind[0])) return kind;
    return std::nullopt;
  }

  tl::expected<double, RowFault> value_of(std::string_view cell, const Column& column, bool slides,
                                          std::size_t at) {
    const auto number = numbers_.read(cell);
    if (!number) return tl::unexpected(RowFault{number.error(), at});
    const bool of_variable = column.place == Place::least || column.place == Place::most ||
                             column.place == Place::offset;
    const bool length =
        column.place == Place::along_x || column.place == Place::along_z || (of_variable && slides);
    const Dimension dimension = length ? Dimension::length : Dimension::angle;
    if (column.unit.empty()) return sane(*number, dimension, at);
    // A column of limits or offsets has one unit: that of the joints that turn does not fit one
    // that slides.
    const auto unit = unit_of(column.unit, dimension);
    if (!unit)
      return tl::unexpected(
          RowFault{"the unit " + column.unit + " is none of " + units_in_words(dimension), at});
    return sane(*number * unit->factor, dimension, at);
  }

  static tl::expected<double, RowFault> sane(double value, Dimension dimension, std::size_t at) {
    const bool length = dimension == Dimension::length;
    const double most = length ? kLongestPart : kMostTurned;
    if (std::abs(value) <= most) return value;
    return tl::unexpected(
        RowFault{length ? "expected metres, at most " + format_number(most) +
                              " (millimetres? say so in the heading: a [mm])"
                        : std::string("expected radians, at most four turns (degrees? say so in "
                                      "the heading: alpha [deg])"),
                 at});
  }

  CellNumbers numbers_{written_number};
  std::vector<Column> columns_;
  std::vector<Node> frames_;
};

/// The line of the names: what stands above it behind # is for people.
Result<int> header_line(const std::filesystem::path& path) {
  const auto bytes = read_file(path, kMostTableBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  Utf8Pieces pieces;
  const std::string_view text = pieces.take(*bytes);
  int line = 1;
  for (std::size_t at = 0; at < text.size() && text[at] == '#'; ++line) {
    at = text.find('\n', at);
    if (at == std::string_view::npos) break;
    ++at;
  }
  return line;
}

}  // namespace

Result<Node> read_dh_table(const std::filesystem::path& path, const std::string& convention) {
  const auto header = header_line(path);
  if (!header) return tl::unexpected(header.error());
  Table table;
  const Result<bool> read = read_csv(
      path,
      [&](Cells cells, std::optional<char> separator) {
        return table.take_header(cells, separator.value_or(','));
      },
      [&](Cells cells, int row) { return table.take_row(cells, row); }, *header);
  if (!read) return tl::unexpected(read.error());
  Node frames = Node::list();
  frames.items = std::move(table).frames();
  Node robot = Node::map();
  robot.set("robot", Node::of(path.stem().string()))
      .set("kind", Node::of(std::string("serial")))
      .set("convention", Node::of(convention))
      .set("frames", std::move(frames));
  return robot;
}

}  // namespace selfcal
