// libcsv splits blocks of the file into cells; this gathers the cells of a row and judges its form.
// libcsv cannot be stopped inside a block, so after a fault the block's other rows are let pass.
#include "io/files/csv.h"

#include <csv.h>

#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "io/files/file.h"
#include "io/files/utf8.h"

namespace selfcal {
namespace {

constexpr std::size_t kBlock = 65536;
constexpr std::size_t kMostBytesInRow = 1 << 20;
constexpr std::size_t kMostColumns = 10000;
constexpr std::string_view kSeparators = ",;\t";

std::string count_of_cells(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " cell" : " cells");
}

/// Cuts off the beginning of `text` as far as the ends of `lines` lines, and counts them down.
void pass_over(std::string_view& text, int& lines) {
  for (; lines > 0 && !text.empty(); --lines) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) {
      text = {};
      return;
    }
    text.remove_prefix(end + 1);
  }
}

/// Those of the separators that stand in the line that `text` begins with, outside quotations, each
/// once; nothing where it has no end.
std::optional<std::string> separators_in(std::string_view text) {
  bool quoted = false;
  std::string found;
  for (const char each : text) {
    if (each == '"') quoted = !quoted;
    if (quoted) continue;
    if (each == '\n' || each == '\r') return found;
    if (kSeparators.find(each) != std::string_view::npos && found.find(each) == std::string::npos)
      found += each;
  }
  return std::nullopt;
}

class CsvReader {
 public:
  CsvReader(const std::filesystem::path& path, const TakeHeader& header, const TakeRow& row,
            int header_line)
      : path_(path), take_header_(header), take_row_(row), lines_above_(header_line - 1) {
    csv_init(&parser_, CSV_STRICT | CSV_STRICT_FINI | CSV_REPALL_NL);
    csv_set_blk_size(&parser_, kBlock);
  }
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;
  ~CsvReader() { csv_free(&parser_); }

  Result<bool> read() {
    Result<InputFile> file = InputFile::open(path_);
    if (!file) return tl::unexpected(file.error());
    std::array<char, kBlock> block;
    Utf8Pieces pieces;
    while (!fault_) {
      const Result<std::size_t> got = file->read(block);
      if (!got) return tl::unexpected(got.error());
      if (*got == 0) break;
      std::string_view text = pieces.take({block.data(), *got});
      pass_over(text, lines_above_);
      if (begun_)
        parse(text);
      else
        begin(text, false);
    }
    if (!begun_) begin("", true);
    if (!fault_ && !pieces.whole()) complain({"the file ends inside a character"});
    if (!fault_) finish();
    if (!fault_) return terminator_ >= 0;
    return bad_input(path_.string() + ": " + *fault_);
  }

 private:
  /// Keeps what there is of the file until the header's line is whole.
  void begin(std::string_view text, bool ends) {
    head_ += text;
    const std::optional<std::string> separators = separators_in(head_);
    if (!separators && !ends && head_.size() <= kMostBytesInRow) return;
    begun_ = true;
    const std::string found = separators.value_or(separators_in(head_ + "\n").value_or(""));
    if (found.size() == 1)
      separator_ = found[0];
    else if (found.size() > 1)
      separator_ = std::nullopt;
    csv_set_delim(&parser_, static_cast<unsigned char>(separator_.value_or(',')));
    parse(head_);
  }

  void parse(std::string_view text) {
    const std::size_t done = csv_parse(&parser_, text.data(), text.size(), on_cell, on_row, this);
    if (fault_) return;
    if (done != text.size()) {
      complain({"a quotation mark stands inside a cell that is not quoted as a whole"});
    } else if (buffer_.size() + parser_.entry_pos > kMostBytesInRow) {
      complain({"longer than 1 MiB; is a quotation left open?"});
    }
  }

