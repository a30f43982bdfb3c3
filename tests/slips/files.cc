#include "tests/slips/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

#include "kinematics/description.h"
#include "tests/support/text.h"

namespace selfcal::slips {
namespace {

Files::Row cells_of(const std::string& line) {
  Files::Row cells;
  std::istringstream row(line);
  for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
  if (line.ends_with(',')) cells.emplace_back();
  return cells;
}

void write_line(std::ostream& out, const Files::Row& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) out << (i > 0 ? "," : "") << cells[i];
  out << "\n";
}

}  // namespace

Files::Files(const std::filesystem::path& folder) : data_set(text_of(folder / "dataset.yaml")) {
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (const std::string name = entry.path().filename().string(); name.ends_with("robot.yaml")) {
      robot = text_of(entry.path());
      if (name != "robot.yaml") replace_all(data_set, name, "robot.yaml");
    }
  std::istringstream lines(text_of(folder / "observations.csv"));
  std::string line;
  std::getline(lines, line);
  header = cells_of(line);
  while (std::getline(lines, line)) rows.push_back(cells_of(line));
}

void Files::write(const std::filesystem::path& folder) const {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "dataset.yaml") << data_set;
  std::ofstream(folder / "robot.yaml") << robot;
  std::ofstream out(folder / "observations.csv");
  write_line(out, header);
  for (const Row& row : rows) write_line(out, row);
}

void Files::scale_robot(double factor) {
  const std::regex length(R"(\b([dr]): (-?[0-9.e-]+))");
  std::string scaled;
  auto from = robot.cbegin();
  for (std::sregex_iterator at(robot.cbegin(), robot.cend(), length), end; at != end; ++at) {
    scaled.append(from, (*at)[2].first);
    scaled += format_number(factor * std::stod((*at)[2]));
    from = (*at)[2].second;
  }
  robot = scaled.append(from, robot.cend());
}

bool Files::has(const std::string& column) const {
  return std::ranges::find(header, column) != header.end();
}

std::string& Files::cell(Row& row, const std::string& column) const {
  return row.at(static_cast<std::size_t>(std::ranges::find(header, column) - header.begin()));
}

void Files::thin(std::size_t count) {
  std::vector<Row> kept;
  for (std::size_t i = 0; i < std::min(count, rows.size()); ++i)
    kept.push_back(rows[i * rows.size() / std::min(count, rows.size())]);
  rows = std::move(kept);
}

void Files::change(const std::vector<std::string>& columns,
                   const std::function<void(std::vector<double>&, double)>& change) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<double> numbers;
    for (const std::string& column : columns) numbers.push_back(std::stod(cell(rows[i], column)));
    change(numbers, static_cast<double>(i) / static_cast<double>(rows.size()));
    for (std::size_t k = 0; k < columns.size(); ++k)
      cell(rows[i], columns[k]) = format_number(numbers[k]);
  }
}

void Files::set_column(const std::string& column, const std::function<double(double)>& value) {
  if (!has(column)) {
    header.push_back(column);
    for (Row& row : rows) row.resize(header.size());
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
    cell(rows[i], column) =
        format_number(value(static_cast<double>(i) / static_cast<double>(rows.size())));
}

void Files::replace_all(std::string& text, const std::string& what, const std::string& by) {
  std::size_t at = text.find(what);
  ASSERT_NE(at, std::string::npos) << what;
  for (; at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

}  // namespace selfcal::slips
