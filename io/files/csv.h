// Rows of a CSV file, one after the other, without holding the file (libcsv).
//
// RFC 4180: cells between commas (or semicolons or tabs, where a caller says so), quoted where they
// hold commas, quotes or line ends; lines end in LF, CR or CRLF, the last one may lack its end. A
// byte order mark is skipped and tells UTF-16, blanks around a cell are dropped, blank lines may
// stand at the end only.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "io/result.h"

namespace selfcal {

/// The cells of one row; valid until the next one.
using Cells = std::span<const std::string_view>;

/// What is wrong with a row, and in which column (from 0) if one cell is at fault.
struct RowFault {
  std::string what;
  std::optional<std::size_t> column = std::nullopt;
};

/// Takes the header's names. A fault ends the reading.
using TakeHeader = std::function<std::optional<RowFault>(Cells names)>;
/// Takes a row, numbered from 1, with as many cells as the header. A fault ends the reading.
using TakeRow = std::function<std::optional<RowFault>(Cells cells, int row)>;

/// Where the names of the columns stand and what stands between the cells.
struct CsvForm {
  int header = 1;        ///< line of the file, from 1; what is above it is passed over
  char separator = ',';  ///< or ; or a tab
};

/// What stands between the names in line `header`, outside quotations: commas, semicolons or tabs;
/// a comma where there is one name only, nothing where more than one of them may be meant.
Result<std::optional<char>> separator_of(const std::filesystem::path& path, int header);

/// Calls `header` once and `row` for each row. Fails with "FILE: row 17: column x: ..." on the
/// first fault, on a row of another length, on an unfinished quotation and on an empty or repeated
/// name.
Result<void> read_csv(const std::filesystem::path& path, const TakeHeader& header,
                      const TakeRow& row, const CsvForm& form = {});

}  // namespace selfcal
