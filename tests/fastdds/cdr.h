// Classic CDR, little endian, written and read by hand: each number at a multiple of its size,
// counted after the 4 bytes that name the encoding; a text with its length and a closing zero.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace selfcal {

class CdrOut {
 public:
  template <class T>
  CdrOut& add(T value) {
    while ((bytes_.size() - 4) % sizeof value != 0) bytes_.push_back(0);
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes_.append(raw, sizeof value);
    return *this;
  }
  CdrOut& text(const std::string& value) {
    add(static_cast<std::uint32_t>(value.size() + 1));
    bytes_ += value;
    bytes_.push_back(0);
    return *this;
  }
  /// std_msgs/Header with a stamp (ns) and no frame.
  CdrOut& header(std::int64_t stamp) {
    add(static_cast<std::int32_t>(stamp / 1'000'000'000));
    add(static_cast<std::uint32_t>(stamp % 1'000'000'000));
    return text("");
  }
  CdrOut& numbers(const std::vector<double>& values) {
    add(static_cast<std::uint32_t>(values.size()));
    for (const double value : values) add(value);
    return *this;
  }
  CdrOut& texts(const std::vector<std::string>& values) {
    add(static_cast<std::uint32_t>(values.size()));
    for (const std::string& value : values) text(value);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_{"\0\1\0\0", 4};
};

/// Reads in the same way; what is beyond the end reads as zero, and good() says that it happened.
class CdrIn {
 public:
  explicit CdrIn(const std::string& bytes)
      : bytes_(bytes), good_(bytes.size() >= 4 && bytes[0] == 0 && bytes[1] == 1) {}

  template <class T>
  T number() {
    while ((at_ - 4) % sizeof(T) != 0) ++at_;
    T value{};
    if (!holds(sizeof(T))) return value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::string text() {
    const auto size = number<std::uint32_t>();
    if (size == 0 || !holds(size)) return good_ = false, std::string();
    std::string value = bytes_.substr(at_, size - 1);
    at_ += size;
    return value;
  }
  /// Seconds and nanoseconds, as nanoseconds.
  std::int64_t time() {
    const auto seconds = number<std::int32_t>();
    return std::int64_t{1'000'000'000} * seconds + number<std::uint32_t>();
  }
  std::vector<double> numbers() {
    std::vector<double> values;
    for (auto left = number<std::uint32_t>(); left > 0 && good_; --left)
      values.push_back(number<double>());
    return values;
  }
  std::vector<std::string> texts() {
    std::vector<std::string> values;
    for (auto left = number<std::uint32_t>(); left > 0 && good_; --left) values.push_back(text());
    return values;
  }
  bool good() const { return good_; }
  /// All has been read but for padding.
  bool ended() const { return good_ && bytes_.size() - at_ < 4; }

 private:
  bool holds(std::size_t size) {
    if (!good_ || at_ > bytes_.size() || size > bytes_.size() - at_) good_ = false;
    return good_;
  }
  const std::string& bytes_;
  std::size_t at_ = 4;
  bool good_;
};

}  // namespace selfcal
