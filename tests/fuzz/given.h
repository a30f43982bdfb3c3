// What a fuzzer gives to code that reads files, and how it says that a promise is broken.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace selfcal {

/// Ends the process, which libFuzzer tells as a crash of this input.
inline void promise(bool holds, const std::string& what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: a promise is broken: %s\n", what.c_str());
  std::abort();
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// `count` parts of an input, which lines of five equals signs part; the last ones may be empty.
inline std::vector<std::string_view> parts_of(std::string_view input, std::size_t count) {
  static constexpr std::string_view kBetween = "\n=====\n";
  std::vector<std::string_view> parts;
  while (parts.size() + 1 < count) {
    const std::size_t end = input.find(kBetween);
    parts.push_back(input.substr(0, end));
    input =
        end == std::string_view::npos ? std::string_view() : input.substr(end + kBetween.size());
  }
  parts.push_back(input);
  return parts;
}

/// A folder of the process's own under $TMPDIR, which tests/fuzz/run puts into memory.
class GivenFolder {
 public:
  GivenFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("selfcal.fuzz." + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  GivenFolder(const GivenFolder&) = delete;
  GivenFolder& operator=(const GivenFolder&) = delete;
  ~GivenFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  const std::filesystem::path& path() const { return path_; }

  /// Writes a file and returns its path.
  std::filesystem::path write(const std::string& name, std::string_view text) const {
    std::filesystem::path path = path_ / name;
    std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
    return path;
  }

 private:
  std::filesystem::path path_;
};

/// The one of this process.
inline const GivenFolder& given_folder() {
  static const GivenFolder folder;
  return folder;
}

}  // namespace selfcal
