// The first line of a dataset.yaml tells a folder that may be replaced from measurements.
#include "io/files/data_set_writer.h"

#include <system_error>

#include "io/files/file.h"
#include "io/files/observations_text.h"
#include "io/files/yaml.h"

namespace selfcal {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSimulatedMark =
    "# Simulated; `selfcal simulate` may replace this folder.\n";

/// True when dataset.yaml begins with the mark.
bool is_marked(const fs::path& file) {
  Result<InputFile> input = InputFile::open(file);
  if (!input) return false;
  std::string start(kSimulatedMark.size(), '\0');
  const Result<std::size_t> got = input->read(start);
  return got && *got == kSimulatedMark.size() && start == kSimulatedMark;
}

}  // namespace

Result<void> check_replaceable(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error)) return {};
  if (!fs::is_directory(folder, error))
    return bad_input(folder.string() + ": expected a folder, got a file");
  if (fs::is_empty(folder, error) && !error) return {};
  if (is_marked(folder / "dataset.yaml")) return {};
  return bad_input(folder.string() +
                   ": is not empty and holds no simulated data set: choose a new folder");
}

Result<void> write_data_set(const fs::path& folder, const NewDataSet& data_set) {
  if (auto free = check_replaceable(folder); !free) return free;
  if (auto made = make_folder(folder); !made) return made;
  const std::string mark(kSimulatedMark);
  const std::pair<std::string, std::string> files[] = {
      {"dataset.yaml", mark},
      {data_set.robot_file, data_set.robot_text},
      {"observations.csv", observations_text(*data_set.data)},
      {"dataset.yaml", mark + write_yaml(data_set.description)}};
  for (const auto& [name, text] : files)
    if (auto done = write_file_atomically(folder / name, text); !done) return done;
  return {};
}

}  // namespace selfcal
