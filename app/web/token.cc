#include "app/web/token.h"

#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>

#include "io/files/file.h"

namespace selfcal {

Result<std::string> read_token(const std::filesystem::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) == 0 && (info.st_mode & (S_IRGRP | S_IROTH)) != 0)
    return bad_input(file.string() + ": others may read this token; chmod 600 " + file.string());
  auto text = read_file(file, 4096);
  if (!text) return tl::unexpected(text.error());
  std::string token = text->substr(0, text->find_first_of("\r\n"));
  const bool printable =
      std::ranges::all_of(token, [](unsigned char c) { return c > ' ' && c < 0x7f; });
  if (!printable || token.size() < kLeastToken || token.size() > kMostToken)
    return bad_input(file.string() + ":1: expected a token of " + std::to_string(kLeastToken) +
                     " to " + std::to_string(kMostToken) + " letters, digits or signs");
  return token;
}

Result<std::string> new_token() {
  std::array<unsigned char, 16> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1)
    return device_failed("no random numbers for a token");
  std::string token;
  for (const unsigned char byte : bytes) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    token += kDigits[byte >> 4U];
    token += kDigits[byte & 15U];
  }
  return token;
}

bool same_token(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace selfcal
