// Who may command, and what is believed to keep strangers out.
#include "app/service/command_rules.h"

#include <gmock/gmock.h>

namespace selfcal {
namespace {

using testing::HasSubstr;

TEST(Reach, IsTheNetworkUnlessEveryInterfaceNamedIsThisComputersOwn) {
  EXPECT_FALSE(reach_of("").loopback);
  EXPECT_FALSE(reach_of("<General><AllowMulticast>false</AllowMulticast></General>").loopback);
  EXPECT_FALSE(reach_of("<NetworkInterface autodetermine=\"true\"/>").loopback);
  EXPECT_FALSE(reach_of("<NetworkInterface name=\"eth0\"/>").loopback);
  EXPECT_FALSE(
      reach_of("<NetworkInterface name='lo'/><NetworkInterface address=\"10.0.0.7\"/>").loopback);
  EXPECT_FALSE(reach_of("<!-- <NetworkInterface name=\"lo\"/> -->").loopback);
  EXPECT_TRUE(reach_of("<NetworkInterface name=\"lo\" multicast=\"true\"/>").loopback);
  EXPECT_TRUE(
      reach_of("<Interfaces><NetworkInterface address=\"127.0.0.1\"/></Interfaces>").loopback);
  EXPECT_TRUE(reach_of("<NetworkInterfaceAddress> 127.0.0.1 </NetworkInterfaceAddress>").loopback);
}

TEST(Reach, KnowsWhetherDdsSecurityIsConfigured) {
  EXPECT_TRUE(reach_of("<Security><Authentication/></Security>").secured);
  EXPECT_TRUE(reach_of("<DDSSecurity></DDSSecurity>").secured);
  EXPECT_FALSE(reach_of("<General/>").secured);
}

TEST(CommandRules, TakeNothingByDefault) {
  const CommandRules rules;
  for (const Verb verb : {Verb::start, Verb::abort, Verb::accept})
    EXPECT_THAT(rules.forbids(verb), HasSubstr("no commands over DDS"));
  EXPECT_TRUE(rules.hold({}));
  EXPECT_EQ(rules.text(), "no commands are taken over DDS");
}

TEST(CommandRules, HoldOnlyWhereStrangersAreKeptOutAsTheySay) {
  CommandRules rules{CommandRules::Over::loopback, {Verb::start, Verb::abort}};
  EXPECT_FALSE(rules.hold({.loopback = false, .secured = true}));
  EXPECT_TRUE(rules.hold({.loopback = true}));
  rules.over = CommandRules::Over::secured;
  EXPECT_FALSE(rules.hold({.loopback = true}));
  EXPECT_TRUE(rules.hold({.secured = true}));
  rules.over = CommandRules::Over::network;
  EXPECT_TRUE(rules.hold({}));
  EXPECT_THAT(rules.text(), HasSubstr("start, abort may be commanded by ANYONE"));
}

}  // namespace
}  // namespace selfcal
