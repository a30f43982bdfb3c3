// Rows of text into columns of numbers. A row is read and judged as a whole and only then appended;
// the columns grow as std::vector does, so that a million rows need no more than a few copies.
#include "io/files/observations_csv.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "constraints/methods/repeats.h"
#include "io/files/columns.h"
#include "io/files/csv.h"
#include "io/files/row_labels.h"
#include "io/files/row_numbers.h"

namespace selfcal {
namespace {

/// A column that a method asks of every row, and its place if the file has it.
struct Need {
  std::string column;
  std::optional<std::size_t> place;
  bool from_previous = false;  ///< measured from the previous row of the group
};

/// The columns that the methods of the sets bring along, each once.
std::vector<MeasuredColumn> measured_columns(const std::vector<Set>& sets) {
  std::vector<MeasuredColumn> all;
  for (const Set& set : sets)
    for (MeasuredColumn& column : set.method->measures())
      if (std::ranges::find(all, column.name, &MeasuredColumn::name) == all.end())
        all.push_back(std::move(column));
  return all;
}

Eigen::MatrixXd to_matrix(std::vector<double> values, std::size_t width) {
  using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const ByRows>(values.data(), static_cast<Eigen::Index>(values.size() / width),
                                  static_cast<Eigen::Index>(width));
}

constexpr double kOftenBack = 0.1;  // of the rows: sets that follow each other are fewer

constexpr std::size_t kCut = 2;  // characters that a last cell lacks

class RowReader {
 public:
  /// `configurations`: rows need no measurement.
  RowReader(const Robot& robot, const ColumnMap& map, DataSet& data, bool configurations,
            Readings readings)
      : data_(data),
        map_(map),
        configurations_(configurations),
        joints_(robot.joints()),
        labels_(data.sets),
        numbers_(robot, readings) {}

  std::optional<RowFault> take_header(Cells names, std::optional<char> separator) {
    if (!separator && map_.any())
      return RowFault{
          "more than one of comma, semicolon and tab: put names with one of them between quotes"};
    auto layout = read_header(
        names, joints_,
        configurations_ ? std::vector<MeasuredColumn>() : measured_columns(data_.sets), map_);
    if (!layout) return layout.error();
    layout_ = std::move(*layout);
    layout_.separator = separator.value_or(',');
    labels_.begin(layout_);
    numbers_.begin(layout_);
    for (const Set& set : data_.sets) {
      std::vector<Need>& needs = needs_.emplace_back();
      for (const std::string& column : set.method->columns())
        if (!configurations_ || column == "group")
          needs.push_back({column, layout_.filled_by(column)});
      if (configurations_) continue;
      for (const MeasuredColumn& column : set.method->measures())
        needs.push_back({column.name, layout_.find(column.name), set.method->paired()});
    }
    measured_.resize(layout_.measured.size());
    return std::nullopt;
  }

  std::optional<RowFault> take_row(Cells cells, int row) {
    const auto labels = labels_.read(cells, row);
    if (!labels) return labels.error();
    if (auto fault = numbers_.read(cells, row)) return fault;
    if (auto fault = check_needs(cells, *labels)) return fault;
    before_last_ = std::exchange(last_, cells.back().size());
    append(*labels);
    note_copy(cells, *labels);
    return std::nullopt;
  }

  /// What is wrong with the rows as a whole.
  std::optional<std::string> fault() const {
    if (set_.empty()) return "no rows below the header";
    return labels_.group_without_rows();
  }

  /// The last row has its line's end.
  void end(bool ended) { ended_ = ended; }

