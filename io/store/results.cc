// Results of sessions, and the candidate that a result may come with.
#include "io/store/checksums.h"
#include "io/store/sqlite.h"
#include "io/store/store.h"
#include "io/store/tables.h"

namespace selfcal {
namespace {

#define SELFCAL_FIGURES                                                            \
  "SELECT result.session, unix_ms, answer, decision, why, p_value, check_before, " \
  "check_after, endpoint_sigma, touches, rejected, identified, " SELFCAL_DAMAGED_RESULT
constexpr int kDamagedResult = 12;

Result<void> add_result(sqlite3* database, const ResultRecord& result) {
  if (auto there = require_session(database, result.session); !there) return there;
  const Result<std::int64_t> robot = keep_text(database, result.robot_text);
  if (!robot) return tl::unexpected(robot.error());
  const auto added = sqlite::run(
      database,
      "INSERT INTO result VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, NULL)",
      {result.session, result.unix_ms, std::string(to_string(result.answer)),
       std::string(to_string(result.decision)), result.why, result.p_value, result.check_before,
       result.check_after, result.endpoint_sigma, std::int64_t{result.touches},
       std::int64_t{result.outliers}, std::int64_t{result.identified}, *robot});
  if (!added) return tl::unexpected(added.error());
  if (auto put = put_checksum(database, kResults, result.session); !put) return put;
  if (!result.json.empty()) {
    const auto kept = sqlite::run(database, "INSERT INTO json VALUES(?1, ?2, NULL)",
                                  {result.session, result.json});
    if (!kept) return tl::unexpected(kept.error());
    if (auto put = put_checksum(database, kJsons, result.session); !put) return put;
  }
  return set_session_state(database, result.session, SessionState::finished, result.unix_ms);
}

/// Puts the candidate; the one that it takes the place of was neither accepted nor rejected.
Result<void> put_candidate(sqlite3* database, const SlotRecord& candidate) {
  const auto replaced = sqlite::integer(database,
                                        "SELECT session FROM slot WHERE slot = 2 AND session <> ?1"
                                        " AND " SELFCAL_DAMAGED_SLOT " IS NULL",
                                        {candidate.session});
  if (!replaced) return tl::unexpected(replaced.error());
  if (auto set = set_decision(database, *replaced, ResultDecision::replaced); !set) return set;
  const Result<std::int64_t> robot = keep_text(database, candidate.robot_text);
  if (!robot) return tl::unexpected(robot.error());
  const auto put = sqlite::run(
      database, "INSERT OR REPLACE INTO slot VALUES(2, nullif(?1, 0), ?2, ?3, ?4, NULL)",
      {candidate.session, candidate.since_ms, candidate.model_hash, *robot});
  if (!put) return tl::unexpected(put.error());
  return put_checksum(database, kSlots, static_cast<std::int64_t>(Slot::candidate));
}

}  // namespace

Result<void> Store::finish(const ResultRecord& result, const SlotRecord* candidate,
                           const Remembered& kept) {
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database_);
  if (!transaction) return tl::unexpected(transaction.error());
  if (auto added = add_result(database_, result); !added) return added;
  if (candidate != nullptr) {
    if (auto put = put_candidate(database_, *candidate); !put) return put;
  }
  if (!kept.name.empty())
    if (auto put = put_remembered(database_, kept); !put) return put;
  return commit(*transaction);
}

ResultRecord Store::figures_of(const sqlite::Statement& row) {
  ResultRecord result;
  result.session = row.integer(0);
  result.unix_ms = row.integer(1);
  // A text that is none of ours was written by nobody: it decides nothing.
  result.answer = parse_answer(row.text(2)).value_or(ResultAnswer::failed);
  result.decision = parse_decision(row.text(3)).value_or(ResultDecision::none);
  result.why = row.text(4);
  result.p_value = row.real(5);
  result.check_before = row.real(6);
  result.check_after = row.real(7);
  result.endpoint_sigma = row.real(8);
  result.touches = static_cast<std::uint32_t>(row.integer(9));
  result.outliers = static_cast<std::uint32_t>(row.integer(10));
  result.identified = static_cast<std::uint32_t>(row.integer(11));
  return result;
}

Result<std::optional<ResultRecord>> Store::result(std::int64_t session) {
  if (auto there = require_session(database_, session); !there) {
    return tl::unexpected(there.error());
  }
  auto row = sqlite::Statement::prepare(
      database_,
      SELFCAL_FIGURES ", json.body, " SELFCAL_DAMAGED_JSON ", text.body, " SELFCAL_DAMAGED_TEXT
                      " FROM result LEFT JOIN text ON text.id = robot"
                      " LEFT JOIN json ON json.session = result.session"
                      " WHERE result.session = ?1",
      {session});
  if (!row) return tl::unexpected(row.error());
  const Result<bool> there = row->step();
  if (!there) return tl::unexpected(there.error());
  if (!*there) return std::nullopt;
  if (!sound(*row, kDamagedResult))
    return sqlite::failure(database_, row->text(kDamagedResult) + " is damaged");
  ResultRecord result = figures_of(*row);
  if (sound(*row, 14)) result.json = row->text(13);
  if (sound(*row, 16)) result.robot_text = row->text(15);
  return result;
}

Result<std::vector<ResultRecord>> Store::results(int newest) {
  auto rows =
      sqlite::Statement::prepare(database_, SELFCAL_FIGURES " FROM result ORDER BY session DESC");
  if (!rows) return tl::unexpected(rows.error());
  std::vector<ResultRecord> results;
  while (std::ssize(results) < newest) {
    const Result<bool> row = rows->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) break;
    if (sound(*rows, kDamagedResult)) results.push_back(figures_of(*rows));
  }
  return results;
}

}  // namespace selfcal
