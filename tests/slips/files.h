// A data set as its files, to be spoiled in one place.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace selfcal::slips {

struct Files {
  explicit Files(const std::filesystem::path& folder);
  void write(const std::filesystem::path& folder) const;

  using Row = std::vector<std::string>;
  std::string& cell(Row& row, const std::string& column) const;
  bool has(const std::string& column) const;
  /// Leaves `count` rows, evenly spaced.
  void thin(std::size_t count);
  /// Gives `change` the numbers in `columns` of each row, and how far down the file it is (0 to 1).
  void change(const std::vector<std::string>& columns,
              const std::function<void(std::vector<double>&, double)>& change);
  /// A further column, or another one of that name.
  void set_column(const std::string& column, const std::function<double(double)>& value);
  /// The lengths d and r of every frame of the robot times `factor`.
  void scale_robot(double factor);
  /// Replaces each `what`, which must be there, in `text`.
  static void replace_all(std::string& text, const std::string& what, const std::string& by);

  Row header;
  std::vector<Row> rows;
  std::string data_set, robot;
};

}  // namespace selfcal::slips
