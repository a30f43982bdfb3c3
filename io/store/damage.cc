#include "io/store/damage.h"

#include <algorithm>

#include "io/store/checksums.h"
#include "io/store/tables.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostNotes = 1000;  // of one look; beyond it the rest is counted
constexpr std::size_t kMostNamed = 8;     // in a sentence

using Names = std::vector<std::string>;

Result<void> done(const Result<std::int64_t>& ran) {
  if (!ran) return tl::unexpected(ran.error());
  return {};
}

Result<Names> names(sqlite3* database, const std::string& sql) {
  return sqlite::all(sqlite::Statement::prepare(database, sql.c_str()),
                     [](const sqlite::Statement& row) { return row.text(0); });
}

/// Of a damaged row in the slots: whether it was the active one's, by its key, or by its checksum
/// where the key is what changed.
#define SELFCAL_WAS_ACTIVE \
  "(slot.checksum IS " SELFCAL_SLOT_CHECKSUM_AS("0") " OR (slot.slot = 0 AND"           \
  " slot.checksum IS NOT " SELFCAL_SLOT_CHECKSUM_AS("1") " AND slot.checksum IS NOT "   \
  SELFCAL_SLOT_CHECKSUM_AS("2") "))"

struct DamagedSlot {
  std::int64_t key = 0;
  DamageRecord note;
};

Result<std::vector<DamagedSlot>> damaged_slots(sqlite3* database, std::int64_t unix_ms) {
  return sqlite::all(
      sqlite::Statement::prepare(
          database,
          "SELECT slot, what, CASE WHEN active THEN 'active' WHEN slot = 1 THEN 'previous'"
          " ELSE 'candidate' END, row FROM (SELECT slot, " SELFCAL_DAMAGED_SLOT
          " AS what, " SELFCAL_WAS_ACTIVE
          " AS active, quote(slot) || ', ' || quote(session) || ', ' || quote(since_ms) || ', ' ||"
          " quote(model_hash) || ', ' || quote(robot) || ', ' || quote(checksum) AS row FROM slot)"
          " WHERE what IS NOT NULL"),
      [&](const sqlite::Statement& row) {
        return DamagedSlot{row.integer(0), {unix_ms, row.text(2), row.text(1), row.text(3)}};
      });
}

/// A result whose candidate is gone was dropped.
Result<void> drop_candidates(sqlite3* database) {
  const auto waiting = sqlite::all(
      sqlite::Statement::prepare(
          database,
          "SELECT session FROM result WHERE decision IN ('candidate', 'applying') AND session NOT"
          " IN (SELECT coalesce(session, 0) FROM slot WHERE slot = 2)"),
      [](const sqlite::Statement& row) { return row.integer(0); });
  if (!waiting) return tl::unexpected(waiting.error());
  for (const std::int64_t session : *waiting) {
    if (auto set = set_decision(database, session, ResultDecision::rejected,
                                "; its parameters were damaged in the store");
        !set) {
      return set;
    }
  }
  return {};
}

/// Sessions that are unfinished and cannot go on are ended.
Result<Names> end_broken_sessions(sqlite3* database, std::int64_t unix_ms) {
  const auto broken = sqlite::all(
      sqlite::Statement::prepare(
          database,
          "SELECT session.id FROM session LEFT JOIN text ON text.id = session.config"
          " LEFT JOIN plan ON plan.session = session.id"
          " LEFT JOIN posture ON posture.session = session.id"
          " WHERE state IN (0, 1) AND " SELFCAL_DAMAGED_SESSION " IS NULL"
          " AND (text.id IS NULL OR plan.session IS NULL OR posture.session IS NULL"
          " OR " SELFCAL_DAMAGED_TEXT " IS NOT NULL OR " SELFCAL_DAMAGED_PLAN " IS NOT NULL"
          " OR " SELFCAL_DAMAGED_POSTURE " IS NOT NULL)"),
      [](const sqlite::Statement& row) { return row.integer(0); });
  if (!broken) return tl::unexpected(broken.error());
  Names ended;
  for (const std::int64_t id : *broken) {
    if (auto set = set_session_state(database, id, SessionState::aborted, unix_ms); !set) {
      return tl::unexpected(set.error());
    }
    ended.push_back("session " + std::to_string(id) + " cannot go on and is ended");
  }
  return ended;
}

