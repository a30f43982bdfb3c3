// SQLite's handles with an owner, and its errors as Failures that name the file.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "io/result.h"

struct sqlite3;
struct sqlite3_stmt;

namespace selfcal::sqlite {

/// No text or blob in the store is longer (bytes); binding a longer one fails.
inline constexpr std::size_t kMostBytes = std::size_t{16} << 20;

struct Blob {
  std::string_view bytes;
};
/// What a parameter ?1, ?2, … takes. Texts and blobs must outlive the statement's steps; a NaN
/// becomes NULL.
using Value = std::variant<std::nullptr_t, std::int64_t, double, std::string_view, Blob>;
using Values = std::initializer_list<Value>;

/// A prepared statement with its values bound; those beyond its parameters are not used.
class Statement {
 public:
  static Result<Statement> prepare(sqlite3* database, const char* sql, Values values = {});

  Statement(Statement&& other) noexcept : statement_(std::exchange(other.statement_, nullptr)) {}
  Statement& operator=(Statement&&) = delete;
  ~Statement();

  /// Whether there is a row; the columns may be read until the next step.
  Result<bool> step();

  bool null(int column) const;
  std::int64_t integer(int column) const;
  double real(int column) const;       ///< NaN for NULL
  std::string text(int column) const;  ///< a text's or a blob's bytes; empty for NULL

 private:
  explicit Statement(sqlite3_stmt* statement) : statement_(statement) {}
  Result<void> bind(int parameter, const Value& value);
  sqlite3_stmt* statement_;
};

/// What `read(const Statement&)` makes of each row, in their order.
template <class Read>
auto all(Result<Statement> rows, Read read)
    -> Result<std::vector<std::invoke_result_t<Read, const Statement&>>> {
  if (!rows) return tl::unexpected(rows.error());
  std::vector<std::invoke_result_t<Read, const Statement&>> made;
  for (;;) {
    const Result<bool> row = rows->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return made;
    made.push_back(read(*rows));
  }
}

/// Runs a statement to its end; its rows are dropped. Returns the number of rows changed.
Result<std::int64_t> run(sqlite3* database, const char* sql, Values values = {});

/// The first column of the first row; 0 or empty when there is no row.
Result<std::int64_t> integer(sqlite3* database, const char* sql, Values values = {});
Result<std::string> text(sqlite3* database, const char* sql, Values values = {});

/// Everything between `begin` and `commit` happens or nothing does: without `commit` the end of
/// the object's life rolls back.
class Transaction {
 public:
  static Result<Transaction> begin(sqlite3* database);

  Transaction(Transaction&& other) noexcept : database_(std::exchange(other.database_, nullptr)) {}
  Transaction& operator=(Transaction&&) = delete;
  ~Transaction();

  Result<void> commit();

 private:
  explicit Transaction(sqlite3* database) : database_(database) {}
  sqlite3* database_;
};

/// The store's file and the last error of the connection.
tl::unexpected<Failure> failure(sqlite3* database);
/// The store's file and `what`.
tl::unexpected<Failure> failure(sqlite3* database, const std::string& what);
/// The same of what was asked for and is not in a sound store: bad input.
tl::unexpected<Failure> not_there(sqlite3* database, const std::string& what);

}  // namespace selfcal::sqlite
