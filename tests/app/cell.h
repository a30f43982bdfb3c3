// The real program as a service of a simulated cell of a test's own.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/program.h"

namespace selfcal {

/// A folder with the example cell, in a DDS domain of the test's own on the loopback interface.
class CellTest : public ::testing::Test {
 protected:
  CellTest();
  /// The service of robot `id`, its state in state_ID; `more` keys go into its configuration.
  std::unique_ptr<Running> serve(const std::string& id, const std::string& more = {});
  std::filesystem::path config(const std::string& id) const {
    return folder / (id + ".config.yaml");
  }
  /// " --domain N", for monitor and command.
  std::string in_domain() const { return " --domain " + std::to_string(domain); }
  /// Watches the service until a message `is_it`, within two minutes; null when none was.
  nlohmann::json heard(const std::function<bool(const nlohmann::json&)>& is_it) const;

  std::filesystem::path folder;
  int domain = 0;
};

}  // namespace selfcal
