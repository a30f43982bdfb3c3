// CSV in every form that spreadsheets and loggers give it, and the words for what is broken.
#include "io/files/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <vector>

#include "tests/io/scratch.h"

namespace selfcal {
namespace {

using Table = std::vector<std::vector<std::string>>;
using testing::HasSubstr;

/// The header and the rows, or the error.
tl::expected<Table, std::string> read(const std::filesystem::path& path) {
  Table table;
  const auto keep = [&](Cells cells) {
    table.emplace_back(cells.begin(), cells.end());
    return std::optional<RowFault>();
  };
  const auto result = read_csv(
      path, [&](Cells names, std::optional<char>) { return keep(names); },
      [&](Cells cells, int row) {
        EXPECT_EQ(row, static_cast<int>(table.size()));
        return keep(cells);
      });
  if (!result) return tl::unexpected(result.error().what);
  return table;
}

Table table_of(std::string_view text) {
  const Scratch scratch;
  const auto table = read(scratch.write("f.csv", text));
  EXPECT_TRUE(table.has_value()) << table.error();
  return table.value_or(Table());
}

std::string csv_error(std::string_view text) {
  const Scratch scratch;
  const auto table = read(scratch.write("f.csv", text));
  if (table) return "no error";
  return table.error().substr(table.error().find("f.csv"));
}

const Table kTable = {{"a", "b"}, {"1", "2"}, {"3", ""}};

TEST(Csv, ReadsEveryLineEndAndTheLastLineWithoutOne) {
  for (const char* text : {"a,b\n1,2\n3,\n", "a,b\r\n1,2\r\n3,\r\n", "a,b\r1,2\r3,\r",
                           "a,b\n1,2\n3,", "a,b\r\n1,2\r\n3,",
                           "\xEF\xBB\xBF"
                           "a,b\n1,2\n3,\n",
                           "a,b\n1,2\n3,\n\n\n", "a,b\r\n1,2\r\n3,\r\n\r\n  \r\n",
                           " a , b \n 1, 2\n3 , \n", "\"a\",\"b\"\n\"1\",2\n3,\"\"\n"}) {
    EXPECT_EQ(table_of(text), kTable) << text;
  }
}

TEST(Csv, KeepsCommasQuotesAndLineEndsInsideQuotations) {
  EXPECT_EQ(table_of("a,b\n\"x, y\",\"say \"\"no\"\"\"\n\"1\n2\",\"\"\n"),
            (Table{{"a", "b"}, {"x, y", "say \"no\""}, {"1\n2", ""}}));
}

TEST(Csv, TakesWhatStandsBetweenTheNamesForWhatPartsTheCells) {
  for (const char* text : {"a;b\n1;2\n3;\n", "a\tb\r\n1\t2\r\n3\t\r\n", "\"a\";b\r1;2\r3;"})
    EXPECT_EQ(table_of(text), kTable) << text;
  EXPECT_EQ(table_of("\"a;b\",c\n1,2\n"), (Table{{"a;b", "c"}, {"1", "2"}}));
  EXPECT_EQ(table_of("a,b;c\n1,2\n"), (Table{{"a", "b;c"}, {"1", "2"}}));
  EXPECT_EQ(table_of("a;b"), (Table{{"a", "b"}}));
}

TEST(Csv, FindsTheEndOfAHeaderThatIsLongerThanABlock) {
  const std::string name(70000, 'a');
  EXPECT_EQ(table_of(name + ";b\n1;2\n"), (Table{{name, "b"}, {"1", "2"}}));
}

// What is handed over as `<(COMMAND)` can be read once only.
TEST(Csv, ReadsAPipe) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const std::string_view text = "a;b\n1;2\n3;\n";
  ASSERT_EQ(::write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  ::close(ends[1]);
  const auto table = read("/dev/fd/" + std::to_string(ends[0]));
  ::close(ends[0]);
  ASSERT_TRUE(table.has_value()) << table.error();
  EXPECT_EQ(*table, kTable);
}

TEST(Csv, ReadsAHeaderWithoutRows) { EXPECT_EQ(table_of("a,b\n"), (Table{{"a", "b"}})); }

TEST(Csv, NamesTheRowOfAWrongCountOfCells) {
  EXPECT_EQ(csv_error("a,b\n1,2\n3\n"), "f.csv: row 2: expected 2 cells as in the header, got 1");
  EXPECT_EQ(csv_error("a,b\n1,2,3\n"), "f.csv: row 1: expected 2 cells as in the header, got 3");
  EXPECT_EQ(
      csv_error("a,b\n1,2,3,4\n"),
      "f.csv: row 1: expected 2 cells as in the header, got 4 (decimal commas? then semicolons "
      "between the columns)");
}

TEST(Csv, RefusesBrokenQuotations) {
  EXPECT_EQ(csv_error("a,b\n1,2\n3,\"4\n"), "f.csv: row 2: the file ends inside a quotation");
  EXPECT_THAT(csv_error("a,b\n1,2\n3,4\"5\n"), HasSubstr("row 2: a quotation mark stands inside"));
  EXPECT_THAT(csv_error("a,b\n1,\"" + std::string(3 << 20, 'x')),
              HasSubstr("row 1: longer than 1 MiB; is a quotation left open?"));
}

TEST(Csv, RefusesABrokenHeader) {
  EXPECT_EQ(csv_error(""), "f.csv: header: expected a line with the names of the columns");
  EXPECT_EQ(csv_error("\n\n"), "f.csv: header: expected a line with the names of the columns");
  EXPECT_EQ(csv_error("a,,b\n"), "f.csv: header: column 2 has no name");
  EXPECT_EQ(csv_error("a,b,a\n"), "f.csv: header: column 'a' appears twice");
}

TEST(Csv, RefusesBlankLinesBetweenRowsAndBytesThatAreNoText) {
  EXPECT_EQ(csv_error("a,b\n1,2\n\n3,4\n"), "f.csv: row 2: stands below a blank line");
  EXPECT_EQ(csv_error(std::string_view("a,b\n1,\0\n", 8)),
            "f.csv: row 1: expected text in UTF-8, or UTF-16 behind its mark, got other bytes");
  EXPECT_EQ(csv_error("a,b\n1,J\xF6rg\n"),
            "f.csv: row 1: expected text in UTF-8, or UTF-16 behind its mark, got other bytes");
  EXPECT_THAT(csv_error(std::string_view("a\0,\0b\0", 6)),
              HasSubstr("f.csv: header: expected text in UTF-8, or UTF-16 behind its mark"));
}

TEST(Csv, NamesRowAndColumnOfAFault) {
  const Scratch scratch;
  const auto path = scratch.write("f.csv", "a,b\n1,2\n3,4\n5,6\n");
  int taken = 0;
  const auto result = read_csv(
      path, [](Cells, std::optional<char>) { return std::optional<RowFault>(); },
      [&](Cells, int row) {
        ++taken;
        return row == 2 ? std::optional(RowFault{"is bad", 1}) : std::nullopt;
      });
  ASSERT_FALSE(result.has_value());
  EXPECT_THAT(result.error().what, HasSubstr("f.csv: row 2: column b: is bad"));
  EXPECT_EQ(result.error().exit_status, kBadInput);
  EXPECT_EQ(taken, 2);
}

TEST(Csv, ReadsRowsAcrossItsBlocks) {
  std::string text = "a,b\r\n";
  Table expected = {{"a", "b"}};
  for (int i = 0; i < 30000; ++i) {
    expected.push_back({std::to_string(i), "\"" + std::to_string(i * 7)});
    text += std::to_string(i) + ",\"\"\"" + std::to_string(i * 7) + "\"\r\n";
  }
  EXPECT_EQ(table_of(text), expected);
}

}  // namespace
}  // namespace selfcal
