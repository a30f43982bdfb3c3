// Version N is what the first N migrations made; a migration that was released never changes.
//
// Doubles are ANY: a REAL column stores 0 for -0. Text that repeats from night to night (the
// configuration, the robot) is kept once, in `text`. Layouts of the blobs: packing.h. A touch has
// its session within its key: an index of its own would cost a sixth of the file. What is pruned
// early has tables of its own, for a row made smaller leaves its page half empty.
#include "io/store/schema.h"

#include <sqlite3.h>

#include <array>
#include <memory>
#include <string>

#include "io/store/checksums.h"
#include "io/store/sqlite.h"

namespace selfcal {
namespace {

#define SELFCAL_ADD_CHECKSUMS(table, checksum) \
  "ALTER TABLE " table                         \
  " ADD COLUMN checksum INTEGER;\n"            \
  "UPDATE " table " SET checksum = " checksum ";\n"

constexpr Migration kFromNothing = R"sql(
CREATE TABLE text (
  id INTEGER PRIMARY KEY,
  hash TEXT NOT NULL UNIQUE,       -- SHA-256 of body
  body TEXT NOT NULL) STRICT;

CREATE TABLE session (
  id INTEGER PRIMARY KEY,
  kind TEXT NOT NULL,
  reason TEXT NOT NULL,
  model_hash TEXT NOT NULL,
  config_hash TEXT NOT NULL,
  config INTEGER NOT NULL REFERENCES text(id),
  seed INTEGER NOT NULL,           -- the 64 bits of an unsigned number
  state INTEGER NOT NULL,
  started_ms INTEGER NOT NULL,
  ended_ms INTEGER NOT NULL,
  steps INTEGER NOT NULL) STRICT;

CREATE TABLE plan (
  session INTEGER PRIMARY KEY REFERENCES session(id),
  labels BLOB NOT NULL) STRICT;
CREATE TABLE posture (
  session INTEGER PRIMARY KEY REFERENCES session(id),
  postures BLOB NOT NULL) STRICT;

CREATE TABLE touch (
  id INTEGER PRIMARY KEY,          -- session * 2^20 + number, in the order they came
  step INTEGER NOT NULL,
  attempt INTEGER NOT NULL,
  outcome INTEGER NOT NULL,
  why TEXT,                        -- NULL for none
  unix_ms INTEGER NOT NULL,
  temperature ANY,                 -- degrees Celsius; NULL when not known
  stamps BLOB NOT NULL) STRICT;

CREATE TABLE result (
  session INTEGER PRIMARY KEY REFERENCES session(id),
  unix_ms INTEGER NOT NULL,
  answer TEXT NOT NULL,
  decision TEXT NOT NULL,
  why TEXT NOT NULL,
  p_value ANY,
  check_before ANY,
  check_after ANY,
  endpoint_sigma ANY,
  touches INTEGER NOT NULL,
  rejected INTEGER NOT NULL,
  identified INTEGER NOT NULL,
  robot INTEGER NOT NULL REFERENCES text(id)) STRICT;
CREATE TABLE json (
  session INTEGER PRIMARY KEY REFERENCES session(id),
  body TEXT NOT NULL) STRICT;

CREATE TABLE slot (
  slot INTEGER PRIMARY KEY,
  session INTEGER REFERENCES session(id),  -- NULL for the factory's
  since_ms INTEGER NOT NULL,
  model_hash TEXT NOT NULL,
  robot INTEGER NOT NULL REFERENCES text(id)) STRICT;

CREATE TABLE event (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  unix_ms INTEGER NOT NULL,
  level TEXT NOT NULL,
  text TEXT NOT NULL) STRICT;

CREATE TABLE remembered (
  name TEXT PRIMARY KEY,
  text TEXT NOT NULL) STRICT, WITHOUT ROWID;
)sql";

// What is there has no checksums yet, and gets them as it stands: damage of before cannot be seen,
// but for that of texts, which had their hashes.
constexpr Migration kChecksums = SELFCAL_ADD_CHECKSUMS("session", SELFCAL_SESSION_CHECKSUM)
    SELFCAL_ADD_CHECKSUMS("plan", SELFCAL_PLAN_CHECKSUM) SELFCAL_ADD_CHECKSUMS(
        "posture", SELFCAL_POSTURE_CHECKSUM) SELFCAL_ADD_CHECKSUMS("touch", SELFCAL_TOUCH_CHECKSUM)
        SELFCAL_ADD_CHECKSUMS("result", SELFCAL_RESULT_CHECKSUM)
            SELFCAL_ADD_CHECKSUMS("json", SELFCAL_JSON_CHECKSUM)
                SELFCAL_ADD_CHECKSUMS("slot", SELFCAL_SLOT_CHECKSUM)
                    SELFCAL_ADD_CHECKSUMS("event", SELFCAL_EVENT_CHECKSUM)
                        SELFCAL_ADD_CHECKSUMS("remembered", SELFCAL_REMEMBERED_CHECKSUM) R"sql(
CREATE TABLE damage (
  id INTEGER PRIMARY KEY,
  unix_ms INTEGER NOT NULL,        -- when it was found
  place TEXT NOT NULL,             -- active, previous, candidate, store, or the table
  what TEXT NOT NULL,
  row TEXT,                        -- of one that left its table: the columns as SQL writes them
  checksum INTEGER) STRICT;

CREATE TABLE change (               -- one row: how many there have been
  id INTEGER PRIMARY KEY CHECK (id = 1),
  number INTEGER NOT NULL,
  checksum INTEGER) STRICT;
INSERT INTO change VALUES(1, 0, selfcal_checksum('change', 1, 0));
)sql";

