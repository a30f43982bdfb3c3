// A disk that forgets plain files: loaded before a process (LD_PRELOAD), it cuts the power before
// the FORGETFUL_CUT-th thing that is done to a file under the folder FORGETFUL_FOLDER (made,
// written, synced, renamed). FORGETFUL_LOSES says what is lost then, as far as it was not synced:
// "data" (half of a file's bytes), "names" (renames are undone, the old content is back), or
// "both".
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

namespace {

template <class Call>
Call libc(const char* name) {
  return reinterpret_cast<Call>(dlsym(RTLD_NEXT, name));
}

using Open = int (*)(const char*, int, ...);
using Write = ssize_t (*)(int, const void*, size_t);
using Rename = int (*)(const char*, const char*);
using Sync = int (*)(int);

struct Renamed {
  std::string from, to;
  std::optional<std::string> before;  ///< content of `to`
};

std::vector<std::string>& unsynced_files() {
  static auto* const all = new std::vector<std::string>;
  return *all;
}
std::vector<Renamed>& unsynced_names() {
  static auto* const all = new std::vector<Renamed>;
  return *all;
}

std::string path_of(int file) {
  char link[64], path[4096];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, sizeof path);
  return length > 0 ? std::string(path, static_cast<size_t>(length)) : std::string();
}

bool is_watched(const std::string& path) {
  const char* folder = std::getenv("FORGETFUL_FOLDER");
  return folder != nullptr && path.starts_with(folder);
}

bool loses(const char* what) {
  const char* said = std::getenv("FORGETFUL_LOSES");
  return said != nullptr && (std::strcmp(said, what) == 0 || std::strcmp(said, "both") == 0);
}

std::optional<std::string> content(const std::string& path) {
  const int file = libc<Open>("open")(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  std::string all;
  char some[4096];
  for (ssize_t got = 0; (got = read(file, some, sizeof some)) > 0;)
    all.append(some, static_cast<size_t>(got));
  close(file);
  return all;
}

void put_back(const Renamed& name) {
  libc<Rename>("rename")(name.to.c_str(), name.from.c_str());
  if (!name.before) return;
  const int file = libc<Open>("open")(name.to.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (libc<Write>("write")(file, name.before->data(), name.before->size()) < 0) std::abort();
  close(file);
}

void cut_power() {
  if (loses("data"))
    for (const std::string& path : unsynced_files())
      if (const auto bytes = content(path))
        if (truncate(path.c_str(), static_cast<off_t>(bytes->size() / 2)) != 0) std::abort();
  if (loses("names"))
    for (auto name = unsynced_names().rbegin(); name != unsynced_names().rend(); ++name)
      put_back(*name);
  kill(getpid(), SIGKILL);
}

/// Something is about to be done.
void count() {
  static long left = [] {
    const char* cut = std::getenv("FORGETFUL_CUT");
    return cut != nullptr ? std::atol(cut) : 0;
  }();
  if (left > 0 && --left == 0) cut_power();
}

int opened(const char* call, const char* path, int flags, mode_t mode) {
  const bool made = (flags & O_CREAT) != 0 && is_watched(path);
  if (made) count();
  const int file = libc<Open>(call)(path, flags, mode);
  if (made && file >= 0) unsynced_files().emplace_back(path);
  return file;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  return opened("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  return opened("open64", path, flags, mode);
}

ssize_t write(int file, const void* bytes, size_t size) {
  if (is_watched(path_of(file))) count();
  return libc<Write>("write")(file, bytes, size);
}

int fsync(int file) {
  const std::string path = path_of(file);
  if (is_watched(path)) {
    count();
    std::erase(unsynced_files(), path);
    std::erase_if(unsynced_names(), [&](const Renamed& name) {
      return name.to.substr(0, name.to.rfind('/')) == path;
    });
  }
  return libc<Sync>("fsync")(file);
}

int rename(const char* from, const char* to) {
  if (!is_watched(to)) return libc<Rename>("rename")(from, to);
  count();
  unsynced_names().push_back({from, to, content(to)});
  for (std::string& path : unsynced_files())
    if (path == from) path = to;
  return libc<Rename>("rename")(from, to);
}

}  // extern "C"
