// Events, small texts kept under a name, and what was found damaged.
#include <sqlite3.h>

#include "io/store/checksums.h"
#include "io/store/damage.h"
#include "io/store/sqlite.h"
#include "io/store/store.h"
#include "io/store/tables.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostMet = 1000;

}  // namespace

void Store::meet(const std::string& what) {
  if (met_.size() < kMostMet && known_.insert(what).second) met_.push_back(what);
}

bool Store::sound(const sqlite::Statement& row, int column) {
  if (row.null(column)) return true;
  meet(row.text(column));
  return false;
}

bool Store::moved() const {
  int moved = 0;
  sqlite3_file_control(database_, nullptr, SQLITE_FCNTL_HAS_MOVED, &moved);
  return moved != 0;
}

Result<std::vector<DamageRecord>> Store::damage() { return notes_of_damage(database_); }

Result<void> Store::add(const EventRecord& event) {
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database_);
  if (!transaction) return tl::unexpected(transaction.error());
  const auto id = sqlite::integer(
      database_, "INSERT INTO event(unix_ms, level, text) VALUES(?1, ?2, ?3) RETURNING id",
      {event.unix_ms, event.level, event.text});
  if (!id) return tl::unexpected(id.error());
  if (auto put = put_checksum(database_, kEvents, *id); !put) return put;
  return commit(*transaction);
}

Result<std::vector<EventRecord>> Store::events(int newest) {
  return sqlite::all(
      sqlite::Statement::prepare(database_,
                                 "SELECT id, unix_ms, level, text, " SELFCAL_DAMAGED_EVENT
                                 " FROM event ORDER BY id DESC LIMIT ?1",
                                 {std::int64_t{newest < 0 ? 0 : newest}}),
      [this](const sqlite::Statement& row) {
        if (!sound(row, 4)) {
          return EventRecord{row.integer(0), 0, "error", "this row of the store is damaged"};
        }
        return EventRecord{row.integer(0), row.integer(1), row.text(2), row.text(3)};
      });
}

Result<void> Store::remember(const std::string& name, const std::string& text) {
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database_);
  if (!transaction) return tl::unexpected(transaction.error());
  if (auto put = put_remembered(database_, {name, text}); !put) return put;
  return commit(*transaction);
}

Result<std::string> Store::remembered(const std::string& name) {
  auto row = sqlite::Statement::prepare(
      database_, "SELECT text, " SELFCAL_DAMAGED_REMEMBERED " FROM remembered WHERE name = ?1",
      {name});
  if (!row) return tl::unexpected(row.error());
  const Result<bool> there = row->step();
  if (!there) return tl::unexpected(there.error());
  if (!*there) return std::string();
  if (!sound(*row, 1)) return sqlite::failure(database_, row->text(1) + " is damaged");
  return row->text(0);
}

}  // namespace selfcal
