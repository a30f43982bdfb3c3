// An input as numbers, one after the other; zeros once it is used up.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

namespace selfcal {

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}

  bool empty() const { return rest_.empty(); }

  template <class T>
  T take() {
    T value{};
    const std::size_t size = std::min(sizeof value, rest_.size());
    if (size > 0) std::memcpy(&value, rest_.data(), size);
    rest_ = rest_.subspan(size);
    return value;
  }
  std::uint8_t byte() { return take<std::uint8_t>(); }
  /// From 0 to below `count`.
  int below(int count) { return byte() % count; }

  /// A text after its length; without zeros, as a C string is.
  std::string text() {
    const std::size_t size = std::min<std::size_t>(byte(), rest_.size());
    std::string text(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(size));
    rest_ = rest_.subspan(size);
    return text.substr(0, text.find('\0'));
  }

  /// All that is left.
  std::string rest() {
    std::string text(rest_.begin(), rest_.end());
    rest_ = {};
    return text;
  }

  /// Mostly a number that a file may hold, at times one that nobody expects.
  double number() {
    static constexpr std::array kOdd = {0.0,
                                        -0.0,
                                        1.0,
                                        -1.0,
                                        1e-300,
                                        5e-324,
                                        1e300,
                                        1e-9,
                                        1e-16,
                                        1e16,
                                        0.5,
                                        1e6,
                                        -1e6,
                                        3.14159265358979,
                                        -1.5707963267948966,
                                        1e-3};
    const std::uint8_t which = byte();
    if (which < kOdd.size()) return kOdd[which];
    return take<std::int16_t>() / 8192.0;  // up to 4
  }

 private:
  std::span<const std::uint8_t> rest_;
};

}  // namespace selfcal
