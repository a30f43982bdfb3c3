// UTF-8 and what only looks like it.
#include "io/files/utf8.h"

#include <gtest/gtest.h>

namespace selfcal {
namespace {

TEST(Utf8, TakesCharactersOfEveryLength) {
  for (const char* text :
       {"", "abc\r\n\t", "é µ °", "日本", "\xF0\x9F\xA4\x96", "\xF4\x8F\xBF\xBF"}) {
    EXPECT_TRUE(is_text(text)) << text;
  }
}

// The cases of RFC 3629, section 10, and of broken sequences.
TEST(Utf8, RefusesOtherBytes) {
  using namespace std::string_view_literals;
  for (const std::string_view bytes :
       {"a\0b"sv, "\x80"sv, "\xC3"sv, "\xC3("sv, "\xC0\x80"sv, "\xC1\xBF"sv, "\xE0\x80\xAF"sv,
        "\xED\xA0\x80"sv, "\xE2\x82"sv, "\xF0\x80\x80\x80"sv, "\xF4\x90\x80\x80"sv,
        "\xF5\x80\x80\x80"sv, "\xFF\xFE"sv, "J\xF6rg"sv}) {
    EXPECT_FALSE(is_text(bytes)) << bytes;
  }
}

}  // namespace
}  // namespace selfcal
