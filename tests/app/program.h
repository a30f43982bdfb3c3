// The program on the simulated example, in a folder of each test's own.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/app/cell.h"

namespace selfcal {

class Program : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  std::string simulated() {
    const Ran ran = run_selfcal("simulate " SELFCAL_SOURCE_DIR
                                "/app/examples/rx90_planes.scenario.yaml --out " +
                                (folder_ / "data").string());
    EXPECT_EQ(ran.status, 0) << ran.out;
    return (folder_ / "data").string();
  }
  std::filesystem::path folder_;
};

}  // namespace selfcal
