// A small data set that is right, to be broken in one place at a time.
#pragma once

#include <string>

#include "io/files/data_set_file.h"
#include "tests/io/scratch.h"

namespace selfcal {

/// One revolute and one prismatic joint; sets of the methods that ask for different columns.
class DataSetFolder : public testing::Test {
 protected:
  std::string robot =
      "robot: arm\n"
      "kind: serial\n"
      "frames:\n"
      "  - {name: base, joint: fixed}\n"
      "  - {name: j1, joint: revolute, d: 0.3, limits: [-2, 2]}\n"
      "  - {name: j2, joint: prismatic, alpha: 1.5, limits: [0, 1]}\n"
      "  - {name: tool, joint: fixed, r: 0.1}\n";
  std::string head = "robot: arm.robot.yaml\nobservations: observations.csv\n";
  std::string sets =
      "sets:\n"
      "  tracker: {method: position, noise: 2.0e-5}\n"
      "  arm: {method: location}\n"
      "  bar: {method: distance}\n"
      "  tip: {method: position-constraint}\n"
      "  table: {method: plane}\n";

  static std::string only(const std::string& set) { return "sets:\n  " + set + "\n"; }

  /// Loads the data set with these rows.
  Result<LoadedDataSet> load(const std::string& csv) const {
    scratch_.write("arm.robot.yaml", robot);
    scratch_.write("dataset.yaml", head + sets);
    scratch_.write("observations.csv", csv);
    return load_data_set(scratch_.folder());
  }

  /// What loading fails with, the folder's path cut off.
  std::string error(const std::string& csv) const {
    const Result<LoadedDataSet> loaded = load(csv);
    if (loaded) return "no error";
    EXPECT_EQ(loaded.error().exit_status, kBadInput);
    return without_folder(loaded.error().what);
  }

  std::string without_folder(std::string text) const {
    const std::string folder = scratch_.folder().string() + "/";
    if (text.starts_with(folder)) text.erase(0, folder.size());
    return text;
  }

  const Scratch& scratch() const { return scratch_; }

 private:
  Scratch scratch_;
};

}  // namespace selfcal
