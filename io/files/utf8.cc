// UTF-8 as RFC 3629 has it: a lead byte says how many bytes of the form 10xxxxxx follow, and no
// shorter form of the same character may exist. UTF-16 as RFC 2781 has it: a character beyond
// 0xFFFF is 0x10000 + (high - 0xD800) 0x400 + (low - 0xDC00).
#include "io/files/utf8.h"

namespace selfcal {
namespace {

/// Bytes of the character at the start of `bytes`, which begins with a byte from 0x80 on; 0 if
/// broken.
std::size_t length_of_character(std::string_view bytes) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const unsigned lead = at(0);
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC0 || lead > 0xF4 || bytes.size() < length) return 0;
  unsigned code = lead & (0xFFu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((at(i) & 0xC0u) != 0x80u) return 0;
    code = code << 6 | (at(i) & 0x3Fu);
  }
  constexpr unsigned kLeast[] = {0, 0, 0x80, 0x800, 0x10000};  // by length
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code < kLeast[length] || code > 0x10FFFF || surrogate ? 0 : length;
}

constexpr std::string_view kMarkOfUtf8 = "\xEF\xBB\xBF", kMarkOfLittleEndian = "\xFF\xFE",
                           kMarkOfBigEndian = "\xFE\xFF";
constexpr char kNoText = '\xFF';  // in no UTF-8

std::string utf8_of(unsigned code) {
  const auto follows = [&](int bits) { return static_cast<char>(0x80u | (code >> bits & 0x3Fu)); };
  if (code < 0x80) return {static_cast<char>(code)};
  if (code < 0x800) return {static_cast<char>(0xC0u | code >> 6), follows(0)};
  if (code < 0x10000) return {static_cast<char>(0xE0u | code >> 12), follows(6), follows(0)};
  return {static_cast<char>(0xF0u | code >> 18), follows(12), follows(6), follows(0)};
}

}  // namespace

bool is_text(std::string_view bytes) {
  std::size_t i = 0;
  while (i < bytes.size()) {
    const unsigned char byte = static_cast<unsigned char>(bytes[i]);
    if (byte == 0) return false;
    const std::size_t length = byte < 0x80 ? 1 : length_of_character(bytes.substr(i));
    if (length == 0) return false;
    i += length;
  }
  return true;
}

char first_of(std::string_view text) {
  if (text.starts_with(kMarkOfUtf8)) text.remove_prefix(kMarkOfUtf8.size());
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first == std::string_view::npos ? '\0' : text[first];
}

std::string_view Utf8Pieces::take(std::string_view piece) {
  if (form_ == Form::as_it_stands) return piece;
  rest_ += piece;
  text_.clear();
  if (form_ == Form::unknown) {
    if (kMarkOfUtf8.starts_with(rest_) && rest_ != kMarkOfUtf8 && !piece.empty()) return {};
    if (rest_.size() == 1 && (rest_[0] == '\xFF' || rest_[0] == '\xFE')) return {};
    form_ = rest_.starts_with(kMarkOfLittleEndian) ? Form::little_endian
            : rest_.starts_with(kMarkOfBigEndian)  ? Form::big_endian
                                                   : Form::as_it_stands;
    rest_.erase(0, form_ != Form::as_it_stands      ? kMarkOfLittleEndian.size()
                   : rest_.starts_with(kMarkOfUtf8) ? kMarkOfUtf8.size()
                                                    : 0);
    if (form_ == Form::as_it_stands) {
      text_.swap(rest_);
      return text_;
    }
  }
  const int low = form_ == Form::little_endian ? 0 : 1;
  const std::size_t whole = rest_.size() / 2 * 2;
  for (std::size_t i = 0; i < whole; i += 2) {
    const auto at = [&](int which) {
      return static_cast<unsigned char>(rest_[i + static_cast<std::size_t>(which)]);
    };
    take_unit(at(low) | static_cast<unsigned>(at(1 - low)) << 8);
  }
  rest_.erase(0, whole);
  return text_;
}

void Utf8Pieces::take_unit(unsigned unit) {
  const bool low = unit >= 0xDC00 && unit <= 0xDFFF, high = unit >= 0xD800 && unit <= 0xDBFF;
  if (low != (high_ != 0)) text_ += kNoText;
  if (low && high_ != 0) text_ += utf8_of(0x10000 + (high_ - 0xD800) * 0x400 + (unit - 0xDC00));
  if (!low && !high) text_ += utf8_of(unit);
  high_ = high ? unit : 0;
}

}  // namespace selfcal
