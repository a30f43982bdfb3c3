#include "io/store/tables.h"

#include <string>

#include "io/file.h"
#include "io/store/sqlite.h"

namespace selfcal {

Result<std::int64_t> keep_text(sqlite3* database, std::string_view body) {
  const std::string hash = sha256_hex(body);
  const auto kept =
      sqlite::run(database, "INSERT OR IGNORE INTO text(hash, body) VALUES(?1, ?2)", {hash, body});
  if (!kept) return tl::unexpected(kept.error());
  return sqlite::integer(database, "SELECT id FROM text WHERE hash = ?1", {hash});
}

Result<void> require_session(sqlite3* database, std::int64_t session) {
  const auto found =
      sqlite::integer(database, "SELECT count(*) FROM session WHERE id = ?1", {session});
  if (!found) return tl::unexpected(found.error());
  if (*found == 1) return {};
  return sqlite::failure(database, "there is no session " + std::to_string(session));
}

}  // namespace selfcal
