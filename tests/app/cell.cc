#include "tests/app/cell.h"

#include <chrono>
#include <fstream>

#include "tests/support/domain.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

constexpr std::chrono::minutes kLongest(2);

}  // namespace

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