constexpr std::array<Migration, 2> kMigrations{kFromNothing, kChecksums};

}  // namespace

std::span<const Migration> migrations() { return kMigrations; }

Result<int> version(sqlite3* database) {
  const Result<std::int64_t> number = sqlite::integer(database, "PRAGMA user_version");
  if (!number) return tl::unexpected(number.error());
  return static_cast<int>(*number);
}

namespace {

/// The columns of all tables, and which of other tables they refer to, a line a table; the order
/// and the types count.
Result<std::string> columns(sqlite3* database) {
  std::string all;
  for (const Verified& table : kVerified) {
    const Result<std::string> list = sqlite::text(
        database,
        "SELECT (SELECT group_concat(name || ' ' || type || ' ' || \"notnull\" || ' ' || pk)"
        " FROM pragma_table_xinfo(?1)) || coalesce('; ' ||"
        " (SELECT group_concat(\"from\" || ' ' || \"table\" || ' ' || coalesce(\"to\", '')"
        " || ' ' || on_delete || ' ' || on_update) FROM pragma_foreign_key_list(?1)), '')",
        {table.table});
    if (!list) return list;
    all += table.table + (": " + *list) + "\n";
  }
  return all;
}

}  // namespace

Result<bool> has_its_columns(sqlite3* database) {
  const Result<int> found = version(database);
  if (!found) return tl::unexpected(found.error());
  if (*found < 0 || *found > static_cast<int>(migrations().size())) return false;
  sqlite3* memory = nullptr;
  sqlite3_open(":memory:", &memory);
  const std::unique_ptr<sqlite3, decltype(&sqlite3_close)> owner(memory, sqlite3_close);
  if (auto added = add_checksum_functions(memory); !added) return tl::unexpected(added.error());
  const auto list = migrations().first(static_cast<std::size_t>(*found));
  if (auto made = migrate(memory, list); !made) return tl::unexpected(made.error());
  const Result<std::string> right = columns(memory), there = columns(database);
  if (!right || !there) return tl::unexpected((!right ? right : there).error());
  return *right == *there;
}

Result<void> migrate(sqlite3* database, std::span<const Migration> list) {
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database);
  if (!transaction) return tl::unexpected(transaction.error());
  const Result<int> from = version(database);
  if (!from) return tl::unexpected(from.error());
  const int to = static_cast<int>(list.size());
  if (*from < 0 || *from > to) {
    return sqlite::failure(database, "is of version " + std::to_string(*from) +
                                         ", and this program knows versions up to " +
                                         std::to_string(to));
  }
  if (*from == to) return {};
  std::string script;
  for (const Migration step : list.subspan(static_cast<std::size_t>(*from))) script += step;
  script += "PRAGMA user_version = " + std::to_string(to) + ";";
  if (sqlite3_exec(database, script.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    return sqlite::failure(database);
  }
  return transaction->commit();
}

}  // namespace selfcal
