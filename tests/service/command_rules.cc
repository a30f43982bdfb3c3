// Who may command, and what is believed to keep strangers out.
#include "app/service/config/command_rules.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <optional>

#include "io/files/file.h"
#include "tests/io/scratch.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

/// Every interface that is named in what holds in domain 0 is this computer's own.
bool loops(const std::string& configuration) { return reach_of(configuration, 0).loopback; }

const std::string kAuthentication =
    "<Authentication><IdentityCA>file:a</IdentityCA><IdentityCertificate>file:b"
    "</IdentityCertificate><PrivateKey>file:c</PrivateKey></Authentication>";
const std::string kAccess =
    "<AccessControl><PermissionsCA>file:a</PermissionsCA><Governance>file:g</Governance>"
    "<Permissions>file:p</Permissions></AccessControl>";

TEST(Reach, IsTheNetworkUnlessEveryInterfaceNamedIsThisComputersOwn) {
  EXPECT_FALSE(loops(""));
  EXPECT_FALSE(loops("<General><AllowMulticast>false</AllowMulticast></General>"));
  EXPECT_FALSE(loops("<NetworkInterface autodetermine=\"true\"/>"));
  EXPECT_FALSE(loops("<NetworkInterface name=\"eth0\"/>"));
  EXPECT_FALSE(loops("<NetworkInterface name='lo'/><NetworkInterface address=\"10.0.0.7\"/>"));
  EXPECT_FALSE(loops("<!-- <NetworkInterface name=\"lo\"/> -->"));
  EXPECT_FALSE(loops("<!--" + std::string(500'000, ' ') + "<NetworkInterface name=\"lo\"/>"));
  EXPECT_TRUE(loops("<NetworkInterface name=\"lo\" multicast=\"true\"/>"));
  EXPECT_TRUE(loops("<Interfaces><NetworkInterface address=\"127.0.0.1\"/></Interfaces>"));
  EXPECT_TRUE(loops("<NetworkInterfaceAddress> 127.0.0.1 </NetworkInterfaceAddress>"));
}

TEST(Reach, IsThatOfTheDomain) {
  const std::string own = "<NetworkInterface name=\"lo\"/>";
  EXPECT_TRUE(reach_of("<Domain Id=\"any\">" + own + "</Domain>", 3).loopback);
  EXPECT_TRUE(reach_of("<Domain id='3'>" + own + "</Domain>", 3).loopback);
  EXPECT_FALSE(reach_of("<Domain Id=\"4\">" + own + "</Domain>", 3).loopback);
  const std::string security = "<Security>" + kAuthentication + kAccess + "</Security>";
  EXPECT_TRUE(reach_of("<Domain Id=\"3\">" + security + "</Domain>", 3).secured);
  EXPECT_FALSE(reach_of("<Domain Id=\"4\">" + security + "</Domain>", 3).secured);
}

TEST(Reach, IsSecuredWhenDdsSecurityHasAllThatItNeeds) {
  const auto reach = [](const std::string& text) { return reach_of(text, 0); };
  EXPECT_TRUE(reach("<Security>" + kAuthentication + kAccess + "</Security>").secured);
  EXPECT_TRUE(reach("<DDSSecurity>" + kAuthentication + kAccess + "</DDSSecurity>").secured);
  EXPECT_EQ(reach("<Security>" + kAuthentication + kAccess + "</Security>").governance, "file:g");
  for (const char* empty :
       {"<DDSSecurity></DDSSecurity>", "<Security/>", "<Security><Authentication/></Security>"}) {
    EXPECT_FALSE(reach(empty).secured) << empty;
    EXPECT_THAT(reach(empty).lacks, HasSubstr("no <IdentityCA>, no <IdentityCertificate>"));
  }
  EXPECT_EQ(reach("<Security>" + kAuthentication + "</Security>").lacks,
            "it has no <PermissionsCA>, no <Governance>, no <Permissions>");
  EXPECT_FALSE(reach("<General/>").secured);
  EXPECT_TRUE(reach("<General/>").lacks.empty());
}

/// CYCLONEDDS_URI as it was, afterwards.
class CycloneUri : public testing::Test {
 protected:
  CycloneUri() {
    if (const char* set = std::getenv("CYCLONEDDS_URI")) before_ = set;
  }
  ~CycloneUri() override {
    unsetenv("SELFCAL_MORE_DDS");
    before_ ? setenv("CYCLONEDDS_URI", before_->c_str(), 1) : unsetenv("CYCLONEDDS_URI");
  }
  static Result<DdsReach> reach(const std::string& uri) {
    setenv("CYCLONEDDS_URI", uri.c_str(), 1);
    return dds_reach(0, "rt/selfcal/r/command");
  }
  std::string file(const char* interface) const {
    return scratch_.write(std::string(interface) + ".xml",
                          std::string("<CycloneDDS><Domain><General><Interfaces>"
                                      "<NetworkInterface name=\"") +
                              interface + "\"/></Interfaces></General></Domain></CycloneDDS>\n");
  }

 private:
  Scratch scratch_;
  std::optional<std::string> before_;
};

TEST_F(CycloneUri, IsReadAsTheLibraryReadsIt) {
  const std::string own = file("lo"), network = file("eth0");
  const std::string element = read_file(own, 1000).value();
  EXPECT_TRUE(reach("file://" + own)->loopback);
  EXPECT_TRUE(reach(own)->loopback);
  EXPECT_TRUE(reach(" " + element + ", file://" + own)->loopback);
  EXPECT_FALSE(reach("file://" + own + "," + network)->loopback);
  EXPECT_FALSE(reach(element + "," + network)->loopback);
  EXPECT_FALSE(reach(own + ",<!-- lo > --><General/>,file://" + network)->loopback);
  setenv("SELFCAL_MORE_DDS", network.c_str(), 1);
  EXPECT_FALSE(reach(own + ",${SELFCAL_MORE_DDS}")->loopback);
  EXPECT_THAT(reach(own + ",/nowhere.xml").error().what,
              HasSubstr("CYCLONEDDS_URI: /nowhere.xml: cannot be read"));
}

/// A rule for the domain, one for its topics, and one for those of parameters that anybody writes.
std::string governance(const char* unauthenticated, const char* join, const char* write) {
  return std::string("MIME-Version: 1.0\n<domain_rule><allow_unauthenticated_participants>") +
         unauthenticated + "</allow_unauthenticated_participants><enable_join_access_control>" +
         join +
         "</enable_join_access_control><topic_access_rules><topic_rule><topic_expression>"
         "rt/parameter*</topic_expression><enable_write_access_control>false"
         "</enable_write_access_control></topic_rule><topic_rule><topic_expression>*"
         "</topic_expression><enable_write_access_control>" +
         write + "</enable_write_access_control></topic_rule></topic_access_rules></domain_rule>";
}

TEST(Governance, KeepsStrangersOutOnlyWhenItAsksForCertificateAndPermission) {
  const std::string topic = "rt/selfcal/r/command";
  EXPECT_EQ(admits_strangers(governance("false", "true", "TRUE"), topic), "");
  EXPECT_EQ(admits_strangers(governance("0", "1", "1"), topic), "");
  EXPECT_THAT(admits_strangers(governance("true", "true", "true"), topic),
              HasSubstr("allows unauthenticated"));
  EXPECT_THAT(admits_strangers(governance("false", "false", "true"), topic),
              HasSubstr("lets anybody join"));
  EXPECT_THAT(admits_strangers(governance("false", "true", "false"), topic),
              HasSubstr("lets anybody in the domain write rt/selfcal/r/command"));
  EXPECT_THAT(admits_strangers(governance("false", "true", "true"), "rt/parameter_events"),
              HasSubstr("lets anybody in the domain write"));
  EXPECT_THAT(admits_strangers("", topic), HasSubstr("no <domain_rule>"));
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
  const auto partly = rules.hold({.secured = false, .lacks = "it has no <PrivateKey>"});
  ASSERT_FALSE(partly);
  EXPECT_THAT(partly.error().what, HasSubstr("keeps nobody out: it has no <PrivateKey>"));
  rules.over = CommandRules::Over::network;
  EXPECT_TRUE(rules.hold({}));
  EXPECT_THAT(rules.text(), HasSubstr("start, abort may be commanded by ANYONE"));
}

}  // namespace
}  // namespace selfcal
