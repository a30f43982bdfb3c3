#include "io/store/folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <system_error>

#include "io/files/file.h"

namespace selfcal {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMadeMark = "selfcal.made";
constexpr const char* kLog = "selfcal.db-wal";
constexpr const char* kOwner = "robot.id";
constexpr std::size_t kLongestOwner = 4096;  // bytes
/// The service writes it next to its store; stores of before had no mark.
constexpr const char* kExport = "active.robot.yaml";

/// 0 where there is none.
std::uintmax_t size_of(const fs::path& path) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  return error ? 0 : size;
}

const std::string kMade =
    "A store was made here: where selfcal.db is not beside this file, it was lost.\n";

/// Always of one length, so that it takes the place of the one before; with the beginning of its
/// own hash, as half of it may be written.
std::string line_of(std::int64_t changes) {
  char number[32];
  std::snprintf(number, sizeof number, "%020lld", static_cast<long long>(changes));
  return std::string(number) + " changes " + sha256_hex(number).substr(0, 8) + "\n";
}

fs::path with(const fs::path& path, const char* end) { return path.string() + end; }

}  // namespace

fs::path store_in(const fs::path& folder) { return folder / "selfcal.db"; }
fs::path unnamed_store_in(const fs::path& folder) { return folder / "selfcal.db.new"; }

bool has_store(const fs::path& folder) {
  constexpr std::uintmax_t kSmallestPage = 512;  // bytes
  return size_of(store_in(folder)) >= kSmallestPage;
}

bool had_store(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / kMadeMark, error);
}

std::string lost_store(const fs::path& folder) {
  std::error_code error;
  if (has_store(folder)) return {};
  if (fs::exists(store_in(folder), error)) {
    return "was emptied (" + std::to_string(size_of(store_in(folder))) + " bytes)";
  }
  if (had_store(folder)) return "is gone, though there was one (selfcal.made)";
  if (size_of(folder / kLog) > 0) return "is gone, though its log is there";
  if (fs::exists(folder / kExport, error)) {
    return std::string("is gone, though there was one (") + kExport + ")";
  }
  return {};
}

Result<std::string> set_store_aside(const fs::path& folder) {
  const fs::path path = store_in(folder);
  std::error_code error;
  fs::path aside;
  int number = 0;
  do {
    aside = path.string() + ".damaged-" + std::to_string(++number);
  } while (fs::exists(aside, error) || fs::exists(with(aside, "-wal"), error));
  bool something = false;
  // The store before its log: a power cut between the two must not leave it to be opened without.
  for (const char* end : {"", "-wal"}) {
    if (!fs::exists(with(path, end), error)) continue;
    fs::rename(with(path, end), with(aside, end), error);
    if (error) {
      return device_failed(path.string() +
                           ": is damaged and cannot be set aside: " + error.message());
    }
    something = true;
  }
  fs::remove(with(path, "-shm"), error);
  if (auto synced = sync_folder(folder); !synced) return tl::unexpected(synced.error());
  return something ? aside.filename().string() : std::string();
}

Result<void> name_store(const fs::path& folder) {
  std::error_code error;
  fs::rename(unnamed_store_in(folder), store_in(folder), error);
  if (error) {
    return device_failed(store_in(folder).string() + ": cannot be made: " + error.message());
  }
  return sync_folder(folder);
}

void remove_unnamed_store(const fs::path& folder) {
  std::error_code ignored;
  for (const char* end : {"", "-journal", "-wal", "-shm"}) {
    fs::remove(with(unnamed_store_in(folder), end), ignored);
  }
}

Result<void> may_own_folder(const fs::path& folder, const std::string& robot) {
  std::error_code error;
  if (!fs::exists(folder / kOwner, error)) return {};
  const auto owner = read_file(folder / kOwner, kLongestOwner);
  if (!owner) return tl::unexpected(owner.error());
  const std::string name = owner->substr(0, owner->find('\n'));
  if (name == robot) return {};
  return bad_input(folder.string() + ": is the state of robot '" + name + "', not of '" + robot +
                   "': give each robot a `state` of its own; if this one has a new name, remove " +
                   (folder / kOwner).string());
}

Result<bool> own_folder(const fs::path& folder, const std::string& robot) {
  if (auto may = may_own_folder(folder, robot); !may) return tl::unexpected(may.error());
  std::error_code error;
  if (fs::exists(folder / kOwner, error)) return false;
  if (auto written = write_file_atomically(folder / kOwner, robot + "\n"); !written)
    return tl::unexpected(written.error());
  return has_store(folder);
}

Result<std::unique_ptr<StoreMark>> StoreMark::open(const fs::path& folder) {
  const fs::path path = folder / kMadeMark;
  if (!had_store(folder)) {
    if (auto made = write_file_atomically(path, kMade + line_of(0)); !made) {
      return tl::unexpected(made.error());
    }
  }
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) return device_failed(path.string() + ": cannot be written");
  return std::unique_ptr<StoreMark>(new StoreMark(file));
}

StoreMark::~StoreMark() { ::close(file_); }

void StoreMark::put(std::int64_t changes) const {
  const std::string line = line_of(changes);
  // One that is not written is behind, which a mark may be.
  (void)!::pwrite(file_, line.data(), line.size(), static_cast<off_t>(kMade.size()));
}

std::int64_t marked_changes(const fs::path& folder) {
  const auto text = read_file(folder / kMadeMark, 4096);
  if (!text || text->size() < kMade.size()) return 0;
  const std::string line = text->substr(kMade.size());
  const std::int64_t changes = std::atoll(line.c_str());
  return line == line_of(changes) ? changes : 0;
}

}  // namespace selfcal
