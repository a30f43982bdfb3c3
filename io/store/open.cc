// Opening: the version first (a newer store is not touched), then quick_check, then the settings.
//
// Until all of it went well the connection leaves the write-ahead log alone when it closes, so
// that a damaged or newer store keeps what it has. WAL with synchronous=FULL syncs the log in
// every commit; see sqlite.org/wal.html and sqlite.org/pragma.html.
#include <sqlite3.h>

#include <system_error>
#include <utility>

#include "io/file.h"
#include "io/store/schema.h"
#include "io/store/sqlite.h"
#include "io/store/store.h"

namespace selfcal {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = "selfcal.db";
constexpr int kBusy_ms = 5000;

struct Close {
  void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};
using Connection = std::unique_ptr<sqlite3, Close>;

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
  return database;
}

/// Whether the file is whole: its version can be read and quick_check finds nothing.
Result<bool> is_sound(sqlite3* database) {
  const auto found = version(database).and_then(
      [&](int) { return sqlite::text(database, "PRAGMA quick_check(1)"); });
  if (found) return *found == "ok";
  const int code = sqlite3_errcode(database) & 0xff;  // without the extension
  if (code == SQLITE_CORRUPT || code == SQLITE_NOTADB) return false;
  return tl::unexpected(found.error());
}

Result<void> refuse_newer(sqlite3* database) {
  const Result<int> found = version(database);
  // One that cannot be read is for is_sound to judge.
  if (!found || *found <= static_cast<int>(migrations().size())) return {};
  return sqlite::failure(database, "was written by a newer program (version " +
                                       std::to_string(*found) + " of the store)");
}

Result<void> configure(sqlite3* database) {
  // auto_vacuum first: it holds only for a file that has nothing in it.
  for (const char* setting :
       {"PRAGMA auto_vacuum = INCREMENTAL", "PRAGMA synchronous = FULL", "PRAGMA foreign_keys = ON",
        "PRAGMA trusted_schema = OFF", "PRAGMA cell_size_check = ON",
        "PRAGMA journal_size_limit = 8388608"}) {
    if (auto set = sqlite::run(database, setting); !set) return tl::unexpected(set.error());
  }
  const Result<std::string> mode = sqlite::text(database, "PRAGMA journal_mode = WAL");
  if (!mode) return tl::unexpected(mode.error());
  if (*mode != "wal") return sqlite::failure(database, "cannot keep a write-ahead log here");
  // The log stays when the service ends, so that a reader who may not write here can open it.
  int stay = 1;
  sqlite3_file_control(database, "main", SQLITE_FCNTL_PERSIST_WAL, &stay);
  return migrate(database, migrations());
}

/// Renames the store and its log to the first free damaged-N; what is said of it.
Result<std::string> put_aside(const fs::path& path) {
  std::error_code error;
  fs::path aside;
  int number = 0;
  do {
    aside = path.string() + ".damaged-" + std::to_string(++number);
  } while (fs::exists(aside, error));
  // The store before its log: a power cut between the two must not leave it to be opened without.
  fs::rename(path, aside, error);
  if (error) {
    return device_failed(path.string() +
                         ": is damaged and cannot be set aside: " + error.message());
  }
  fs::rename(path.string() + "-wal", aside.string() + "-wal", error);
  fs::remove(path.string() + "-wal", error);
  fs::remove(path.string() + "-shm", error);
  if (auto synced = sync_folder(path.parent_path()); !synced) return tl::unexpected(synced.error());
  return path.string() + ": was damaged and is now " + aside.filename().string() +
         "; a new store was begun";
}

constexpr int kToWrite = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;

/// A connection to a sound store of no newer version; what was damaged goes aside.
Result<Connection> connect_to_sound(const fs::path& path, std::string& set_aside) {
  Result<Connection> database = connect(path, kToWrite);
  if (!database) return database;
  if (auto known = refuse_newer(database->get()); !known) return tl::unexpected(known.error());
  const Result<bool> sound = is_sound(database->get());
  if (!sound) return tl::unexpected(sound.error());
  if (*sound) return database;
  database->reset();
  Result<std::string> said = put_aside(path);
  if (!said) return tl::unexpected(said.error());
  set_aside = *std::move(said);
  return connect(path, kToWrite);
}

}  // namespace

Result<Store::Opened> Store::open(const fs::path& folder) {
  std::error_code ignored;  // what keeps the folder away keeps the file away, and SQLite says so
  fs::create_directory(folder, ignored);
  Opened opened;
  Result<Connection> database = connect_to_sound(folder / kFile, opened.set_aside);
  if (!database) return tl::unexpected(database.error());
  if (auto ready = configure(database->get()); !ready) return tl::unexpected(ready.error());
  sqlite3_db_config(database->get(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 0, nullptr);
  opened.store.reset(new Store(database->release()));
  return opened;
}

Result<std::unique_ptr<Store>> Store::open_to_read(const fs::path& folder) {
  const fs::path path = folder / kFile;
  Result<Connection> database = connect(path, SQLITE_OPEN_READONLY);
  if (!database) return tl::unexpected(database.error());
  if (auto known = refuse_newer(database->get()); !known) return tl::unexpected(known.error());
  const Result<int> found = version(database->get());
  if (!found) return tl::unexpected(found.error());
  if (*found < static_cast<int>(migrations().size())) {
    return sqlite::failure(database->get(),
                           "is of an older version; the service brings it up to date");
  }
  return std::unique_ptr<Store>(new Store(database->release()));
}

Store::~Store() { sqlite3_close_v2(database_); }

}  // namespace selfcal
