// A disk that forgets: loaded before a process (LD_PRELOAD), it makes SIGKILL a power cut for every
// SQLite database of that process.
//
// Writes and truncations of databases, logs and journals stay in memory until SQLite syncs the
// file; only then do they reach the real file, which is synced in turn. Reads, sizes and other
// connections of the process see them at once, closing a file forgets nothing, and a killed process
// leaves the real files with what was synced. The locks and the shared memory of a log are the
// real ones.
//
// FORGETFUL_KEEP=SEED makes it harsher: each write reaches the real file at once with probability
// 1/2, without order, as from a disk's cache; FORGETFUL_KEEP=all: every one does.
// FORGETFUL_CUT=N cuts the power by itself before the N-th write, truncation, sync or deletion.
//
// Creations and deletions take effect at once, as SQLite assumes of a name once its folder is
// synced: it syncs the folder after it creates a log or a journal and deletes only what it needs no
// more. A name that outlives its deletion is not imitated.
//
// Other processes may read while this one writes, for what they are shown was synced (with
// synchronous=FULL); they may not write: this process would not see it.
#include <fcntl.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

struct Change {
  sqlite3_int64 at = 0;  ///< of the bytes, or the new size
  std::string bytes;
  bool truncates = false;
};

/// One file as the process sees it: the content, and the changes that the real one lacks.
struct Content {
  std::string bytes;
  std::vector<Change> pending;
  int users = 0;
};

using Key = std::pair<dev_t, ino_t>;  // a renamed file is still the same

std::mutex mutex;  // over everything below
std::map<Key, Content>& contents() {
  static auto* const all = new std::map<Key, Content>;  // outlives every connection
  return *all;
}

sqlite3_vfs* real = nullptr;

/// Whether this write reaches the real file at once.
bool passes_at_once() {
  static const char* const kept = std::getenv("FORGETFUL_KEEP");
  if (kept != nullptr && std::string_view(kept) == "all") return true;
  static std::optional<std::mt19937_64> generator = []() -> std::optional<std::mt19937_64> {
    const char* seed = std::getenv("FORGETFUL_KEEP");
    if (seed == nullptr) return std::nullopt;
    return std::mt19937_64(std::strtoull(seed, nullptr, 10));
  }();
  return generator && ((*generator)() & 1) != 0;
}

/// Something is about to be done to the disk.
void count_down() {
  static long left = [] {
    const char* cut = std::getenv("FORGETFUL_CUT");
    return cut != nullptr ? std::atol(cut) : 0;
  }();
  if (left > 0 && --left == 0) kill(getpid(), SIGKILL);
}

std::optional<Key> key_of(const char* path) {
  struct stat status {};
  if (path == nullptr || stat(path, &status) != 0) return std::nullopt;
  return Key{status.st_dev, status.st_ino};
}

struct File {
  sqlite3_file base;       // first: SQLite's view of this object
  std::optional<Key> key;  // none: a temporary file, passed through
  sqlite3_file* inner;     // the real one, in the memory behind this object

  Content& content() const { return contents().at(*key); }
};

File& file_of(sqlite3_file* file) { return *reinterpret_cast<File*>(file); }
sqlite3_file* inner_of(sqlite3_file* file) { return file_of(file).inner; }

/// Puts one change into the real file; SQLite's code.
int put(sqlite3_file* inner, const Change& change) {
  if (change.truncates) return inner->pMethods->xTruncate(inner, change.at);
  return inner->pMethods->xWrite(inner, change.bytes.data(), static_cast<int>(change.bytes.size()),
                                 change.at);
}

int keep(File& file, Change change) {
  count_down();
  if (passes_at_once()) {
    if (const int code = put(file.inner, change); code != SQLITE_OK) return code;
  }
  file.content().pending.push_back(std::move(change));
  return SQLITE_OK;
}

int close_file(sqlite3_file* handle) {
  const std::scoped_lock lock(mutex);
  File& file = file_of(handle);
  const int code = file.inner->pMethods->xClose(file.inner);
  if (file.key) {
    // What nobody uses and the real file has is read again when it is needed.
    const auto found = contents().find(*file.key);
    if (found != contents().end() && --found->second.users == 0 && found->second.pending.empty()) {
      contents().erase(found);
    }
  }
  file.~File();
  return code;
}

