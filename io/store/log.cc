// Events, and small texts kept under a name.
#include "io/store/sqlite.h"
#include "io/store/store.h"

namespace selfcal {

Result<void> Store::add(const EventRecord& event) {
  const auto added =
      sqlite::run(database_, "INSERT INTO event(unix_ms, level, text) VALUES(?1, ?2, ?3)",
                  {event.unix_ms, event.level, event.text});
  if (!added) return tl::unexpected(added.error());
  return {};
}

Result<std::vector<EventRecord>> Store::events(int newest) {
  return sqlite::all(
      sqlite::Statement::prepare(
          database_, "SELECT id, unix_ms, level, text FROM event ORDER BY id DESC LIMIT ?1",
          {std::int64_t{newest < 0 ? 0 : newest}}),
      [](const sqlite::Statement& row) {
        return EventRecord{row.integer(0), row.integer(1), row.text(2), row.text(3)};
      });
}

Result<void> Store::remember(const std::string& name, const std::string& text) {
  const auto kept =
      sqlite::run(database_, "INSERT OR REPLACE INTO remembered VALUES(?1, ?2)", {name, text});
  if (!kept) return tl::unexpected(kept.error());
  return {};
}

Result<std::string> Store::remembered(const std::string& name) {
  return sqlite::text(database_, "SELECT text FROM remembered WHERE name = ?1", {name});
}

}  // namespace selfcal