  void finish() {
    if (csv_fini(&parser_, on_cell, on_row, this) != 0) {
      complain({"the file ends inside a quotation"});
    } else if (!header_taken_ && !fault_) {
      complain({"expected a line with the names of the columns"});
    }
  }

  static void on_cell(void* cell, std::size_t size, void* self) {
    CsvReader& reader = *static_cast<CsvReader*>(self);
    reader.buffer_.append(static_cast<const char*>(cell), size);
    reader.ends_.push_back(reader.buffer_.size());
  }

  static void on_row(int terminator, void* self) {
    CsvReader& reader = *static_cast<CsvReader*>(self);
    const int before = std::exchange(reader.terminator_, terminator);
    if (reader.fault_) return;
    if (reader.ends_.empty()) {
      const bool second_half_of_crlf = before == CSV_CR && terminator == CSV_LF;
      reader.blank_lines_ = reader.blank_lines_ || (!second_half_of_crlf && terminator >= 0);
      return;
    }
    reader.take();
    reader.buffer_.clear();
    reader.ends_.clear();
  }

  void take() {
    cells_.clear();
    std::size_t begin = 0;
    for (const std::size_t end : ends_) {
      cells_.emplace_back(buffer_.data() + begin, end - begin);
      begin = end;
    }
    if (!is_text(buffer_))
      return complain({"expected text in UTF-8, or UTF-16 behind its mark, got other bytes"});
    if (blank_lines_) return complain({"stands below a blank line"});
    if (!header_taken_) return take_header();
    if (rows_ == std::numeric_limits<int>::max() - 1) return complain({"too many rows"});
    if (cells_.size() != names_.size()) {
      // Half of the numbers and more are in two pieces.
      const bool decimals =
          separator_.value_or(',') == ',' && 2 * cells_.size() > 3 * names_.size();
      return complain({"expected " + count_of_cells(names_.size()) + " as in the header, got " +
                       std::to_string(cells_.size()) +
                       (decimals ? " (decimal commas? then semicolons between the columns)" : "")});
    }
    if (const auto fault = take_row_(cells_, rows_ + 1)) return complain(*fault);
    ++rows_;
  }

  void take_header() {
    if (cells_.size() > kMostColumns) return complain({"more than 10000 columns"});
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (cells_[i].empty()) {
        return complain({"column " + std::to_string(i + 1) + " has no name"});
      }
      for (const std::string& name : names_) {
        if (name == cells_[i]) return complain({"column '" + name + "' appears twice"});
      }
      names_.emplace_back(cells_[i]);
    }
    if (const auto fault = take_header_(cells_, separator_)) return complain(*fault);
    header_taken_ = true;
  }

  void complain(const RowFault& fault) {
    std::string where = header_taken_ ? "row " + std::to_string(rows_ + 1) : "header";
    if (fault.column) where += ": column " + names_[*fault.column];
    fault_ = where + ": " + fault.what;
  }

  const std::filesystem::path& path_;
  const TakeHeader& take_header_;
  const TakeRow& take_row_;
  std::optional<char> separator_ = ',';
  int lines_above_ = 0;  // the header, to be passed over
  bool begun_ = false;   // what parts the cells is known
  std::string head_;     // until then
  csv_parser parser_{};
  std::string buffer_;             // the row's cells, end to end
  std::vector<std::size_t> ends_;  // where each of them ends
  std::vector<std::string_view> cells_;
  std::vector<std::string> names_;
  int rows_ = 0;  // taken
  int terminator_ = -1;
  bool header_taken_ = false;
  bool blank_lines_ = false;
  std::optional<std::string> fault_;
};

}  // namespace

Result<bool> read_csv(const std::filesystem::path& path, const TakeHeader& header,
                      const TakeRow& row, int header_line) {
  return CsvReader(path, header, row, header_line).read();
}

std::string csv_cell(const std::string& text) {
  const bool blank_ends = !text.empty() && (text.front() == ' ' || text.back() == ' ');
  if (!blank_ends && text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

}  // namespace selfcal