int read_file(sqlite3_file* handle, void* out, int amount, sqlite3_int64 at) {
  const std::scoped_lock lock(mutex);
  const File& file = file_of(handle);
  if (!file.key) return file.inner->pMethods->xRead(file.inner, out, amount, at);
  const std::string& bytes = file.content().bytes;
  const auto wanted = static_cast<std::size_t>(amount);
  const auto from = std::min(static_cast<std::size_t>(at), bytes.size());
  const auto there = std::min(wanted, bytes.size() - from);
  std::memcpy(out, bytes.data() + from, there);
  if (there == wanted) return SQLITE_OK;
  std::memset(static_cast<char*>(out) + there, 0, wanted - there);
  return SQLITE_IOERR_SHORT_READ;
}

int write_file(sqlite3_file* handle, const void* in, int amount, sqlite3_int64 at) {
  const std::scoped_lock lock(mutex);
  File& file = file_of(handle);
  if (!file.key) return file.inner->pMethods->xWrite(file.inner, in, amount, at);
  const std::string_view fresh(static_cast<const char*>(in), static_cast<std::size_t>(amount));
  const auto from = static_cast<std::size_t>(at);
  std::string& bytes = file.content().bytes;
  bytes.resize(std::max(bytes.size(), from + fresh.size()));
  std::copy(fresh.begin(), fresh.end(), bytes.begin() + at);
  return keep(file, {at, std::string(fresh), false});
}

int truncate_file(sqlite3_file* handle, sqlite3_int64 size) {
  const std::scoped_lock lock(mutex);
  File& file = file_of(handle);
  if (!file.key) return file.inner->pMethods->xTruncate(file.inner, size);
  file.content().bytes.resize(static_cast<std::size_t>(size));
  return keep(file, {size, {}, true});
}

int sync_file(sqlite3_file* handle, int flags) {
  const std::scoped_lock lock(mutex);
  File& file = file_of(handle);
  if (file.key) {
    count_down();
    for (const Change& change : file.content().pending) {
      if (const int code = put(file.inner, change); code != SQLITE_OK) return code;
    }
    file.content().pending.clear();
  }
  return file.inner->pMethods->xSync(file.inner, flags);
}

int size_of_file(sqlite3_file* handle, sqlite3_int64* size) {
  const std::scoped_lock lock(mutex);
  const File& file = file_of(handle);
  if (!file.key) return file.inner->pMethods->xFileSize(file.inner, size);
  *size = static_cast<sqlite3_int64>(file.content().bytes.size());
  return SQLITE_OK;
}

int control_file(sqlite3_file* handle, int operation, void* argument) {
  // These let the real file grow ahead of its content.
  if (operation == SQLITE_FCNTL_SIZE_HINT || operation == SQLITE_FCNTL_CHUNK_SIZE) {
    return SQLITE_OK;
  }
  sqlite3_file* inner = inner_of(handle);
  return inner->pMethods->xFileControl(inner, operation, argument);
}

int lock_file(sqlite3_file* f, int level) {
  return inner_of(f)->pMethods->xLock(inner_of(f), level);
}
int unlock_file(sqlite3_file* f, int level) {
  return inner_of(f)->pMethods->xUnlock(inner_of(f), level);
}
int check_lock(sqlite3_file* f, int* out) {
  return inner_of(f)->pMethods->xCheckReservedLock(inner_of(f), out);
}
int sector_size(sqlite3_file* f) { return inner_of(f)->pMethods->xSectorSize(inner_of(f)); }
int traits(sqlite3_file* f) { return inner_of(f)->pMethods->xDeviceCharacteristics(inner_of(f)); }
int map_shared(sqlite3_file* f, int region, int size, int extend, void volatile** out) {
  return inner_of(f)->pMethods->xShmMap(inner_of(f), region, size, extend, out);
}
int lock_shared(sqlite3_file* f, int offset, int n, int flags) {
  return inner_of(f)->pMethods->xShmLock(inner_of(f), offset, n, flags);
}
void barrier(sqlite3_file* f) { inner_of(f)->pMethods->xShmBarrier(inner_of(f)); }
int unmap_shared(sqlite3_file* f, int remove) {
  return inner_of(f)->pMethods->xShmUnmap(inner_of(f), remove);
}

