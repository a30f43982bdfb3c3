// Sessions and their plans. A plan is two blobs: labels stay as long as raw rows that need them,
// postures are pruned earlier.
#include "io/store/checksums.h"
#include "io/store/packing.h"
#include "io/store/sqlite.h"
#include "io/store/store.h"
#include "io/store/tables.h"

namespace selfcal {
namespace {

#define SELFCAL_SESSIONS                                                            \
  "SELECT session.id, kind, reason, model_hash, config_hash, body, seed, state, "   \
  "started_ms, ended_ms, steps, " SELFCAL_DAMAGED_SESSION ", " SELFCAL_DAMAGED_TEXT \
  " FROM session LEFT JOIN text ON text.id = session.config "
constexpr int kDamagedSession = 11, kDamagedConfig = 12;

/// The number after that of every session that any table speaks of: of a damaged store rows may be
/// left whose session is lost. A touch has its session from bit 20 of its id on.
#define SELFCAL_NEXT_SESSION                                                             \
  "(SELECT 1 + ifnull(max(n), 0) FROM (SELECT max(id) AS n FROM session UNION ALL "      \
  "SELECT max(session) FROM plan UNION ALL SELECT max(session) FROM posture UNION ALL "  \
  "SELECT max(id) >> 20 FROM touch UNION ALL SELECT max(session) FROM result UNION ALL " \
  "SELECT max(session) FROM json UNION ALL SELECT max(session) FROM slot))"

Result<std::int64_t> add_session(sqlite3* database, const SessionRecord& session,
                                 std::size_t steps) {
  Result<std::int64_t> config = keep_text(database, session.config);
  if (!config) return config;
  Result<std::int64_t> id = sqlite::integer(
      database,
      "INSERT INTO session(id, kind, reason, model_hash, config_hash, config, seed, state,"
      " started_ms, ended_ms, steps) VALUES(" SELFCAL_NEXT_SESSION
      ", ?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10) RETURNING id",
      {session.kind, session.reason, session.model_hash, session.config_hash, *config,
       static_cast<std::int64_t>(session.seed), static_cast<std::int64_t>(session.state),
       session.started_ms, session.ended_ms, static_cast<std::int64_t>(steps)});
  if (!id) return id;
  if (auto put = put_checksum(database, kSessions, *id); !put) return tl::unexpected(put.error());
  return id;
}

Result<void> add_blob(sqlite3* database, const Verified& table, std::int64_t session,
                      const std::string& blob) {
  const std::string sql =
      std::string("INSERT OR REPLACE INTO ") + table.table + " VALUES(?1, ?2, NULL)";
  const auto added = sqlite::run(database, sql.c_str(), {session, sqlite::Blob{blob}});
  if (!added) return tl::unexpected(added.error());
  return put_checksum(database, table, session);
}

/// One session at a time: what another begins beside has been given up.
Result<void> end_unfinished(sqlite3* database, std::int64_t unix_ms) {
  const auto others =
      sqlite::all(sqlite::Statement::prepare(database,
                                             "SELECT id FROM session WHERE state IN (0, 1)"
                                             " AND " SELFCAL_DAMAGED_SESSION " IS NULL"),
                  [](const sqlite::Statement& row) { return row.integer(0); });
  if (!others) return tl::unexpected(others.error());
  for (const std::int64_t id : *others)
    if (auto set = set_session_state(database, id, SessionState::aborted, unix_ms); !set)
      return set;
  return {};
}

}  // namespace

Result<std::int64_t> Store::begin(const SessionRecord& session,
                                  const std::vector<StepRecord>& plan) {
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database_);
  if (!transaction) return tl::unexpected(transaction.error());
  if (auto ended = end_unfinished(database_, session.started_ms); !ended)
    return tl::unexpected(ended.error());
  Result<std::int64_t> id = add_session(database_, session, plan.size());
  if (!id) return id;
  if (auto added = add_blob(database_, kPlans, *id, pack_labels(plan)); !added) {
    return tl::unexpected(added.error());
  }
  if (auto added = add_blob(database_, kPostures, *id, pack_postures(plan)); !added) {
    return tl::unexpected(added.error());
  }
  if (auto done = commit(*transaction); !done) return tl::unexpected(done.error());
  return id;
}

