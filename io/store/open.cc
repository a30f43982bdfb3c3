// Opening: what is lost or damaged first (a newer store is not touched), then the settings, then a
// look at every row.
//
// Until all of it went well the connection leaves the write-ahead log alone when it closes, so
// that a damaged or newer store keeps what it has. WAL with synchronous=FULL syncs the log in
// every commit; see sqlite.org/wal.html and sqlite.org/pragma.html.
#include <sqlite3.h>
#include <unistd.h>

#include <chrono>
#include <system_error>
#include <utility>

#include "io/store/checksums.h"
#include "io/store/damage.h"
#include "io/store/folder.h"
#include "io/store/salvage.h"
#include "io/store/schema.h"
#include "io/store/sqlite.h"
#include "io/store/store.h"

namespace selfcal {
namespace {

namespace fs = std::filesystem;

constexpr int kBusy_ms = 5000;

std::int64_t unix_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

struct Close {
  void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};
using Connection = std::unique_ptr<sqlite3, Close>;

constexpr int kToMake = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;

Result<Connection> connect(const fs::path& path, int flags) {
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &handle, flags, nullptr);
  Connection database(handle);
  if (code != SQLITE_OK) {
    const char* what = handle == nullptr ? sqlite3_errstr(code) : sqlite3_errmsg(handle);
    return device_failed(path.string() + ": " + what);
  }
  sqlite3_busy_timeout(handle, kBusy_ms);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  if (auto added = add_checksum_functions(handle); !added) return tl::unexpected(added.error());
  return database;
}

/// Whether the file is whole: its version can be read, its tables are those of its version, and
/// integrity_check, which reads every page and index, finds nothing.
Result<bool> is_sound(sqlite3* database) {
  const auto found = has_its_columns(database).and_then([&](bool right) -> Result<std::string> {
    if (!right) return std::string("other tables");
    return sqlite::text(database, "PRAGMA integrity_check(1)");
  });
  if (found) return *found == "ok";
  const int code = sqlite3_errcode(database) & 0xff;  // without the extension
  if (code == SQLITE_CORRUPT || code == SQLITE_NOTADB) return false;
  return tl::unexpected(found.error());
}

/// A word of the file's header keeps SQLite from writing what the system lets one write.
bool is_locked_by_its_header(sqlite3* database, const fs::path& path) {
  return sqlite3_db_readonly(database, "main") == 1 && ::access(path.c_str(), W_OK) == 0;
}

Result<void> refuse_newer(sqlite3* database) {
  const Result<int> found = version(database);
  // One that cannot be read, or that no program will ever have, is for is_sound to judge.
  constexpr int kMostVersions = 1000;
  if (!found || *found <= static_cast<int>(migrations().size()) || *found > kMostVersions)
    return {};
  return sqlite::failure(database, "was written by a newer program (version " +
                                       std::to_string(*found) + " of the store)");
}

Result<void> apply_settings(sqlite3* database, std::initializer_list<const char*> settings) {
  for (const char* setting : settings) {
    if (auto done = sqlite::run(database, setting); !done) return tl::unexpected(done.error());
  }
  return {};
}

Result<void> configure(sqlite3* database) {
  auto done =
      apply_settings(database, {"PRAGMA synchronous = FULL", "PRAGMA foreign_keys = ON",
                                "PRAGMA trusted_schema = OFF", "PRAGMA cell_size_check = ON",
                                "PRAGMA journal_size_limit = 8388608"});
  if (!done) return done;
  const Result<std::string> mode = sqlite::text(database, "PRAGMA journal_mode = WAL");
  if (!mode) return tl::unexpected(mode.error());
  if (*mode != "wal") return sqlite::failure(database, "cannot keep a write-ahead log here");
  // The log stays when the service ends, so that a reader who may not write here can open it.
  int stay = 1;
  sqlite3_file_control(database, "main", SQLITE_FCNTL_PERSIST_WAL, &stay);
  return migrate(database, migrations());
}

/// Makes a store under another name, with what can be read of `damaged`, if one is given; the
/// number of rows that were.
Result<std::int64_t> make_store(const fs::path& folder, sqlite3* damaged) {
  remove_unnamed_store(folder);
  const Result<Connection> fresh = connect(unnamed_store_in(folder), kToMake);
  if (!fresh) return tl::unexpected(fresh.error());
  sqlite3* database = fresh->get();
  // auto_vacuum first: it holds only for a file that has nothing in it. EXTRA: the folder is synced
  // once the journal is gone.
  if (auto done = apply_settings(
          database, {"PRAGMA auto_vacuum = INCREMENTAL", "PRAGMA synchronous = EXTRA"});
      !done) {
    return tl::unexpected(done.error());
  }
  if (auto made = migrate(database, migrations()); !made) return tl::unexpected(made.error());
  return damaged == nullptr ? Result<std::int64_t>(0) : salvage(damaged, database);
}

/// Whether a store was made whole and has not got its name: the power went between the setting
/// aside of a damaged one and that, and it has all that could be read.
bool is_made(const fs::path& folder) {
  const fs::path path = unnamed_store_in(folder);
  if (std::error_code error; !fs::exists(path, error)) return false;
  const Result<Connection> made = connect(path, SQLITE_OPEN_READWRITE);
  if (!made || version(made->get()) != static_cast<int>(migrations().size())) return false;
  return is_sound(made->get()).value_or(false);
}

/// Begins a new store in the place of what is there, with what can be read of `damaged`; what is
/// said of it.
Result<std::string> begin_anew(const fs::path& folder, const std::string& why, Connection damaged) {
  const bool made = damaged == nullptr && is_made(folder);
  const Result<std::int64_t> rows = made ? 0 : make_store(folder, damaged.get());
  if (!rows) return tl::unexpected(rows.error());
  damaged.reset();
  const Result<std::string> aside = set_store_aside(folder);
  if (!aside) return tl::unexpected(aside.error());
  if (auto named = name_store(folder); !named) return tl::unexpected(named.error());
  if (why.empty()) return std::string();
  if (made) return why + "; the one that was made in its place is used";
  return why + (aside->empty() ? "" : " and is now " + *aside) + "; a new store was begun" +
         (*rows == 0 ? "" : " with " + std::to_string(*rows) + " rows that could be read");
}

/// A connection to a sound store of no newer version; `said` is what happened to the one before.
Result<Connection> connect_to_sound(const fs::path& folder, std::string& said) {
  const fs::path path = store_in(folder);
  Result<std::string> begun;
  if (!has_store(folder)) {
    begun = begin_anew(folder, lost_store(folder), nullptr);
  } else {
    Result<Connection> database = connect(path, SQLITE_OPEN_READWRITE);
    if (!database) return database;
    if (auto known = refuse_newer(database->get()); !known) return tl::unexpected(known.error());
    const Result<bool> sound = is_sound(database->get());
    if (!sound) return tl::unexpected(sound.error());
    const bool emptied = *sound && had_store(folder) && version(database->get()) == 0;
    const bool writable = !is_locked_by_its_header(database->get(), path);
    if (*sound && !emptied && writable) {
      remove_unnamed_store(folder);
      return database;
    }
    begun = begin_anew(folder, emptied ? "was emptied" : "was damaged", *std::move(database));
  }
  if (!begun) return tl::unexpected(begun.error());
  said = *std::move(begun);
  return connect(path, SQLITE_OPEN_READWRITE);
}

/// 0 where it cannot be read.
std::int64_t changes(sqlite3* database) {
  return sqlite::integer(database, "SELECT number FROM change").value_or(0);
}

/// Of a store that has had fewer changes than its mark says: what it lacks.
std::string lost_changes(sqlite3* database, const fs::path& folder) {
  const std::int64_t marked = marked_changes(folder);  // before the store, which may go on
  const std::int64_t lost = marked - changes(database);
  if (lost <= 0) return {};
  return "lacks the last " + std::to_string(lost) +
         " changes that it had: its log was damaged, or it is an older copy";
}

/// Looks at every row, and notes what was said of the store as a whole; what is to be said of both.
Result<std::string> look_at(sqlite3* database, const std::string& said_of_store) {
  const std::int64_t now = unix_ms();
  Result<std::string> of_rows = look_over(database, now);
  if (!of_rows || said_of_store.empty()) return of_rows;
  Result<sqlite::Transaction> transaction = sqlite::Transaction::begin(database);
  if (!transaction) return tl::unexpected(transaction.error());
  auto noted = note_damage(database, {now, "store", "the store " + said_of_store, ""});
  if (noted) noted = transaction->commit();
  if (!noted) return tl::unexpected(noted.error());
  return said_of_store + (of_rows->empty() ? "" : "; ") + *of_rows;
}

}  // namespace

