// Rows of a CSV file, one after the other, without holding the file (libcsv).
//
// RFC 4180: cells between commas, or the semicolons or tabs that stand in the header instead,
// quoted where they hold one, quotes or line ends; lines end in LF, CR or CRLF, the last one may
// lack its end. A byte order mark is skipped and tells UTF-16, blanks around a cell are dropped,
// blank lines may stand at the end only.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "io/result.h"

namespace selfcal {

/// What a cell is written as: quoted where it holds what would end it.
std::string csv_cell(const std::string& text);

/// The cells of one row; valid until the next one.
using Cells = std::span<const std::string_view>;

/// What is wrong with a row, and in which column (from 0) if one cell is at fault.
struct RowFault {
  std::string what;
  std::optional<std::size_t> column = std::nullopt;
};

/// Takes the header's names and what parts the cells; commas do, too, where that is nothing, for
/// more than one of comma, semicolon and tab may be meant. A fault ends the reading.
using TakeHeader =
    std::function<std::optional<RowFault>(Cells names, std::optional<char> separator)>;
/// Takes a row, numbered from 1, with as many cells as the header. A fault ends the reading.
using TakeRow = std::function<std::optional<RowFault>(Cells cells, int row)>;

/// Calls `header` once and `row` for each row; true where the last of them has its line's end. The
/// names of the columns stand in line `header_line`, from 1; what is above it is passed over. The
/// file is read once, from its beginning on. Fails with "FILE: row 17: column x: ..." on the first
/// fault, on a row of another length, on an unfinished quotation and on an empty or repeated name.
Result<bool> read_csv(const std::filesystem::path& path, const TakeHeader& header,
                      const TakeRow& row, int header_line = 1);

}  // namespace selfcal
