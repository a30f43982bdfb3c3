// Forgetting: the cheapest to lose first, of each kind the oldest first, until the rest fits.
//
// Sessions, figures of results, calibrated robots and slots stay for ever. A plan goes in two
// parts: where to go (postures, the larger part), then with the raw rows the names of its steps,
// for without names raw rows cannot be solved again.
#include <array>

#include "io/store/sqlite.h"
#include "io/store/store.h"

namespace selfcal {
namespace {

// The newest session, the one that may be resumed, and those behind a slot.
#define SELFCAL_MAY_GO                                                    \
  "session NOT IN (SELECT coalesce(max(id), 0) FROM session"              \
  " UNION SELECT coalesce(max(id), 0) FROM session WHERE state IN (0, 1)" \
  " UNION SELECT coalesce(session, 0) FROM slot) ORDER BY session"

/// A kind of thing to forget: the ids that have it, oldest first, and what forgets that of id ?1.
struct Forgettable {
  const char* oldest_first;
  const char* forget;
  const char* forget_too;
};

constexpr std::array kForgettable{
    Forgettable{"SELECT id FROM event ORDER BY id", "DELETE FROM event WHERE id = ?1", nullptr},
    Forgettable{"SELECT session FROM json WHERE " SELFCAL_MAY_GO,
                "DELETE FROM json WHERE session = ?1", nullptr},
    // Postures and touches put aside go together, so that the first tells of both.
    Forgettable{"SELECT session FROM posture WHERE " SELFCAL_MAY_GO,
                "DELETE FROM posture WHERE session = ?1",
                "DELETE FROM touch WHERE id >= ?1 << 20 AND id < (?1 + 1) << 20 AND outcome = 1"},
    Forgettable{"SELECT session FROM plan WHERE " SELFCAL_MAY_GO,
                "DELETE FROM touch WHERE id >= ?1 << 20 AND id < (?1 + 1) << 20",
                "DELETE FROM plan WHERE session = ?1"},
};

Result<void> forget(sqlite3* database, const Forgettable& kind, std::int64_t id) {
  for (const char* sql : {kind.forget, kind.forget_too}) {
    if (sql == nullptr) continue;
    if (auto done = sqlite::run(database, sql, {id}); !done) return tl::unexpected(done.error());
  }
  return {};
}

/// Bytes of the pages that hold something; inside a transaction as it stands.
Result<std::int64_t> bytes_used(sqlite3* database) {
  std::array<std::int64_t, 3> numbers{};
  std::size_t i = 0;
  for (const char* sql : {"PRAGMA page_count", "PRAGMA freelist_count", "PRAGMA page_size"}) {
    Result<std::int64_t> number = sqlite::integer(database, sql);
    if (!number) return number;
    numbers[i++] = *number;
  }
  return (numbers[0] - numbers[1]) * numbers[2];
}

/// Whether it fits after forgetting what there is of `kind`, or a part of it.
Result<bool> forget_until(sqlite3* database, const Forgettable& kind, std::int64_t most_bytes) {
  const auto oldest_first =
      sqlite::all(sqlite::Statement::prepare(database, kind.oldest_first),
                  [](const sqlite::Statement& row) { return row.integer(0); });
  if (!oldest_first) return tl::unexpected(oldest_first.error());
  for (auto id = oldest_first->begin();; ++id) {
    const Result<std::int64_t> used = bytes_used(database);
    if (!used) return tl::unexpected(used.error());
    if (*used <= most_bytes) return true;
    if (id == oldest_first->end()) return false;
    if (auto done = forget(database, kind, *id); !done) return tl::unexpected(done.error());
  }
}

}  // namespace

Result<void> Store::prune(std::int64_t most_bytes) {
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database_);
  if (!transaction) return tl::unexpected(transaction.error());
  for (const Forgettable& kind : kForgettable) {
    const Result<bool> fits = forget_until(database_, kind, most_bytes);
    if (!fits) return tl::unexpected(fits.error());
    if (*fits) break;
  }
  if (auto done = commit(*transaction); !done) return done;
  // Free pages leave the file; it shrinks when the log is copied into it, later if someone reads.
  for (const char* sql : {"PRAGMA incremental_vacuum", "PRAGMA wal_checkpoint(TRUNCATE)"}) {
    if (auto ran = sqlite::run(database_, sql); !ran) return tl::unexpected(ran.error());
  }
  return {};
}

Result<std::int64_t> Store::bytes() { return bytes_used(database_); }

}  // namespace selfcal
