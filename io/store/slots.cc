// Which parameters are in use, were, or may be. An empty slot stands for the factory's.
#include "io/store/sqlite.h"
#include "io/store/store.h"

namespace selfcal {
namespace {

using Changes = std::initializer_list<const char*>;

/// Runs statements that may use the time as ?1, one transaction, once `condition` counts any slot.
Result<void> change(sqlite3* database, const char* condition, const char* otherwise,
                    std::int64_t unix_ms, Changes changes) {
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database);
  if (!transaction) return tl::unexpected(transaction.error());
  const auto slots = sqlite::integer(database, condition);
  if (!slots) return tl::unexpected(slots.error());
  if (*slots == 0) return sqlite::failure(database, otherwise);
  for (const char* sql : changes) {
    if (auto done = sqlite::run(database, sql, {unix_ms}); !done) {
      return tl::unexpected(done.error());
    }
  }
  return transaction->commit();
}

constexpr const char* kCandidates = "SELECT count(*) FROM slot WHERE slot = 2";

}  // namespace

std::string_view to_string(Slot slot) {
  switch (slot) {
    case Slot::active:
      return "active";
    case Slot::previous:
      return "previous";
    case Slot::candidate:
      return "candidate";
  }
  return "?";
}

Result<std::optional<SlotRecord>> Store::slot(Slot slot) {
  auto row = sqlite::Statement::prepare(database_,
                                        "SELECT session, since_ms, model_hash, body FROM slot"
                                        " JOIN text ON text.id = robot WHERE slot = ?1",
                                        {static_cast<std::int64_t>(slot)});
  if (!row) return tl::unexpected(row.error());
  const Result<bool> there = row->step();
  if (!there) return tl::unexpected(there.error());
  if (!*there) return std::nullopt;
  return SlotRecord{row->integer(0), row->integer(1), row->text(2), row->text(3)};
}

Result<void> Store::accept(std::int64_t unix_ms) {
  return change(
      database_, kCandidates, "there is no candidate to accept", unix_ms,
      {"UPDATE result SET decision = 'applied' WHERE session ="
       " (SELECT session FROM slot WHERE slot = 2)",
       "DELETE FROM slot WHERE slot = 1", "UPDATE slot SET slot = 1, since_ms = ?1 WHERE slot = 0",
       "UPDATE slot SET slot = 0, since_ms = ?1 WHERE slot = 2"});
}

Result<void> Store::reject(std::int64_t unix_ms) {
  return change(database_, kCandidates, "there is no candidate to reject", unix_ms,
                {"UPDATE result SET decision = 'rejected' WHERE session ="
                 " (SELECT session FROM slot WHERE slot = 2)",
                 "DELETE FROM slot WHERE slot = 2"});
}

Result<void> Store::roll_back(std::int64_t unix_ms) {
  return change(database_, "SELECT count(*) FROM slot WHERE slot IN (0, 1)",
                "there are no parameters to go back to", unix_ms,
                {"UPDATE slot SET slot = 3 WHERE slot = 0",
                 "UPDATE slot SET slot = 0, since_ms = ?1 WHERE slot = 1",
                 "UPDATE slot SET slot = 1, since_ms = ?1 WHERE slot = 3"});
}

}  // namespace selfcal
