// Whole files, in and out, and the fingerprint of a text.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "io/result.h"

namespace selfcal {

/// A file open for reading in pieces; closed at the end of its life.
class InputFile {
 public:
  /// Fails on a missing or unreadable file, a folder, a device and a named pipe, but for the ends
  /// that the program was given (/dev/stdin, /dev/fd/N).
  static Result<InputFile> open(const std::filesystem::path& path);

  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&&) = delete;
  ~InputFile();

  /// Fills `buffer` as far as the file goes; 0 at its end.
  Result<std::size_t> read(std::span<char> buffer);

 private:
  InputFile(std::filesystem::path path, int descriptor);

  std::filesystem::path path_;
  int descriptor_;
};

/// The content of a file of at most `limit` bytes; a longer one is a failure.
Result<std::string> read_file(const std::filesystem::path& path, std::size_t limit);

/// Puts `text` at `path` so that a reader, or a power cut, meets the old content or the new and
/// never a part: a new file in the same folder is synced, takes the name, and the folder is synced.
/// After a failure nothing is left behind and the old content stands.
Result<void> write_file_atomically(const std::filesystem::path& path, std::string_view text);

/// Keeps what was made, renamed or removed in the folder (empty: the current one) over a power cut.
Result<void> sync_folder(const std::filesystem::path& folder);

/// Makes the folder, and those that it is to lie in, where they are not there yet.
Result<void> make_folder(const std::filesystem::path& folder);

/// SHA-256 of `text` in 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view text);

}  // namespace selfcal
