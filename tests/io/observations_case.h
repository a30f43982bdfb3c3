// Rows of a data set as they are read, and what is said of them.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/io/data_set_folder.h"

namespace selfcal {

class ObservationsCsv : public DataSetFolder {
 protected:
  std::vector<std::string> notices(const std::string& csv) const {
    const auto loaded = load(csv);
    EXPECT_TRUE(loaded.has_value()) << loaded.error().what;
    std::vector<std::string> cut;
    if (!loaded) return cut;
    for (const std::string& notice : loaded->notices) {
      if (!notice.ends_with("has no rows")) cut.push_back(without_folder(notice));
    }
    return cut;
  }
};

}  // namespace selfcal
