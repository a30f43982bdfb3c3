// All 602 marks of Tables 11.3 and 11.4 of Khalil and Dombre, through the program.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/shared_data.h"

namespace selfcal {
namespace {

std::string run(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer;
  while (const size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    text.append(buffer.data(), n);
  pclose(pipe);
  return text;
}

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> list;
  std::string cell;
  std::istringstream stream(line + ",");
  while (std::getline(stream, cell, ',')) list.push_back(cell);
  return list;
}

class Tables : public testing::TestWithParam<std::string> {};

TEST_P(Tables, GiveEveryPublishedMark) {
  SELFCAL_NEED_SHARED();
  const std::map<std::string, std::string> marks{
      {"identified", ""}, {"grouped", "n"}, {"no-effect", "0"}};
  std::ifstream file(shared_dir() / "spec/tables" / ("identifiable_" + GetParam() + ".csv"));
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> methods = cells(line);
  std::vector<std::map<std::string, std::string>> status(methods.size());
  for (size_t m = 1; m < methods.size(); ++m) {
    const auto json = nlohmann::json::parse(
        run(std::string(SELFCAL_BINARY) + " identifiable " +
            (shared_dir() / "robots" / (GetParam() + ".robot.yaml")).string() + " --method " +
            methods[m] + " --json"));
    for (const auto& p : json["parameters"]) status[m][p["name"]] = p["status"];
  }
  int compared = 0;
  while (std::getline(file, line)) {
    const std::vector<std::string> row = cells(line);
    for (size_t m = 1; m < methods.size(); ++m, ++compared)
      EXPECT_EQ(row.at(m), marks.at(status[m].at(row[0]))) << row[0] << " by " << methods[m];
  }
  EXPECT_EQ(compared, 43 * 7);
}

INSTANTIATE_TEST_SUITE_P(Robots, Tables, testing::Values("rx90", "stanford"));

}  // namespace
}  // namespace selfcal
