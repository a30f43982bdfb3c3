// Touches: the raw counts that everything else can be computed from again.
#include "io/store/checksums.h"
#include "io/store/packing.h"
#include "io/store/sqlite.h"
#include "io/store/store.h"
#include "io/store/tables.h"

namespace selfcal {
namespace {

/// Fails when the session cannot take a touch of this step.
Result<void> check_room(sqlite3* database, std::int64_t session, const TouchRecord& touch) {
  if (auto sound = require_sound_session(database, session); !sound) return sound;
  const auto fits = sqlite::integer(
      database, "SELECT state < 2 AND ?2 >= 0 AND ?2 < steps FROM session WHERE id = ?1",
      {session, std::int64_t{touch.step}});
  if (!fits) return tl::unexpected(fits.error());
  if (*fits == 1) return {};
  return sqlite::failure(database, "session " + std::to_string(session) +
                                       " has ended or has no step " + std::to_string(touch.step));
}

/// The key of a session's first touch; those of its others follow.
std::int64_t first_touch(std::int64_t session) { return session << 20; }

/// The key of a session's next touch.
Result<std::int64_t> next_touch(sqlite3* database, std::int64_t session) {
  const std::int64_t first = first_touch(session);
  const std::int64_t end = first_touch(session + 1);
  auto id = sqlite::integer(
      database, "SELECT coalesce(max(id) + 1, ?1) FROM touch WHERE id >= ?1 AND id < ?2",
      {first, end});
  if (!id || *id < end) return id;
  return sqlite::failure(database, "session " + std::to_string(session) + " is full");
}

sqlite::Value or_null(std::string_view text) {
  return text.empty() ? sqlite::Value(nullptr) : sqlite::Value(text);
}

}  // namespace

Result<void> Store::add(std::int64_t session, const TouchRecord& touch) {
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database_);
  if (!transaction) return tl::unexpected(transaction.error());
  if (auto room = check_room(database_, session, touch); !room) return room;
  const Result<std::int64_t> id = next_touch(database_, session);
  if (!id) return tl::unexpected(id.error());
  const std::string stamps = pack_stamps(touch);
  const auto added =
      sqlite::run(database_, "INSERT INTO touch VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, NULL)",
                  {*id, std::int64_t{touch.step}, std::int64_t{touch.attempt},
                   static_cast<std::int64_t>(touch.outcome), or_null(touch.why), touch.unix_ms,
                   touch.temperature, sqlite::Blob{stamps}});
  if (!added) return tl::unexpected(added.error());
  if (auto put = put_checksum(database_, kTouches, *id); !put) return put;
  return commit(*transaction);
}

Result<std::vector<TouchRecord>> Store::touches(std::int64_t session) {
  if (auto there = require_session(database_, session); !there) {
    return tl::unexpected(there.error());
  }
  auto rows = sqlite::Statement::prepare(
      database_,
      "SELECT step, attempt, outcome, why, unix_ms, temperature, stamps, " SELFCAL_DAMAGED_TOUCH
      " FROM touch"
      " WHERE id >= ?1 AND id < ?2 ORDER BY id",
      {first_touch(session), first_touch(session + 1)});
  if (!rows) return tl::unexpected(rows.error());
  std::vector<TouchRecord> touches;
  for (;;) {
    const Result<bool> row = rows->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return touches;
    if (!sound(*rows, 7)) continue;
    TouchRecord& touch = touches.emplace_back();
    touch.step = static_cast<int>(rows->integer(0));
    touch.attempt = static_cast<int>(rows->integer(1));
    touch.outcome = static_cast<TouchOutcome>(rows->integer(2));
    touch.why = rows->text(3);
    touch.unix_ms = rows->integer(4);
    touch.temperature = rows->real(5);
    if (!unpack_stamps(rows->text(6), touch)) {
      return sqlite::failure(database_, "touch " + std::to_string(touches.size() - 1) +
                                            " of session " + std::to_string(session) +
                                            " is damaged");
    }
  }
}

}  // namespace selfcal
