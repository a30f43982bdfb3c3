// What a person reads of an identification.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/report/summary.h"

namespace selfcal {
namespace {

ParameterResult moved(const char* name, double by, double sigma) {
  ParameterResult result;
  result.parameter.name = name;
  result.parameter.quantity = Quantity::angle;
  result.parameter.tolerance = 2e-3;
  result.status = Status::identified;
  result.value = by;
  result.sigma = sigma;
  return result;
}

TEST(IdentificationSummary, PartsWhatMovedFromWhatTheRowsHardlyTell) {
  Solution solution;
  solution.sets.resize(1);
  solution.parameters = {moved("theta3", 1e-5, 1.99e-3), moved("theta1", 9e-4, 1e-4),
                         moved("theta2", 5e-5, 1e-4)};
  const std::string text = summary(DataSet{}, solution);
  const std::size_t still = text.find("changed by less than their sigma"),
                    hardly = text.find("hardly told by these rows");
  ASSERT_NE(hardly, std::string::npos) << text;
  EXPECT_LT(text.find("theta1"), still);
  EXPECT_GT(text.find("theta2"), still);
  EXPECT_LT(text.find("theta2"), hardly);
  EXPECT_GT(text.find("theta3"), hardly);
}

}  // namespace
}  // namespace selfcal
