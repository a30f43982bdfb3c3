// Files of a test's own, taken whole and changed a little.
#pragma once

#include <filesystem>
#include <string>

namespace selfcal {

std::string text_of(const std::filesystem::path& path);

/// Replaces the first `what`; a failed test when there is none.
void replace(std::string& text, const std::string& what, const std::string& by);

}  // namespace selfcal