  std::vector<std::string> notices() const {
    std::vector<std::string> notices;
    if (!copies_.empty())
      notices.push_back(std::to_string(copies_.size()) +
                        (copies_.size() > 1 ? " rows say" : " row says") +
                        " what another says in every digit, first row " +
                        std::to_string(copies_.front() + 1) + ": each is counted once");
    if (!ended_ && last_ + kCut <= before_last_)
      notices.push_back(
          "the last row has no line end, and its last cell is shorter than that above it: was the "
          "file cut off there?");
    std::string ignored;
    for (const std::string& name : layout_.ignored()) {
      ignored += (ignored.empty() ? "" : ", ") + name;
    }
    if (!ignored.empty()) notices.push_back("unknown columns are ignored: " + ignored);
    if (static_cast<double>(times_back_) > kOftenBack * static_cast<double>(time_.size()))
      notices.push_back("the times go back " + std::to_string(times_back_) +
                        " times from one row to the next: right where the rows were sorted by "
                        "something else, wrong where the times were");
    if (auto outside = numbers_.outside_limits_notice()) notices.push_back(std::move(*outside));
    std::ranges::copy(labels_.groups_alike(), std::back_inserter(notices));
    for (const std::string& set : labels_.sets_without_rows()) {
      notices.push_back("set '" + set + "' has no rows");
    }
    return notices;
  }

  /// Says what was filled in, and what is doubtful of it.
  std::vector<std::string> hand_over() {
    Observations& rows = data_.rows;
    rows.q = to_matrix(std::move(q_), layout_.q.size());
    rows.position = to_matrix(std::move(position_), 3);
    rows.orientation = to_matrix(std::move(orientation_), 4);
    rows.turns = {layout_.turn_axes, to_matrix(std::move(turn_), 3)};
    rows.normal = to_matrix(std::move(normal_), 3);
    rows.wrench = to_matrix(std::move(wrench_), 6);
    rows.velocity = to_matrix(std::move(velocity_), layout_.q.size());
    rows.temperature = to_matrix(std::move(temperature_), 1);
    rows.time = to_matrix(std::move(time_), 1);
    std::vector<std::string> said = fill_gaps(rows);
    if (auto doubt = celsius_doubt(rows.temperature)) said.push_back(std::move(*doubt));
    if (rows.time.size() == 0) {
      data_.order_is_time = true;
      const Eigen::Index count = rows.q.rows();
      rows.time = Eigen::VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1));
    }
    rows.noise_factor = to_matrix(std::move(noise_factor_), 1);
    rows.set = std::move(set_);
    rows.group = std::move(group_);
    rows.repeat = std::move(repeat_);
    rows.check = std::move(check_);
    for (std::size_t i = 0; i < measured_.size(); ++i)
      rows.measured[layout_.columns[layout_.measured[i]].name] =
          to_matrix(std::move(measured_[i]), 1);
    return said;
  }

 private:
  std::optional<RowFault> check_needs(Cells cells, const Labels& labels) const {
    const Set& set = data_.sets[labels.set];
    for (const Need& need : needs_[labels.set]) {
      if (need.place && !cells[*need.place].empty()) continue;
      if (need.from_previous && labels.first_of_group) continue;
      const std::string method(set.method->name());
      return RowFault{"set '" + set.name + "' (" + method + ") needs column '" + need.column +
                          "', which is " +
                          (need.place ? "empty" : "missing: " + layout_.instead_of(need.column)),
                      need.place};
    }
    // A NaN is an empty cell.
    if (layout_.noise_factor && numbers_.value(*layout_.noise_factor) < 1)
      return RowFault{"expected a factor of at least 1", layout_.noise_factor};
    return std::nullopt;
  }

  /// What another row of its method says in every digit says nothing more: readings that encoders
  /// round alike are rounded by the same, too. What is called a repeat may well be the same. A
  /// column that nobody reads, a number of the row, tells none apart.
  void note_copy(Cells cells, const Labels& labels) {
    if (data_.sets[labels.set].method->paired() || labels.repeat >= 0) return;
    // Two sets of one method may be the same rows twice; of two methods they are read twice.
    std::size_t hash = std::hash<std::string_view>()(data_.sets[labels.set].method->name());
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (i != layout_.part && i != layout_.set && layout_.columns[i].kind != CellKind::ignored)
        hash = (hash ^ std::hash<std::string_view>()(cells[i])) * 0x9E3779B97F4A7C15u;
    if (!seen_.insert(hash).second) {
      copies_.push_back(set_.size() - 1);
      check_.back() = kCopy;
    }
  }

