#include "io/store/tables.h"

#include <string>

#include "io/files/file.h"
#include "io/store/checksums.h"
#include "io/store/sqlite.h"

namespace selfcal {

Result<std::int64_t> keep_text(sqlite3* database, std::string_view body) {
  const std::string hash = sha256_hex(body);
  const auto kept =
      sqlite::run(database, "INSERT OR IGNORE INTO text(hash, body) VALUES(?1, ?2)", {hash, body});
  if (!kept) return kept;
  Result<std::int64_t> id =
      sqlite::integer(database, "SELECT id FROM text WHERE hash = ?1", {hash});
  if (!id || *kept == 1) return id;
  // By the row, not by the index that led to it.
  const auto right = sqlite::integer(
      database, "SELECT count(*) FROM text NOT INDEXED WHERE id = ?1 AND hash = ?2", {*id, hash});
  if (!right) return right;
  if (*right != 1) return sqlite::failure(database, "the index of its texts is damaged");
  const auto whole = sqlite::run(
      database, "UPDATE text SET body = ?2 WHERE id = ?1 AND body IS NOT ?2", {*id, body});
  if (!whole) return whole;
  return id;
}

Result<void> put_remembered(sqlite3* database, const Remembered& kept) {
  const auto put = sqlite::run(database, "INSERT OR REPLACE INTO remembered VALUES(?1, ?2, NULL)",
                               {kept.name, kept.text});
  if (!put) return tl::unexpected(put.error());
  return put_checksum(database, kRemembered, kept.name);
}

tl::unexpected<Failure> no_session(sqlite3* database, std::int64_t session) {
  const auto there = sqlite::text(
      database,
      "SELECT CASE count(*) WHEN 0 THEN 'it has none yet' WHEN 1 THEN 'it has session ' || max(id)"
      " WHEN max(id) - min(id) + 1 THEN 'it has sessions ' || min(id) || ' to ' || max(id)"
      " ELSE 'it has ' || count(*) || ' of sessions ' || min(id) || ' to ' || max(id) END"
      " FROM session");
  if (!there) return tl::unexpected(there.error());
  return sqlite::not_there(database,
                           "there is no session " + std::to_string(session) + ": " + *there);
}

Result<void> require_session(sqlite3* database, std::int64_t session) {
  const auto found =
      sqlite::integer(database, "SELECT count(*) FROM session WHERE id = ?1", {session});
  if (!found) return tl::unexpected(found.error());
  if (*found == 1) return {};
  return no_session(database, session);
}

Result<void> require_sound_session(sqlite3* database, std::int64_t session) {
  if (auto there = require_session(database, session); !there) return there;
  const auto wrong = sqlite::text(database,
                                  "SELECT ifnull(" SELFCAL_DAMAGED_SESSION
                                  " || ' is damaged', '') FROM session WHERE id = ?1",
                                  {session});
  if (!wrong) return tl::unexpected(wrong.error());
  if (wrong->empty()) return {};
  return sqlite::failure(database, *wrong);
}

Result<void> set_session_state(sqlite3* database, std::int64_t session, SessionState state,
                               std::int64_t ended_ms) {
  if (auto sound = require_sound_session(database, session); !sound) return sound;
  const auto changed =
      sqlite::run(database, "UPDATE session SET state = ?2, ended_ms = ?3 WHERE id = ?1",
                  {session, static_cast<std::int64_t>(state), ended_ms});
  if (!changed) return tl::unexpected(changed.error());
  return put_checksum(database, kSessions, session);
}

Result<void> set_decision(sqlite3* database, std::int64_t session, ResultDecision decision,
                          std::string_view why) {
  const auto changed =
      sqlite::run(database,
                  "UPDATE result SET decision = ?2, why = why || ?3 WHERE session = ?1"
                  " AND " SELFCAL_DAMAGED_RESULT " IS NULL",
                  {session, to_string(decision), why});
  if (!changed) return tl::unexpected(changed.error());
  if (*changed == 0) return {};
  return put_checksum(database, kResults, session);
}

}  // namespace selfcal
