#include "io/dds/names.h"

#include <gtest/gtest.h>

namespace selfcal {
namespace {

TEST(DdsNames, MakeAnyRobotsIdAPartOfARosName) {
  EXPECT_EQ(ros_name("rx90"), "rx90");
  EXPECT_EQ(ros_name("RX-90 #2"), "rx_90_2");
  EXPECT_EQ(ros_name("6-axis"), "robot_6_axis");
  EXPECT_EQ(ros_name("__cell__7__"), "cell_7");
  EXPECT_EQ(ros_name("a/b.c"), "a_b_c");
  EXPECT_EQ(ros_name("Stäubli"), "st_ubli");
  EXPECT_EQ(ros_name("机器人"), "robot");
  EXPECT_EQ(ros_name(""), "robot");
}

TEST(DdsNames, AreValidWhateverTheId) {
  std::string all;
  for (int c = 1; c < 256; ++c) all += static_cast<char>(c);
  for (const std::string& id : {all, std::string("9"), std::string("-"), std::string("_9_")}) {
    const std::string name = ros_name(id);
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"), std::string::npos);
    EXPECT_TRUE(name.front() >= 'a' && name.front() <= 'z') << name;
    EXPECT_NE(name.back(), '_') << name;
    EXPECT_EQ(name.find("__"), std::string::npos) << name;
    EXPECT_EQ(ros_name(name), name);
  }
}

TEST(DdsNames, PutTopicsWhereRosLooksForThem) {
  EXPECT_EQ(robot_topic("RX-90", "status"), "rt/selfcal/rx_90/status");
  EXPECT_EQ(ros_topic("diagnostics"), "rt/diagnostics");
  EXPECT_EQ(ros_topic("/cell/joint_states"), "rt/cell/joint_states");
}

}  // namespace
}  // namespace selfcal
