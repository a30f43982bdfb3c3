// Two sessions as one data set.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/methods/data_set.h"

namespace selfcal {
namespace {

using testing::ElementsAre;

/// One touch of a plane by a probe of this radius (m).
DataSet touch(const char* radius, const char* noise) {
  Problems problems;
  Node entry = Node::map();
  entry.set("method", Node::of(std::string("plane")))
      .set("noise", Node::of(std::string(noise)))
      .set("probe_radius", Node::of(std::string(radius)));
  DataSet data;
  data.sets = {make_set("table", entry, problems)};
  EXPECT_FALSE(problems.any()) << problems.list.front();
  data.rows.q.setZero(1, 2);
  data.rows.set = {0};
  data.rows.group = {-1};
  data.rows.check = {0};
  return data;
}

std::vector<std::string> names(const DataSet& data) {
  std::vector<std::string> list;
  for (const Set& set : data.sets) list.push_back(set.name);
  return list;
}

TEST(Merged, AreOneSetWhereNameMethodAndOptionsAreTheSame) {
  const DataSet both = merged(touch("0.003", "2e-5"), touch("3.0e-3", "1e-5"));
  EXPECT_THAT(names(both), ElementsAre("table"));
  EXPECT_THAT(both.rows.set, ElementsAre(0, 0));
}

TEST(Merged, AreTwoWhereTheProbesDiffer) {
  const DataSet both = merged(touch("0.003", "2e-5"), touch("0.005", "2e-5"));
  EXPECT_THAT(names(both), ElementsAre("table", "table'"));
  EXPECT_THAT(both.rows.set, ElementsAre(0, 1));
}

}  // namespace
}  // namespace selfcal
