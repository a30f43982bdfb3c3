// The diagnosis on real measurements, when they are at hand: how far the gap closes on rows that no
// choice has seen, and a cause of our own planted into real noise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "diagnosis/diagnosis.h"
#include "io/data_set_file.h"
#include "tests/shared_data.h"

namespace selfcal {
namespace {

struct RealCase {
  const char* name;
  double most_after_mm;  ///< rms on rows kept aside; a tenth above what was measured
};

class RealGap : public testing::TestWithParam<RealCase> {};

TEST_P(RealGap, ClosesOnRowsThatNoChoiceHasSeen) {
  SELFCAL_NEED_SHARED();
  auto loaded = load_data_set(shared_dir() / "data" / GetParam().name);
  ASSERT_TRUE(loaded);
  const Diagnosis diagnosis = diagnose(std::move(loaded->robot), loaded->data);
  std::printf("%s: %.4g mm calibrated, %.4g mm with what was found; %s\n", GetParam().name,
              1e3 * diagnosis.gap.rms_before, 1e3 * diagnosis.gap.rms_after, diagnosis.why.c_str());
  EXPECT_LE(1e3 * diagnosis.gap.rms_after, GetParam().most_after_mm);
}

INSTANTIATE_TEST_SUITE_P(
    Sets, RealGap,
    testing::Values(RealCase{"ipa-ur10-random", 0.13}, RealCase{"ipa-ur10-joint", 0.21},
                    RealCase{"motoman-tracker", 0.42}, RealCase{"mukca-panda-1", 0.42},
                    RealCase{"mukca-panda-3", 0.19}, RealCase{"mukca-panda-6", 0.24},
                    RealCase{"mukca-kuka-14", 0.21}),
    [](const auto& each) {
      std::string name = each.param.name;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

/// Every other configuration of the fit rows, from the first or the second on; all check rows.
DataSet half(const DataSet& data, int from) {
  std::vector<int> rows;
  int configuration = -1, last_repeat = -2;
  for (int row = 0; row < data.rows.rows(); ++row) {
    const int repeat = data.rows.repeat.empty() ? -1 : data.rows.repeat[row];
    if (!data.rows.check[row] && (repeat < 0 || repeat != last_repeat)) ++configuration;
    last_repeat = repeat;
    if (data.rows.check[row] || configuration % 2 == from) rows.push_back(row);
  }
  DataSet some = data;
  some.rows = taken(data.rows, rows);
  return some;
}

TEST_P(RealGap, IsExplainedTheSameByEitherHalfOfTheRows) {
  SELFCAL_NEED_SHARED();
  auto loaded = load_data_set(shared_dir() / "data" / GetParam().name);
  ASSERT_TRUE(loaded);
  const std::shared_ptr<const Robot> robot = std::move(loaded->robot);
  const Diagnosis first = diagnose(robot, half(loaded->data, 0));
  const Diagnosis second = diagnose(robot, half(loaded->data, 1));
  const std::string both = std::string(GetParam().name) + ": " + first.why + " | " + second.why;
  std::printf("%s\n", both.c_str());
  // A half may know too little to name a cause; it must not name another one.
  const auto says_nothing = [](const Diagnosis& d) {
    return d.verdict.effect == "none" || d.verdict.effect == "unknown";
  };
  if (says_nothing(first) || says_nothing(second)) return;
  EXPECT_EQ(first.verdict.effect, second.verdict.effect) << both;
}

TEST(RealNoise, ShowsACauseThatWasPlantedIntoIt) {
  SELFCAL_NEED_SHARED();
  auto loaded = load_data_set(shared_dir() / "data" / "mukca-panda-6");
  ASSERT_TRUE(loaded);
  // The third joint is dragged along by the second: the readings are what it would have shown.
  const double kappa = 3e-3;
  loaded->data.rows.q.col(2) -= kappa * loaded->data.rows.q.col(1);
  const std::string from = loaded->robot->joints()[1].name, at = loaded->robot->joints()[2].name;
  const Diagnosis diagnosis = diagnose(std::move(loaded->robot), loaded->data);
  EXPECT_EQ(diagnosis.verdict.effect, "joint_coupling");
  EXPECT_THAT(diagnosis.verdict.where, testing::Contains(at));
  bool found = false;
  for (const NamedValue& p : diagnosis.verdict.parameters)
    if (p.name == at + ".kappa_" + from) {
      found = true;
      EXPECT_NEAR(p.value, kappa, std::max(4 * p.sigma, 0.15 * kappa));
    }
  EXPECT_TRUE(found) << diagnosis.why;
}

}  // namespace
}  // namespace selfcal