  void append(const Labels& labels) {
    const auto extend = [](std::vector<double>& column, const auto& vector) {
      column.insert(column.end(), vector.begin(), vector.end());
    };
    for (const std::size_t column : layout_.q) q_.push_back(numbers_.value(column));
    if (layout_.position) extend(position_, numbers_.position());
    if (layout_.orientation || layout_.turn) extend(orientation_, numbers_.orientation());
    if (layout_.turn) extend(turn_, numbers_.turn());
    if (layout_.normal) extend(normal_, numbers_.normal());
    for (const std::size_t column : layout_.dq) velocity_.push_back(numbers_.value(column));
    if (layout_.wrench) extend(wrench_, numbers_.wrench());
    if (layout_.temperature) temperature_.push_back(numbers_.value(*layout_.temperature));
    if (layout_.noise_factor) {
      const double factor = numbers_.value(*layout_.noise_factor);
      noise_factor_.push_back(std::isnan(factor) ? 1 : factor);
    }
    if (layout_.time) {
      const double time = numbers_.value(*layout_.time);
      if (!time_.empty() && time < time_.back()) ++times_back_;
      time_.push_back(time);
    }
    if (layout_.repeat) repeat_.push_back(labels.repeat);
    set_.push_back(static_cast<int>(labels.set));
    group_.push_back(labels.group);
    check_.push_back(labels.check ? 1 : 0);
    for (std::size_t i = 0; i < measured_.size(); ++i)
      measured_[i].push_back(numbers_.value(layout_.measured[i]));
  }

  DataSet& data_;
  const ColumnMap& map_;
  const bool configurations_;
  const std::vector<Joint>& joints_;
  Layout layout_;
  LabelReader labels_;
  NumberReader numbers_;
  std::vector<std::vector<Need>> needs_;  // per set
  std::vector<double> q_, position_, orientation_, turn_, normal_;
  std::vector<double> wrench_, velocity_, temperature_, time_, noise_factor_;
  std::vector<std::vector<double>> measured_;  // per column that a method brings along
  std::size_t last_ = 0, before_last_ = 0;     // characters of the last cells of the last two rows
  bool ended_ = true;
  std::size_t times_back_ = 0;  // rows that were taken before the row above them
  std::vector<int> set_, group_, repeat_;
  std::vector<char> check_;
  std::unordered_set<std::size_t> seen_;  // the rows' cells, hashed
  std::vector<std::size_t> copies_;
};

Result<void> read_rows(const std::filesystem::path& path, RowReader& reader, int header) {
  const Result<bool> read = read_csv(
      path,
      [&](Cells names, std::optional<char> separator) {
        return reader.take_header(names, separator);
      },
      [&](Cells cells, int row) { return reader.take_row(cells, row); }, header);
  if (!read) return tl::unexpected(read.error());
  reader.end(*read);
  if (const auto fault = reader.fault()) return bad_input(path.string() + ": " + *fault);
  return {};
}

}  // namespace

Result<void> read_observations(const std::filesystem::path& path, const Robot& robot,
                               const ColumnMap& map, Readings readings, DataSet& data,
                               std::vector<std::string>& notices) {
  RowReader reader(robot, map, data, false, readings);
  if (Result<void> done = read_rows(path, reader, map.header); !done) return done;
  for (const std::string& notice : reader.notices()) {
    notices.push_back(path.string() + ": " + notice);
  }
  for (const std::string& filled : reader.hand_over())
    notices.push_back(path.string() + ": " + filled);
  if (const auto repeats = label_repeats(robot, data))
    notices.push_back(path.string() + ": " + *repeats);
  return {};
}

Result<void> read_configurations(const std::filesystem::path& path, const Robot& robot,
                                 DataSet& data) {
  const ColumnMap map;
  RowReader reader(robot, map, data, true, Readings::within_limits);
  if (Result<void> done = read_rows(path, reader, map.header); !done) return done;
  reader.hand_over();
  return {};
}

}  // namespace selfcal
