// Which parameters are in use, were, or may be. An empty slot stands for the factory's. A row moves
// to another slot only while it is sound: its checksum is made anew there.
#include "io/store/checksums.h"
#include "io/store/damage.h"
#include "io/store/sqlite.h"
#include "io/store/store.h"
#include "io/store/tables.h"

namespace selfcal {
namespace {

using Changes = std::initializer_list<const char*>;

/// A slot as it stands: whose it is, and what is damaged.
struct StoredSlot {
  bool there = false;
  std::int64_t session = 0;
  std::string damaged;
};

Result<StoredSlot> find_slot(sqlite3* database, Slot slot) {
  auto row = sqlite::Statement::prepare(
      database, "SELECT session, " SELFCAL_DAMAGED_SLOT " FROM slot WHERE slot = ?1",
      {static_cast<std::int64_t>(slot)});
  if (!row) return tl::unexpected(row.error());
  const Result<bool> there = row->step();
  if (!there) return tl::unexpected(there.error());
  if (!*there) return StoredSlot{};
  return StoredSlot{true, row->integer(0), row->text(1)};
}

tl::unexpected<Failure> damaged(sqlite3* database, const StoredSlot& slot) {
  return sqlite::failure(database, slot.damaged + ": damaged, and not used");
}

/// Runs statements that may use the time as ?1, and makes the checksums of the slots anew.
Result<void> change(sqlite3* database, std::int64_t unix_ms, Changes changes) {
  for (const char* sql : changes) {
    if (auto done = sqlite::run(database, sql, {unix_ms}); !done) {
      return tl::unexpected(done.error());
    }
  }
  const auto done = sqlite::run(database, "UPDATE slot SET checksum = " SELFCAL_SLOT_CHECKSUM);
  if (!done) return tl::unexpected(done.error());
  return {};
}

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
  auto row =
      sqlite::Statement::prepare(database_,
                                 "SELECT session, since_ms, model_hash, body, " SELFCAL_DAMAGED_SLOT
                                 " FROM slot LEFT JOIN text ON text.id = robot WHERE slot = ?1",
                                 {static_cast<std::int64_t>(slot)});
  if (!row) return tl::unexpected(row.error());
  const Result<bool> there = row->step();
  if (!there) return tl::unexpected(there.error());
  if (!*there) return std::nullopt;
  if (!sound(*row, 4)) return damaged(database_, {true, 0, row->text(4)});
  return SlotRecord{row->integer(0), row->integer(1), row->text(2), row->text(3)};
}

Result<void> Store::accept(std::int64_t unix_ms) {
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database_);
  if (!transaction) return tl::unexpected(transaction.error());
  const Result<StoredSlot> candidate = find_slot(database_, Slot::candidate);
  if (!candidate) return tl::unexpected(candidate.error());
  if (!candidate->there) return sqlite::failure(database_, "there is no candidate to accept");
  if (!candidate->damaged.empty()) return damaged(database_, *candidate);
  if (auto aside = set_slots_aside(database_, unix_ms); !aside) {
    return tl::unexpected(aside.error());
  }
  if (auto set = set_decision(database_, candidate->session, ResultDecision::applied); !set) {
    return set;
  }
  const auto changed = change(
      database_, unix_ms,
      {"DELETE FROM slot WHERE slot = 1", "UPDATE slot SET slot = 1, since_ms = ?1 WHERE slot = 0",
       "UPDATE slot SET slot = 0, since_ms = ?1 WHERE slot = 2"});
  if (!changed) return changed;
  return commit(*transaction);
}

Result<void> Store::reject(std::int64_t unix_ms) {
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database_);
  if (!transaction) return tl::unexpected(transaction.error());
  const Result<StoredSlot> candidate = find_slot(database_, Slot::candidate);
  if (!candidate) return tl::unexpected(candidate.error());
  if (!candidate->there) return sqlite::failure(database_, "there is no candidate to reject");
  if (auto aside = set_slots_aside(database_, unix_ms); !aside) {
    return tl::unexpected(aside.error());
  }
  if (candidate->damaged.empty()) {
    if (auto set = set_decision(database_, candidate->session, ResultDecision::rejected); !set) {
      return set;
    }
    const auto gone = sqlite::run(database_, "DELETE FROM slot WHERE slot = 2");
    if (!gone) return tl::unexpected(gone.error());
  }
  return commit(*transaction);
}

Result<void> Store::roll_back(std::int64_t unix_ms) {
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database_);
  if (!transaction) return tl::unexpected(transaction.error());
  const Result<StoredSlot> active = find_slot(database_, Slot::active);
  const Result<StoredSlot> previous = find_slot(database_, Slot::previous);
  if (!active || !previous) return tl::unexpected((!active ? active : previous).error());
  if (!active->there) {
    return device_failed("the factory's parameters are active: there is nothing further back");
  }
  if (!previous->damaged.empty()) return damaged(database_, *previous);
  // Where the active ones are damaged, setting them aside is the way back already.
  if (auto aside = set_slots_aside(database_, unix_ms); !aside) {
    return tl::unexpected(aside.error());
  }
  if (active->damaged.empty()) {
    auto set = active->session == 0
                   ? Result<void>{}
                   : set_decision(database_, active->session, ResultDecision::rolled_back);
    if (!set) return set;
    const auto changed = change(database_, unix_ms,
                                {"DELETE FROM slot WHERE slot = 0",
                                 "UPDATE slot SET slot = 0, since_ms = ?1 WHERE slot = 1"});
    if (!changed) return changed;
  }
  return commit(*transaction);
}

}  // namespace selfcal