/// What is damaged and had not been noted.
Result<std::vector<DamageRecord>> fresh_damage(sqlite3* database, std::int64_t unix_ms) {
  Result<Names> known = names(database, "SELECT what FROM damage ORDER BY what");
  if (!known) return tl::unexpected(known.error());
  std::vector<DamageRecord> fresh;
  for (const Verified& table : kVerified) {
    if (std::string_view(table.table) == kSlots.table) continue;  // their own way
    const Result<Names> damaged = damaged_rows(database, table);
    if (!damaged) return tl::unexpected(damaged.error());
    for (std::size_t i = 0; i < std::min(damaged->size(), kMostNotes); ++i) {
      if (!std::ranges::binary_search(*known, (*damaged)[i])) {
        fresh.push_back({unix_ms, table.table, (*damaged)[i], ""});
      }
    }
    if (damaged->size() <= kMostNotes) continue;
    const std::string more = std::string("further rows of the table ") + table.table;
    if (!std::ranges::binary_search(*known, more))
      fresh.push_back({unix_ms, table.table, more, ""});
  }
  return fresh;
}

std::string sentence(const Names& all) {
  std::string text;
  for (std::size_t i = 0; i < std::min(all.size(), kMostNamed); ++i) {
    text += (i == 0 ? "" : ", ") + all[i];
  }
  if (all.size() > kMostNamed) text += " and " + std::to_string(all.size() - kMostNamed) + " more";
  return text;
}

}  // namespace

Result<Names> damaged_rows(sqlite3* database, const Verified& table) {
  return names(database, std::string("SELECT what FROM (SELECT ") + table.damaged +
                             " AS what FROM " + table.table + ") WHERE what IS NOT NULL LIMIT " +
                             std::to_string(kMostNotes + 1));
}

Result<std::vector<DamageRecord>> notes_of_damage(sqlite3* database) {
  return sqlite::all(sqlite::Statement::prepare(
                         database, "SELECT unix_ms, place, what, row, " SELFCAL_DAMAGED_DAMAGE
                                   " FROM damage ORDER BY id DESC"),
                     [](const sqlite::Statement& row) {
                       if (!row.null(4))
                         return DamageRecord{0, "damage", row.text(4) + " is damaged", ""};
                       return DamageRecord{row.integer(0), row.text(1), row.text(2), row.text(3)};
                     });
}

Result<void> note_damage(sqlite3* database, const DamageRecord& found) {
  const auto id = sqlite::integer(
      database,
      "INSERT INTO damage(unix_ms, place, what, row) VALUES(?1, ?2, ?3, nullif(?4, ''))"
      " RETURNING id",
      {found.unix_ms, found.place, found.what, found.row});
  if (!id) return tl::unexpected(id.error());
  return put_checksum(database, kDamage, *id);
}

Result<std::vector<std::string>> set_slots_aside(sqlite3* database, std::int64_t unix_ms) {
  const auto damaged = damaged_slots(database, unix_ms);
  if (!damaged) return tl::unexpected(damaged.error());
  Names found;
  bool active = false;
  for (const DamagedSlot& each : *damaged) {
    if (auto noted = note_damage(database, each.note); !noted) {
      return tl::unexpected(noted.error());
    }
    const auto gone = done(sqlite::run(database, "DELETE FROM slot WHERE slot = ?1", {each.key}));
    if (!gone) return tl::unexpected(gone.error());
    active = active || each.note.place == "active";
    found.push_back(each.note.what);
  }
  if (active) {
    for (const char* sql :
         {"UPDATE slot SET slot = 0, since_ms = ?1 WHERE slot = 1",
          "UPDATE slot SET checksum = " SELFCAL_SLOT_CHECKSUM " WHERE slot = 0"}) {
      if (auto moved = done(sqlite::run(database, sql, {unix_ms})); !moved) {
        return tl::unexpected(moved.error());
      }
    }
  }
  if (found.empty()) return found;
  if (auto dropped = drop_candidates(database); !dropped) return tl::unexpected(dropped.error());
  return found;
}

Result<std::string> look_over(sqlite3* database, std::int64_t unix_ms) {
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database);
  if (!transaction) return tl::unexpected(transaction.error());
  Result<Names> said = set_slots_aside(database, unix_ms);
  if (!said) return tl::unexpected(said.error());
  const auto fresh = fresh_damage(database, unix_ms);
  if (!fresh) return tl::unexpected(fresh.error());
  for (const DamageRecord& each : *fresh) {
    if (auto noted = note_damage(database, each); !noted) return tl::unexpected(noted.error());
    said->push_back(each.what);
  }
  const Result<Names> ended = end_broken_sessions(database, unix_ms);
  if (!ended) return tl::unexpected(ended.error());
  if (auto kept = transaction->commit(); !kept) return tl::unexpected(kept.error());
  if (said->empty() && ended->empty()) return std::string();
  std::string text = said->empty() ? "" : "damaged and not used: " + sentence(*said);
  for (const std::string& each : *ended) text += (text.empty() ? "" : "; ") + each;
  return text;
}

}  // namespace selfcal
