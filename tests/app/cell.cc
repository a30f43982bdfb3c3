#include "tests/app/cell.h"

#include <sys/wait.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>

#include "tests/support/domain.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

constexpr std::chrono::minutes kLongest(2);

Ran run(const std::string& command) {
  Ran ran;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    ran.out.append(buffer.data(), n);
  ran.status = WEXITSTATUS(pclose(pipe));
  return ran;
}

}  // namespace

Ran run_selfcal(const std::string& arguments, bool quiet) {
  return run(std::string(SELFCAL_BINARY) + " " + arguments + (quiet ? " 2>/dev/null" : " 2>&1"));
}

Ran run_in_bash(const std::string& script) { return run("bash -c '" + script + "' 2>&1"); }

CellTest::CellTest()
    : folder(
          std::filesystem::path(testing::TempDir()) /
          (std::string("cell_") + testing::UnitTest::GetInstance()->current_test_info()->name())),
      domain(static_cast<int>(new_domain())) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  for (const char* name : {"rx90.robot.yaml", "rx90_cell.scenario.yaml"})
    std::filesystem::copy_file(std::filesystem::path(SELFCAL_SOURCE_DIR "/app/examples") / name,
                               folder / name);
}

std::unique_ptr<Running> CellTest::serve(const std::string& id, const std::string& more) {
  std::string text = text_of(SELFCAL_SOURCE_DIR "/app/examples/rx90_cell.config.yaml");
  const std::string named = "\nid: rx90 ";
  text.replace(
      text.find(named), named.size(),
      "\nid: " + id + "\nstate: state_" + id + "\ndomain: " + std::to_string(domain) + " ");
  std::ofstream(config(id)) << text << more;
  return std::make_unique<Running>(
      std::vector<std::string>{"serve", config(id).string(), "--simulate"}, folder / (id + ".log"));
}

nlohmann::json CellTest::heard(const std::function<bool(const nlohmann::json&)>& is_it) const {
  const auto end = std::chrono::steady_clock::now() + kLongest;
  FILE* pipe =
      popen((std::string(SELFCAL_BINARY) + " monitor --json --wait 60" + in_domain()).c_str(), "r");
  nlohmann::json found;
  char* line = nullptr;
  std::size_t size = 0;
  // A service that lives says something every second.
  while (found.is_null() && std::chrono::steady_clock::now() < end &&
         getline(&line, &size, pipe) > 0)
    if (auto message = nlohmann::json::parse(line); is_it(message)) found = std::move(message);
  free(line);
  EXPECT_EQ(pclose(pipe), 0) << "the monitor ends well when nobody reads any more";
  return found;
}

}  // namespace selfcal
