// Data sets that are allowed and rare.
#include <gtest/gtest.h>

#include "tests/contracts/equations_case.h"

namespace selfcal {
namespace {

// A group that `apart` names may have no row, and a drawn set may have fewer groups than links.
TEST(UnusualSets, MayLinkMoreGroupsThanAreDrawn) {
  std::string apart;
  for (int i = 0; i < 20; ++i) {
    const std::string a = "a" + std::to_string(i), b = "b" + std::to_string(i);
    apart +=
        (i ? ", " : "") + ("{groups: [" + a + ", " + b + "]") + ", distance: 0.1, noise: 1.0e-4}";
  }
  const auto robot = six_axis_arm();
  DataSet data;
  data.sets = make_sets("s: {method: position-constraint, apart: [" + apart + "]}");
  data.sets[0].groups.clear();  // as structural does
  SampleRequest request;
  request.rows = 40;  // ten groups of four
  Random random(1);
  const Sampled sampled = sample_rows(*robot, values(*robot), {request}, random, data);
  const Equations equations(*robot, data, Use::fit);
  const Weighting weighting{std::vector<Scale>(1), std::vector<char>(data.rows.rows(), 0)};
  EXPECT_TRUE(equations.linearise(sampled.truth, weighting).R.allFinite());
}

}  // namespace
}  // namespace selfcal
