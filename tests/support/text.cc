#include "tests/support/text.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace selfcal {

std::string text_of(const std::filesystem::path& path) {
  std::stringstream stream;
  stream << std::ifstream(path).rdbuf();
  return stream.str();
}

void replace(std::string& text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  ASSERT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), by);
}

}  // namespace selfcal
