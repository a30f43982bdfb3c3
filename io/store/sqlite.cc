// Statements and transactions over SQLite's C interface (sqlite.org/c3ref).
#include "io/store/sqlite.h"

#include <sqlite3.h>

#include <limits>

namespace selfcal::sqlite {
namespace {

// One overload for each alternative of Value; each returns SQLite's code.
struct Binder {
  sqlite3_stmt* statement;
  int parameter;

  int operator()(std::nullptr_t) const { return sqlite3_bind_null(statement, parameter); }
  int operator()(std::int64_t value) const {
    return sqlite3_bind_int64(statement, parameter, value);
  }
  int operator()(double value) const { return sqlite3_bind_double(statement, parameter, value); }
  int operator()(std::string_view value) const {
    if (value.size() > kMostBytes) return SQLITE_TOOBIG;
    const char* data = value.data() == nullptr ? "" : value.data();  // null would bind NULL
    return sqlite3_bind_text(statement, parameter, data, static_cast<int>(value.size()),
                             SQLITE_STATIC);
  }
  int operator()(Blob value) const {
    if (value.bytes.size() > kMostBytes) return SQLITE_TOOBIG;
    const char* data = value.bytes.data() == nullptr ? "" : value.bytes.data();
    return sqlite3_bind_blob(statement, parameter, data, static_cast<int>(value.bytes.size()),
                             SQLITE_STATIC);
  }
};

std::string of_its_file(sqlite3* database, const std::string& what) {
  const char* path = sqlite3_db_filename(database, "main");
  return std::string(path == nullptr ? "store" : path) + ": " + what;
}

}  // namespace

tl::unexpected<Failure> failure(sqlite3* database, const std::string& what) {
  return device_failed(of_its_file(database, what));
}

tl::unexpected<Failure> not_there(sqlite3* database, const std::string& what) {
  return bad_input(of_its_file(database, what));
}

tl::unexpected<Failure> failure(sqlite3* database) {
  return failure(database, sqlite3_errmsg(database));
}

Result<Statement> Statement::prepare(sqlite3* database, const char* sql, Values values) {
  sqlite3_stmt* handle = nullptr;
  if (sqlite3_prepare_v2(database, sql, -1, &handle, nullptr) != SQLITE_OK) {
    return failure(database);
  }
  Statement statement(handle);
  const int parameters = sqlite3_bind_parameter_count(handle);
  int parameter = 0;
  for (const Value& value : values) {
    if (parameter == parameters) break;
    if (Result<void> bound = statement.bind(++parameter, value); !bound) {
      return tl::unexpected(bound.error());
    }
  }
  return statement;
}

Statement::~Statement() { sqlite3_finalize(statement_); }

Result<void> Statement::bind(int parameter, const Value& value) {
  const int code = std::visit(Binder{statement_, parameter}, value);
  if (code == SQLITE_OK) return {};
  return failure(sqlite3_db_handle(statement_), sqlite3_errstr(code));
}

Result<bool> Statement::step() {
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return failure(sqlite3_db_handle(statement_));
}

bool Statement::null(int column) const {
  return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_, column);
}

double Statement::real(int column) const {
  if (null(column)) return std::numeric_limits<double>::quiet_NaN();
  return sqlite3_column_double(statement_, column);
}

std::string Statement::text(int column) const {
  const void* bytes = sqlite3_column_blob(statement_, column);
  if (bytes == nullptr) return {};
  return {static_cast<const char*>(bytes),
          static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

Result<std::int64_t> run(sqlite3* database, const char* sql, Values values) {
  Result<Statement> statement = Statement::prepare(database, sql, values);
  if (!statement) return tl::unexpected(statement.error());
  for (;;) {
    const Result<bool> row = statement->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return sqlite3_changes64(database);
  }
}

Result<std::int64_t> integer(sqlite3* database, const char* sql, Values values) {
  Result<Statement> statement = Statement::prepare(database, sql, values);
  if (!statement) return tl::unexpected(statement.error());
  const Result<bool> row = statement->step();
  if (!row) return tl::unexpected(row.error());
  return *row ? statement->integer(0) : 0;
}

Result<std::string> text(sqlite3* database, const char* sql, Values values) {
  Result<Statement> statement = Statement::prepare(database, sql, values);
  if (!statement) return tl::unexpected(statement.error());
  const Result<bool> row = statement->step();
  if (!row) return tl::unexpected(row.error());
  return *row ? statement->text(0) : std::string();
}

Result<Transaction> Transaction::begin(sqlite3* database) {
  // IMMEDIATE: the wait for another writer comes here, where the busy timeout holds, and never
  // between a read and a write.
  if (auto begun = run(database, "BEGIN IMMEDIATE"); !begun) return tl::unexpected(begun.error());
  return Transaction(database);
}

Transaction::~Transaction() {
  // SQLite may have rolled back by itself (a full disk): then there is nothing to end.
  if (database_ != nullptr && sqlite3_get_autocommit(database_) == 0) {
    sqlite3_exec(database_, "ROLLBACK", nullptr, nullptr, nullptr);
  }
}

Result<void> Transaction::commit() {
  if (auto done = run(database_, "COMMIT"); !done) return tl::unexpected(done.error());
  database_ = nullptr;
  return {};
}

}  // namespace selfcal::sqlite
