// The cells of a row that are names: set, group, part, repeat.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "constraints/methods/data_set.h"
#include "io/files/columns.h"
#include "io/files/csv.h"

namespace selfcal {

/// What one row's names come to, as Observations keeps them.
struct Labels {
  std::size_t set = 0;
  int group = -1;
  int repeat = -1;
  bool check = false;
  bool first_of_group = false;  ///< no earlier row has this set and group
};

/// Turns names into indices, row after row, and counts what it has seen. Groups that rows bring up
/// are appended to their set's names.
class LabelReader {
 public:
  explicit LabelReader(std::vector<Set>& sets);

  /// `layout` must outlive the reader.
  void begin(const Layout& layout) { layout_ = &layout; }
  tl::expected<Labels, RowFault> read(Cells cells, int row);

  /// A group that a set's options name and no row does, as a sentence.
  std::optional<std::string> group_without_rows() const;
  std::vector<std::string> sets_without_rows() const;
  /// Groups of one set whose names differ in capitals, blanks or dashes alone, as sentences.
  std::vector<std::string> groups_alike() const;

 private:
  struct TextHash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const {
      return std::hash<std::string_view>()(text);
    }
  };
  template <class Value>
  using ByText = std::unordered_map<std::string, Value, TextHash, std::equal_to<>>;

  struct SetState {
    ByText<int> groups;           // index of each group
    std::vector<int> group_rows;  // rows of each group
    int rows = 0;
    int ungrouped = 0;
  };
  struct Repeat {
    int id = 0;
    bool check = false;
    int first_row = 0;
  };

  std::optional<RowFault> read_set(Cells cells, Labels& labels) const;
  std::optional<RowFault> read_group(Cells cells, Labels& labels);
  std::optional<RowFault> read_part(Cells cells, Labels& labels) const;
  std::optional<RowFault> read_repeat(Cells cells, int row, Labels& labels);
  void count(Labels& labels);

  std::vector<Set>& sets_;
  const Layout* layout_ = nullptr;
  ByText<std::size_t> set_index_;
  std::vector<SetState> states_;
  ByText<Repeat> repeats_;
};

}  // namespace selfcal
