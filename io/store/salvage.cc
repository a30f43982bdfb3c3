// A table is read from its front until a page is damaged, then from its end until one is: what one
// bad page costs is that page. Tables have their keys as their first columns.
#include "io/store/salvage.h"

#include <sqlite3.h>

#include <memory>
#include <string>

#include "io/store/checksums.h"
#include "io/store/sqlite.h"

namespace selfcal {
namespace {

struct Finalize {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Prepared = std::unique_ptr<sqlite3_stmt, Finalize>;

Prepared prepared(sqlite3* database, const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr);
  return Prepared(statement);
}

std::string parameters(int count) {
  std::string list = "?";
  for (int i = 1; i < count; ++i) list += ", ?";
  return list;
}

/// Copies the rows in `order`; true once there are no more, false where a page cannot be read.
/// A row that the fresh table refuses is left out.
Result<bool> copy(sqlite3* damaged, sqlite3* fresh, const Verified& table, const char* order) {
  const std::string name = table.table;
  const Prepared rows = prepared(damaged, "SELECT * FROM " + name + " ORDER BY 1" + order);
  if (rows == nullptr) return true;  // a table that is not there has nothing to give
  const int columns = sqlite3_column_count(rows.get());
  const Prepared put =
      prepared(fresh, "INSERT OR IGNORE INTO " + name + " VALUES(" + parameters(columns) + ")");
  if (put == nullptr) return true;  // it has other columns
  int code = 0;
  while ((code = sqlite3_step(rows.get())) == SQLITE_ROW) {
    for (int i = 0; i < columns; ++i) {
      sqlite3_bind_value(put.get(), i + 1, sqlite3_column_value(rows.get(), i));
    }
    sqlite3_step(put.get());
    const int failed = sqlite3_reset(put.get()) & 0xff;
    if (failed != SQLITE_OK && failed != SQLITE_CONSTRAINT) return sqlite::failure(fresh);
  }
  return code == SQLITE_DONE;
}

}  // namespace

Result<std::int64_t> salvage(sqlite3* damaged, sqlite3* fresh) {
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(fresh);
  if (!transaction) return tl::unexpected(transaction.error());
  // The schema is read as far as it can be: a damaged line of it costs its own table.
  sqlite3_db_config(damaged, SQLITE_DBCONFIG_DEFENSIVE, 0, nullptr);
  sqlite3_exec(damaged, "PRAGMA writable_schema = ON", nullptr, nullptr, nullptr);
  std::int64_t kept = 0;
  for (const Verified& table : kVerified) {
    const std::string name = table.table;
    Result<bool> whole = copy(damaged, fresh, table, " ASC");
    if (whole && !*whole) whole = copy(damaged, fresh, table, " DESC");
    if (!whole) return tl::unexpected(whole.error());
    if (name != kSlots.table) {
      const auto unsound = sqlite::run(
          fresh, ("DELETE FROM " + name + " WHERE " + table.damaged + " IS NOT NULL").c_str());
      if (!unsound) return unsound;
    }
    const auto rows = sqlite::integer(fresh, ("SELECT count(*) FROM " + name).c_str());
    if (!rows) return rows;
    kept += *rows;
  }
  if (auto done = transaction->commit(); !done) return tl::unexpected(done.error());
  return kept;
}

}  // namespace selfcal
