// A disk that fails: loaded before a process (LD_PRELOAD), it makes what is written under the
// folder BAD_DISK_FOLDER fail for as long as the file BAD_DISK says how: "full" (ENOSPC),
// "read-only" (EROFS), or "slow", where each synchronisation takes a quarter of a second longer.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

template <class Call>
Call next(const char* name) {
  return reinterpret_cast<Call>(dlsym(RTLD_NEXT, name));
}

using Open = int (*)(const char*, int, ...);
using Close = int (*)(int);
using Read = ssize_t (*)(int, void*, size_t);

/// What the file says; empty when it is not there.
std::string how() {
  static const auto real_open = next<Open>("open");
  static const auto real_read = next<Read>("read");
  const char* file = std::getenv("BAD_DISK");
  if (file == nullptr) return {};
  const int descriptor = real_open(file, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return {};
  char words[16];
  const ssize_t got = real_read(descriptor, words, sizeof words);
  close(descriptor);
  return got > 0 ? std::string(words, static_cast<size_t>(got)) : std::string();
}

bool is_of_the_disk(const char* path) {
  const char* folder = std::getenv("BAD_DISK_FOLDER");
  return folder != nullptr && std::strncmp(path, folder, std::strlen(folder)) == 0;
}

bool is_of_the_disk(int descriptor) {
  char link[64], path[4096];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length <= 0) return false;
  path[length] = '\0';
  return is_of_the_disk(path);
}

/// The error of a write to the file; 0 when it goes well.
template <class File>
int trouble(File file) {
  const std::string words = how();
  if (words.empty() || !is_of_the_disk(file)) return 0;
  return words == "full" ? ENOSPC : words == "read-only" ? EROFS : 0;
}

template <class File>
bool fails(File file) {
  const int error = trouble(file);
  if (error != 0) errno = error;
  return error != 0;
}

int synchronised(const char* name, int file) {
  if (fails(file)) return -1;
  if (how() == "slow" && is_of_the_disk(file)) usleep(250'000);
  return next<Close>(name)(file);
}

/// A new file, or one to write to.
template <class File>
int opened(const char* name, File path, int flags, mode_t mode) {
  if ((flags & (O_WRONLY | O_RDWR | O_CREAT)) != 0) {
    const int error = trouble(path);
    // What is there may still be opened on a full disk.
    if (error == EROFS || (error == ENOSPC && access(path, F_OK) != 0)) {
      errno = error;
      return -1;
    }
  }
  return next<Open>(name)(path, flags, mode);
}

mode_t mode_of(int flags, va_list more) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return opened("open", path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return opened("open64", path, flags, mode);
}
ssize_t write(int file, const void* bytes, size_t count) {
  if (fails(file)) return -1;
  return next<ssize_t (*)(int, const void*, size_t)>("write")(file, bytes, count);
}
ssize_t pwrite(int file, const void* bytes, size_t count, off_t at) {
  if (fails(file)) return -1;
  return next<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite")(file, bytes, count, at);
}
ssize_t pwrite64(int file, const void* bytes, size_t count, off64_t at) {
  if (fails(file)) return -1;
  return next<ssize_t (*)(int, const void*, size_t, off64_t)>("pwrite64")(file, bytes, count, at);
}
int ftruncate(int file, off_t size) {
  if (fails(file)) return -1;
  return next<int (*)(int, off_t)>("ftruncate")(file, size);
}
int ftruncate64(int file, off64_t size) {
  if (fails(file)) return -1;
  return next<int (*)(int, off64_t)>("ftruncate64")(file, size);
}
int rename(const char* from, const char* to) {
  if (trouble(to) == EROFS) {
    errno = EROFS;
    return -1;
  }
  return next<int (*)(const char*, const char*)>("rename")(from, to);
}
int unlink(const char* path) {
  if (trouble(path) == EROFS) {
    errno = EROFS;
    return -1;
  }
  return next<int (*)(const char*)>("unlink")(path);
}
int fsync(int file) { return synchronised("fsync", file); }
int fdatasync(int file) { return synchronised("fdatasync", file); }

}  // extern "C"
