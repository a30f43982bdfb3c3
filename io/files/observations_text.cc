// Each column writes its own cell; a row is its columns' cells.
#include "io/files/observations_text.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "io/files/csv.h"

namespace selfcal {
namespace {

struct TextColumn {
  std::string name;
  std::function<std::string(int row)> cell;
};

/// Adds the columns of `values` (rows x names) unless all of it is NaN or missing.
void add_columns(const Eigen::MatrixXd& values, const std::vector<std::string>& names,
                 std::vector<TextColumn>& columns) {
  if (values.size() == 0 || values.array().isNaN().all()) return;
  for (std::size_t i = 0; i < names.size(); ++i)
    columns.push_back({names[i], [&values, i](int row) {
                         const double v = values(row, static_cast<Eigen::Index>(i));
                         return std::isnan(v) ? std::string() : format_number(v);
                       }});
}

void add_labels(const DataSet& data, std::vector<TextColumn>& columns) {
  const Observations& rows = data.rows;
  columns.push_back({"set", [&](int row) { return csv_cell(data.sets[rows.set[row]].name); }});
  if (std::ranges::any_of(rows.group, [](int group) { return group >= 0; }))
    columns.push_back({"group", [&](int row) {
                         const Set& set = data.sets[rows.set[row]];
                         return rows.group[row] < 0 ? "" : csv_cell(set.groups[rows.group[row]]);
                       }});
  if (std::ranges::any_of(rows.check, [](char check) { return check != 0; }))
    columns.push_back({"part", [&](int row) { return rows.check[row] ? "check" : "fit"; }});
  if (std::ranges::any_of(rows.repeat, [](int repeat) { return repeat >= 0; }))
    columns.push_back({"repeat", [&](int row) {
                         return rows.repeat[row] < 0 ? "" : std::to_string(rows.repeat[row]);
                       }});
}

std::string line(const std::vector<TextColumn>& columns,
                 const std::function<std::string(const TextColumn&)>& text) {
  std::string line;
  for (const TextColumn& column : columns) line += (line.empty() ? "" : ",") + text(column);
  return line + "\n";
}

}  // namespace

std::string observations_text(const DataSet& data) {
  const Observations& rows = data.rows;
  std::vector<TextColumn> columns;
  add_labels(data, columns);
  std::vector<std::string> joints;
  for (Eigen::Index j = 1; j <= rows.q.cols(); ++j) joints.push_back("q" + std::to_string(j));
  add_columns(rows.q, joints, columns);
  add_columns(rows.position, {"x", "y", "z"}, columns);
  add_columns(rows.orientation, {"qw", "qx", "qy", "qz"}, columns);
  const std::map<std::string, Eigen::MatrixXd> measured(rows.measured.begin(), rows.measured.end());
  for (const auto& [name, values] : measured) add_columns(values, {name}, columns);
  add_columns(rows.normal, {"nx", "ny", "nz"}, columns);
  add_columns(rows.wrench, {"fx", "fy", "fz", "tx", "ty", "tz"}, columns);
  std::vector<std::string> speeds;
  for (Eigen::Index j = 1; j <= rows.q.cols(); ++j) speeds.push_back("dq" + std::to_string(j));
  add_columns(rows.velocity, speeds, columns);
  const Eigen::MatrixXd temperature = rows.temperature, time = rows.time;
  add_columns(temperature, {"temperature"}, columns);
  if (!data.order_is_time) add_columns(time, {"time"}, columns);
  const Eigen::MatrixXd noise_factor = rows.noise_factor;
  if ((noise_factor.array() != 1).any()) add_columns(noise_factor, {"noise_factor"}, columns);
  std::string text = line(columns, [](const TextColumn& column) { return column.name; });
  for (int row = 0; row < rows.rows(); ++row)
    text += line(columns, [row](const TextColumn& column) { return column.cell(row); });
  return text;
}

}  // namespace selfcal