Result<Store::Opened> Store::open(const fs::path& folder) {
  std::error_code ignored;  // what keeps the folder away keeps the file away, and SQLite says so
  fs::create_directory(folder, ignored);
  std::string said_of_store;
  Result<Connection> database = connect_to_sound(folder, said_of_store);
  if (!database) return tl::unexpected(database.error());
  if (auto ready = configure(database->get()); !ready) return tl::unexpected(ready.error());
  if (said_of_store.empty()) said_of_store = lost_changes(database->get(), folder);
  const Result<std::string> said = look_at(database->get(), said_of_store);
  if (!said) return tl::unexpected(said.error());
  const auto notes = notes_of_damage(database->get());
  if (!notes) return tl::unexpected(notes.error());
  sqlite3_db_config(database->get(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 0, nullptr);
  auto mark = StoreMark::open(folder);
  if (!mark) return tl::unexpected(mark.error());
  (*mark)->put(changes(database->get()));
  Opened opened;
  if (!said->empty()) opened.set_aside = store_in(folder).string() + ": " + *said;
  opened.store.reset(new Store(database->release(), *std::move(mark)));
  for (const DamageRecord& note : *notes) opened.store->known_.insert(note.what);
  return opened;
}

Result<std::unique_ptr<Store>> Store::open_to_read(const fs::path& folder) {
  if (std::error_code error; !fs::exists(store_in(folder), error) && !error)
    return bad_input(folder.string() + ": holds no " + store_in(folder).filename().string() +
                     ": the service has not run with this state yet, or keeps it in another "
                     "folder (`state` of its CONFIG.yaml)");
  Result<Connection> database = connect(store_in(folder), SQLITE_OPEN_READONLY);
  if (!database) return tl::unexpected(database.error());
  if (auto known = refuse_newer(database->get()); !known) return tl::unexpected(known.error());
  const std::string lost = lost_store(folder);
  if (!lost.empty()) return sqlite::failure(database->get(), lost);
  const Result<int> found = version(database->get());
  if (!found) return tl::unexpected(found.error());
  if (*found < static_cast<int>(migrations().size())) {
    return sqlite::failure(database->get(),
                           "is of an older version; the service brings it up to date");
  }
  const std::string lacking = lost_changes(database->get(), folder);
  const Result<bool> whole = is_sound(database->get());
  if (!whole) return tl::unexpected(whole.error());
  std::unique_ptr<Store> store(new Store(database->release(), nullptr));
  if (!*whole) store->meet("some of its pages");
  if (*whole && !lacking.empty()) store->meet("the store, which " + lacking);
  for (const Verified& table : kVerified) {
    const auto rows = damaged_rows(store->database_, table);
    if (!rows) store->meet(std::string("the table ") + table.table);  // a page of it
    for (const std::string& what : rows.value_or(std::vector<std::string>())) store->meet(what);
  }
  return store;
}

Store::Store(sqlite3* database, std::unique_ptr<StoreMark> mark)
    : database_(database), mark_(std::move(mark)) {}

Result<void> Store::commit(sqlite::Transaction& change) {
  const auto number = sqlite::integer(
      database_, "UPDATE change SET number = number + 1, checksum = " SELFCAL_CHANGE_CHECKSUM_AS(
                     "change.number + 1") " RETURNING number");
  if (!number) return tl::unexpected(number.error());
  if (auto done = change.commit(); !done) return done;
  if (mark_ != nullptr) mark_->put(*number);
  return {};
}

Store::~Store() { sqlite3_close_v2(database_); }

}  // namespace selfcal
