// The secret that a browser shows where others than this computer's programs reach the page.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/result.h"

namespace selfcal {

inline constexpr std::size_t kLeastToken = 16;  ///< characters
inline constexpr std::size_t kMostToken = 256;

/// The first line of `file`: kLeastToken to kMostToken printable characters without blanks. Fails
/// when other users may read the file.
Result<std::string> read_token(const std::filesystem::path& file);

/// 128 random bits as 32 digits.
Result<std::string> new_token();

/// In a time that does not tell how much of them is equal.
bool same_token(std::string_view a, std::string_view b);

}  // namespace selfcal