/// Version 2: shared memory, but no memory-mapped reads, which would pass the pending writes by.
constexpr sqlite3_io_methods kMethods = {
    2,           close_file,  read_file,    write_file,   truncate_file, sync_file, size_of_file,
    lock_file,   unlock_file, check_lock,   control_file, sector_size,   traits,    map_shared,
    lock_shared, barrier,     unmap_shared, nullptr,      nullptr};

/// Begins or joins the content of an open file; SQLite's code.
int join_content(const Key& key, sqlite3_file* inner) {
  const auto [found, fresh] = contents().try_emplace(key);
  Content& content = found->second;
  ++content.users;
  if (!fresh) return SQLITE_OK;
  sqlite3_int64 size = 0;
  if (const int code = inner->pMethods->xFileSize(inner, &size); code != SQLITE_OK) return code;
  content.bytes.resize(static_cast<std::size_t>(size));
  if (size == 0) return SQLITE_OK;
  return inner->pMethods->xRead(inner, content.bytes.data(), static_cast<int>(size), 0);
}

int open_file(sqlite3_vfs*, const char* name, sqlite3_file* handle, int flags, int* out_flags) {
  constexpr int kKept = SQLITE_OPEN_MAIN_DB | SQLITE_OPEN_WAL | SQLITE_OPEN_MAIN_JOURNAL;
  handle->pMethods = nullptr;
  auto* memory = reinterpret_cast<char*>(handle) + sizeof(File);
  auto* inner = reinterpret_cast<sqlite3_file*>(memory);
  const int code = real->xOpen(real, name, inner, flags, out_flags);
  if (code != SQLITE_OK) return code;
  const std::scoped_lock lock(mutex);
  File* file = new (handle) File{{&kMethods}, std::nullopt, inner};
  if ((flags & kKept) == 0 || name == nullptr) return SQLITE_OK;
  file->key = key_of(name);
  if (!file->key) return SQLITE_IOERR;
  return join_content(*file->key, inner);
}

int delete_file(sqlite3_vfs*, const char* name, int sync_folder) {
  const std::scoped_lock lock(mutex);
  const std::optional<Key> key = key_of(name);
  if (key) count_down();
  const int code = real->xDelete(real, name, sync_folder);
  if (code != SQLITE_OK || !key) return code;
  const auto found = contents().find(*key);
  if (found == contents().end()) return code;
  // Nothing of it is left to sync; one that is still open goes when it is closed.
  found->second.pending.clear();
  if (found->second.users == 0) contents().erase(found);
  return code;
}

/// A file that has content only in memory exists, too: SQLite takes an empty one for none.
int access_file(sqlite3_vfs*, const char* name, int flags, int* out) {
  const int code = real->xAccess(real, name, flags, out);
  if (code != SQLITE_OK || flags != SQLITE_ACCESS_EXISTS) return code;
  const std::scoped_lock lock(mutex);
  const std::optional<Key> key = key_of(name);
  const auto found = key ? contents().find(*key) : contents().end();
  if (found != contents().end()) *out = found->second.bytes.empty() ? 0 : 1;
  return code;
}

__attribute__((constructor)) void become_default() {
  real = sqlite3_vfs_find(nullptr);
  if (real == nullptr) std::abort();
  static sqlite3_vfs forgetful = *real;
  forgetful.zName = "forgetful";
  forgetful.szOsFile = static_cast<int>(sizeof(File)) + real->szOsFile;
  forgetful.xOpen = open_file;
  forgetful.xDelete = delete_file;
  forgetful.xAccess = access_file;
  if (sqlite3_vfs_register(&forgetful, 1) != SQLITE_OK) std::abort();
}

}  // namespace
