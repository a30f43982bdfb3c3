// DDS Security as app/examples/dds_keys sets it up: who is permitted commands, who is not watches,
// and who has no certificate of the robot's authority neither commands nor hears.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/cell.h"
#include "tests/support/program.h"

namespace selfcal {
namespace {

class Secured : public testing::Test {
 protected:
  static CellOptions options(std::uint32_t domain) {
    CellOptions options;
    options.touches = 8;
    options.id = "secured";
    options.commands = "{over: secured, allow: [start, abort]}";
    options.domain = domain;
    return options;
  }

  std::string text_of_domain() const { return std::to_string(cell.domain); }

  void make_keys(const std::string& folder) {
    const Ran ran = run_in_bash(std::string(SELFCAL_SOURCE_DIR) + "/app/examples/dds_keys " +
                                (cell.folder / folder).string() + " secured " + text_of_domain());
    ASSERT_EQ(ran.status, 0) << ran.out;
  }

  /// Does what `who` of `keys` would; "" has none.
  template <class Do>
  auto as(const std::string& who, Do what, const std::string& keys = "keys") {
    const std::string file = cell.folder / keys / "secured" / who / "cyclonedds.xml";
    if (!who.empty()) setenv("CYCLONEDDS_URI", (open_ + ",file://" + file).c_str(), 1);
    struct Back {
      std::string to;
      ~Back() { setenv("CYCLONEDDS_URI", to.c_str(), 1); }
    } const back{open_};
    return what();
  }

  void SetUp() override {
    make_keys("keys");
    as("service", [&] { cell.start_service(); });
  }

  /// The program's answer to `who`.
  Ran ask(const std::string& who, const std::string& what, const std::string& keys = "keys") {
    return as(
        who, [&] { return run_selfcal(what + " --robot secured --domain " + text_of_domain()); },
        keys);
  }

  const std::uint32_t number = new_domain();
  const std::string open_ = std::getenv("CYCLONEDDS_URI");
  Cell cell{options(number)};  // of this process, which has no certificate
};

TEST_F(Secured, TheAllowedCommandTheForbiddenWatchAndStrangersNeither) {
  Ran seen;
  ASSERT_TRUE(cell.until([&] {
    seen = ask("watcher", "monitor --once --wait 20");
    return seen.out.find("idle") != std::string::npos;
  })) << seen.out;

  const Ran allowed = ask("operator", "command start --wait 60");
  EXPECT_EQ(allowed.status, 0) << allowed.out;

  const Ran forbidden = ask("watcher", "command abort");
  EXPECT_EQ(forbidden.status, kDeviceFailed);
  EXPECT_NE(forbidden.out.find("Not Allowed By Security"), std::string::npos) << forbidden.out;

  const Ran unauthenticated = ask("", "command abort --wait 5");
  EXPECT_EQ(unauthenticated.status, kDeviceFailed);
  EXPECT_NE(unauthenticated.out.find("no service of robot secured"), std::string::npos)
      << unauthenticated.out;

  make_keys("others");
  const Ran of_another_authority = ask("operator", "command abort --wait 5", "others");
  EXPECT_EQ(of_another_authority.status, kDeviceFailed) << of_another_authority.out;

  cell.listen();
  EXPECT_TRUE(cell.statuses.empty()) << "nor do they hear anything";
  EXPECT_TRUE(cell.health.empty());
  EXPECT_EQ(cell.log().find("command abort"), std::string::npos) << cell.log();
  EXPECT_NE(cell.log().find("command start from"), std::string::npos) << cell.log();
  EXPECT_NE(cell.log().find("may be commanded by who DDS Security admits"), std::string::npos);
}

TEST_F(Secured, AServiceWithAGovernanceThatAdmitsAnybodyDoesNotStart) {
  cell.kill_service();
  // The signature does not matter: it is refused before the library looks.
  const Ran ran = run_in_bash("sed -i s/participants.false/participants\\>true/ " +
                              (cell.folder / "keys/secured/service/governance.p7s").string());
  ASSERT_EQ(ran.status, 0) << ran.out;
  as("service", [&] { cell.start_service(); });
  EXPECT_EQ(cell.wait_for_service(), kBadInput);
  EXPECT_NE(cell.log().find("allows unauthenticated participants"), std::string::npos)
      << cell.log();
}

}  // namespace
}  // namespace selfcal
