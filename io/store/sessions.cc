// Sessions and their plans. A plan is two blobs: labels stay as long as raw rows that need them,
// postures are pruned earlier.
#include "io/store/packing.h"
#include "io/store/sqlite.h"
#include "io/store/store.h"
#include "io/store/tables.h"

namespace selfcal {
namespace {

#define SELFCAL_SESSIONS                                                                \
  "SELECT s.id, kind, reason, model_hash, config_hash, body, seed, state, started_ms, " \
  "ended_ms, steps FROM session s JOIN text ON text.id = s.config "

SessionRecord session_of(const sqlite::Statement& row) {
  SessionRecord session;
  session.id = row.integer(0);
  session.kind = row.text(1);
  session.reason = row.text(2);
  session.model_hash = row.text(3);
  session.config_hash = row.text(4);
  session.config = row.text(5);
  session.seed = static_cast<std::uint64_t>(row.integer(6));
  session.state = static_cast<SessionState>(row.integer(7));
  session.started_ms = row.integer(8);
  session.ended_ms = row.integer(9);
  session.steps = static_cast<int>(row.integer(10));
  return session;
}

Result<std::vector<SessionRecord>> sessions_of(Result<sqlite::Statement> rows) {
  return sqlite::all(std::move(rows), session_of);
}

Result<std::int64_t> add_session(sqlite3* database, const SessionRecord& session,
                                 std::size_t steps) {
  Result<std::int64_t> config = keep_text(database, session.config);
  if (!config) return config;
  return sqlite::integer(
      database,
      "INSERT INTO session(kind, reason, model_hash, config_hash, config, seed, state,"
      " started_ms, ended_ms, steps) VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10) RETURNING id",
      {session.kind, session.reason, session.model_hash, session.config_hash, *config,
       static_cast<std::int64_t>(session.seed), static_cast<std::int64_t>(session.state),
       session.started_ms, session.ended_ms, static_cast<std::int64_t>(steps)});
}

}  // namespace

Result<std::int64_t> Store::begin(const SessionRecord& session,
                                  const std::vector<StepRecord>& plan) {
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database_);
  if (!transaction) return tl::unexpected(transaction.error());
  Result<std::int64_t> id = add_session(database_, session, plan.size());
  if (!id) return id;
  const std::string labels = pack_labels(plan);
  const std::string postures = pack_postures(plan);
  for (const auto& [sql, blob] : {std::pair{"INSERT INTO plan VALUES(?1, ?2)", &labels},
                                  std::pair{"INSERT INTO posture VALUES(?1, ?2)", &postures}}) {
    const auto added = sqlite::run(database_, sql, {*id, sqlite::Blob{*blob}});
    if (!added) return tl::unexpected(added.error());
  }
  if (auto done = transaction->commit(); !done) return tl::unexpected(done.error());
  return id;
}

Result<void> Store::set_state(std::int64_t session, SessionState state, std::int64_t unix_ms) {
  const bool ends = state == SessionState::finished || state == SessionState::aborted;
  const auto changed =
      sqlite::run(database_, "UPDATE session SET state = ?2, ended_ms = ?3 WHERE id = ?1",
                  {session, static_cast<std::int64_t>(state), ends ? unix_ms : 0});
  if (!changed) return tl::unexpected(changed.error());
  if (*changed == 1) return {};
  return require_session(database_, session);
}

Result<std::optional<SessionRecord>> Store::unfinished() {
  auto found = sessions_of(sqlite::Statement::prepare(
      database_, SELFCAL_SESSIONS "WHERE state IN (0, 1) ORDER BY s.id DESC LIMIT 1"));
  if (!found) return tl::unexpected(found.error());
  if (found->empty()) return std::nullopt;
  return std::move(found->front());
}

Result<std::vector<SessionRecord>> Store::sessions(int newest) {
  return sessions_of(sqlite::Statement::prepare(database_,
                                                SELFCAL_SESSIONS "ORDER BY s.id DESC LIMIT ?1",
                                                {std::int64_t{newest < 0 ? 0 : newest}}));
}

Result<SessionRecord> Store::session(std::int64_t id) {
  auto found =
      sessions_of(sqlite::Statement::prepare(database_, SELFCAL_SESSIONS "WHERE s.id = ?1", {id}));
  if (!found) return tl::unexpected(found.error());
  if (!found->empty()) return std::move(found->front());
  return sqlite::failure(database_, "there is no session " + std::to_string(id));
}

Result<std::vector<StepRecord>> Store::plan(std::int64_t session) {
  if (auto there = require_session(database_, session); !there) {
    return tl::unexpected(there.error());
  }
  auto row = sqlite::Statement::prepare(
      database_,
      "SELECT labels, postures FROM plan LEFT JOIN posture USING(session) WHERE session = ?1",
      {session});
  if (!row) return tl::unexpected(row.error());
  const Result<bool> there = row->step();
  if (!there) return tl::unexpected(there.error());
  std::vector<StepRecord> plan;
  if (!*there) return plan;
  if (unpack_labels(row->text(0), plan) && (row->null(1) || unpack_postures(row->text(1), plan))) {
    return plan;
  }
  return sqlite::failure(database_,
                         "the plan of session " + std::to_string(session) + " is damaged");
}

}  // namespace selfcal
