// Whole files over POSIX calls: fsync and rename are what makes a write atomic (POSIX.1-2017,
// rename(): "a directory entry named new shall remain visible throughout"). SHA-256 by OpenSSL.
#include "io/files/file.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <system_error>
#include <utility>

namespace selfcal {
namespace {

std::string why(int error) { return std::generic_category().message(error); }

tl::unexpected<Failure> unwritable(const std::filesystem::path& path, int error) {
  return device_failed(path.string() + ": cannot be written: " + why(error));
}

/// An end that whoever started the program has opened for it: `< FILE`, `<(COMMAND)`.
bool is_own_end(const std::filesystem::path& path) {
  const std::string name = path.string();
  return name == "/dev/stdin" || name.starts_with("/dev/fd/") || name == "/dev/null";
}

std::string kind_of(mode_t mode) {
  return S_ISDIR(mode) ? "a folder" : S_ISFIFO(mode) ? "a named pipe" : "a device";
}

/// A name beside `path` that no other writer uses: process and count make it so.
std::filesystem::path beside(const std::filesystem::path& path) {
  static std::atomic<unsigned> count = 0;
  return path.parent_path() / ("." + path.filename().string() + "." + std::to_string(getpid()) +
                               "." + std::to_string(count++) + ".new");
}

/// 0, or the error that stopped the writing.
int write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

/// Writes and syncs a new file; 0, or the error, after which the file is gone, unless it was there
/// before (EEXIST).
int write_new(const std::filesystem::path& path, std::string_view text) {
  constexpr mode_t kReadableByAll = 0666;  // as far as the umask allows
  const int descriptor =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kReadableByAll);
  if (descriptor < 0) return errno;
  int error = write_all(descriptor, text);
  if (error == 0 && ::fsync(descriptor) != 0) error = errno;
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error != 0) ::unlink(path.c_str());
  return error;
}

}  // namespace

InputFile::InputFile(std::filesystem::path path, int descriptor)
    : path_(std::move(path)), descriptor_(descriptor) {}

InputFile::InputFile(InputFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<InputFile> InputFile::open(const std::filesystem::path& path) {
  // A named pipe that nobody writes to must not hold the program: it is opened without waiting.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return bad_input(path.string() + ": cannot be read: " + why(errno));
  InputFile file(path, descriptor);
  struct stat status {};
  if (::fstat(descriptor, &status) != 0)
    return bad_input(path.string() + ": cannot be read: " + why(errno));
  if (!S_ISREG(status.st_mode) && !is_own_end(path))
    return bad_input(path.string() + ": expected a file, got " + kind_of(status.st_mode));
  ::fcntl(descriptor, F_SETFL, 0);
  return file;
}

Result<std::size_t> InputFile::read(std::span<char> buffer) {
  std::size_t filled = 0;
  while (filled < buffer.size()) {
    const ssize_t got = ::read(descriptor_, buffer.data() + filled, buffer.size() - filled);
    if (got == 0) break;
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return bad_input(path_.string() + ": cannot be read: " + why(errno));
    filled += static_cast<std::size_t>(got);
  }
  return filled;
}

Result<std::string> read_file(const std::filesystem::path& path, std::size_t limit) {
  constexpr std::size_t kPiece = 65536;
  Result<InputFile> file = InputFile::open(path);
  if (!file) return tl::unexpected(file.error());
  std::string text;
  while (text.size() <= limit) {
    const std::size_t before = text.size();
    text.resize(before + kPiece);
    const Result<std::size_t> got = file->read(std::span(text).subspan(before));
    if (!got) return tl::unexpected(got.error());
    text.resize(before + *got);
    if (*got < kPiece) break;
  }
  if (text.size() <= limit) return text;
  return bad_input(path.string() + ": longer than " + std::to_string(limit) + " bytes");
}

Result<void> write_file_atomically(const std::filesystem::path& path, std::string_view text) {
  if (!path.has_filename()) return device_failed("'" + path.string() + "': is not a file's name");
  // One that a process of this number left when it was killed stays where it is.
  constexpr int kTries = 100;
  std::filesystem::path fresh;
  int error = EEXIST;
  for (int i = 0; i < kTries && error == EEXIST; ++i) error = write_new(fresh = beside(path), text);
  if (error != 0) return unwritable(path, error);
  if (::rename(fresh.c_str(), path.c_str()) != 0) {
    error = errno;
    ::unlink(fresh.c_str());
    return unwritable(path, error);
  }
  return sync_folder(path.parent_path());
}

Result<void> sync_folder(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder.empty() ? "." : folder;
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return unwritable(path, errno);
  const int error = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  // A file system that cannot sync folders (some network ones) says EINVAL: nothing more to do.
  if (error != 0 && error != EINVAL) return unwritable(path, error);
  return {};
}

Result<void> make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    return device_failed(folder.string() + ": cannot create the folder: " + error.message());
  return {};
}

std::string sha256_hex(std::string_view text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(text.data(), text.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    std::abort();  // OpenSSL without SHA-256, or no memory for its context
  }
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    hex += kDigits[digest[i] >> 4];
    hex += kDigits[digest[i] & 15];
  }
  return hex;
}

}  // namespace selfcal
