// Where the data that lie beside the checkout are, and what a test does that cannot find them.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace selfcal {

/// The folder with the data: SELFCAL_SHARED of the environment, else ../shared of the checkout.
inline std::filesystem::path shared_dir() {
  const char* chosen = std::getenv("SELFCAL_SHARED");
  return std::filesystem::path(chosen != nullptr && *chosen != '\0' ? chosen
                                                                    : SELFCAL_SHARED_DEFAULT)
      .lexically_normal();
}

/// True when SELFCAL_REQUIRE_ALL is set (and not 0): a test that lacks its data fails.
inline bool all_required() {
  const char* text = std::getenv("SELFCAL_REQUIRE_ALL");
  return text != nullptr && *text != '\0' && std::string_view(text) != "0";
}

}  // namespace selfcal

/// First statement of a test, or of a fixture's SetUp, that reads shared_dir().
#define SELFCAL_NEED_SHARED()                                          \
  GTEST_AMBIGUOUS_ELSE_BLOCKER_                                        \
  if (std::filesystem::is_directory(::selfcal::shared_dir())) {        \
  } else if (::selfcal::all_required())                                \
    FAIL() << "SELFCAL_REQUIRE_ALL is set and there are no data in "   \
           << ::selfcal::shared_dir().string() << " (SELFCAL_SHARED)"; \
  else                                                                 \
    GTEST_SKIP() << "no data in " << ::selfcal::shared_dir().string()  \
                 << " (set SELFCAL_SHARED to where they are)"