Result<void> Store::extend(std::int64_t session, const std::vector<StepRecord>& steps) {
  Result<std::vector<StepRecord>> plan = this->plan(session);
  if (!plan) return tl::unexpected(plan.error());
  for (const StepRecord& step : steps) {
    plan->push_back(step);
    plan->back().index = static_cast<int>(plan->size()) - 1;
  }
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database_);
  if (!transaction) return tl::unexpected(transaction.error());
  const auto changed =
      sqlite::run(database_, "UPDATE session SET steps = ?2 WHERE id = ?1 AND state < 2",
                  {session, static_cast<std::int64_t>(plan->size())});
  if (!changed) return tl::unexpected(changed.error());
  if (*changed == 0)
    return sqlite::failure(database_, "session " + std::to_string(session) + " has ended");
  if (auto put = put_checksum(database_, kSessions, session); !put) return put;
  if (auto put = add_blob(database_, kPlans, session, pack_labels(*plan)); !put) return put;
  if (auto put = add_blob(database_, kPostures, session, pack_postures(*plan)); !put) return put;
  if (auto set = set_session_state(database_, session, SessionState::collecting, 0); !set)
    return set;
  return commit(*transaction);
}

Result<void> Store::set_state(std::int64_t session, SessionState state, std::int64_t unix_ms) {
  const bool ends = state == SessionState::finished || state == SessionState::aborted;
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database_);
  if (!transaction) return tl::unexpected(transaction.error());
  if (auto set = set_session_state(database_, session, state, ends ? unix_ms : 0); !set) return set;
  return commit(*transaction);
}

SessionRecord Store::session_of(const sqlite::Statement& row) {
  SessionRecord session;
  session.id = row.integer(0);
  if (!sound(row, kDamagedSession)) {
    session.reason = "this row of the store is damaged";
    session.state = SessionState::aborted;
    return session;
  }
  session.kind = row.text(1);
  session.reason = row.text(2);
  session.model_hash = row.text(3);
  session.config_hash = row.text(4);
  if (sound(row, kDamagedConfig)) session.config = row.text(5);
  session.seed = static_cast<std::uint64_t>(row.integer(6));
  session.state = static_cast<SessionState>(row.integer(7));
  session.started_ms = row.integer(8);
  session.ended_ms = row.integer(9);
  session.steps = static_cast<int>(row.integer(10));
  return session;
}

Result<std::optional<SessionRecord>> Store::unfinished() {
  auto rows = sqlite::Statement::prepare(
      database_, SELFCAL_SESSIONS "WHERE state IN (0, 1) ORDER BY session.id DESC");
  if (!rows) return tl::unexpected(rows.error());
  for (;;) {
    const Result<bool> row = rows->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return std::nullopt;
    if (sound(*rows, kDamagedSession) && sound(*rows, kDamagedConfig)) return session_of(*rows);
  }
}

Result<std::vector<SessionRecord>> Store::sessions(int newest) {
  return sqlite::all(
      sqlite::Statement::prepare(database_, SELFCAL_SESSIONS "ORDER BY session.id DESC LIMIT ?1",
                                 {std::int64_t{newest < 0 ? 0 : newest}}),
      [this](const sqlite::Statement& row) { return session_of(row); });
}

Result<SessionRecord> Store::session(std::int64_t id) {
  auto row = sqlite::Statement::prepare(database_, SELFCAL_SESSIONS "WHERE session.id = ?1", {id});
  if (!row) return tl::unexpected(row.error());
  const Result<bool> there = row->step();
  if (!there) return tl::unexpected(there.error());
  const std::string name = "session " + std::to_string(id);
  if (!*there) return no_session(database_, id);
  if (!sound(*row, kDamagedSession)) return sqlite::failure(database_, name + " is damaged");
  if (!sound(*row, kDamagedConfig)) {
    return sqlite::failure(database_, "the configuration of " + name + " is damaged");
  }
  return session_of(*row);
}

Result<std::vector<StepRecord>> Store::plan(std::int64_t session) {
  if (auto there = require_session(database_, session); !there) {
    return tl::unexpected(there.error());
  }
  auto row = sqlite::Statement::prepare(
      database_,
      "SELECT labels, postures, " SELFCAL_DAMAGED_PLAN ", " SELFCAL_DAMAGED_POSTURE
      ", state < 2 FROM plan LEFT JOIN session ON session.id = plan.session"
      " LEFT JOIN posture ON posture.session = plan.session WHERE plan.session = ?1",
      {session});
  if (!row) return tl::unexpected(row.error());
  const Result<bool> there = row->step();
  if (!there) return tl::unexpected(there.error());
  std::vector<StepRecord> plan;
  if (!*there) return plan;
  const bool labels = sound(*row, 2), postures = sound(*row, 3), needed = row->integer(4) != 0;
  // Without postures a plan is as one that was pruned: enough to solve its rows again.
  const bool without = row->null(1) || (!postures && !needed);
  if (labels && (postures || !needed) && unpack_labels(row->text(0), plan) &&
      (without || unpack_postures(row->text(1), plan))) {
    return plan;
  }
  return sqlite::failure(database_,
                         "the plan of session " + std::to_string(session) + " is damaged");
}

}  // namespace selfcal
