// A store that other hands have changed, under the real program: said on every channel, and the
// last good parameters in use.
#include <gmock/gmock.h>

#include <fstream>

#include "io/files/robot_file.h"
#include "tests/app/cell.h"
#include "tests/io/store_content.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class DamagedStore : public CellTest {
 protected:
  DamagedStore() : state(folder / "state_rx90") {
    const auto robot = load_robot(folder / "rx90.robot.yaml").value();
    const auto store = opened(state);
    for (const double moved : {0.001, 0.002}) {
      const std::int64_t id = store->begin(some_session(), some_plan(2, 6)).value();
      for (int step = 0; step < 2; ++step) EXPECT_TRUE(store->add(id, some_touch(step, 6)));
      Eigen::VectorXd xi = values(*robot);
      xi[3] += moved;
      ResultRecord result = some_result(id);
      result.robot_text = robot_text(*robot, xi);
      const SlotRecord candidate{id, id, model_hash(*robot), result.robot_text};
      EXPECT_TRUE(store->finish(result, &candidate));
      EXPECT_TRUE(store->accept(id));
    }
    EXPECT_TRUE(store->add(EventRecord{0, 1'790'000'000'000, "info", "started"}));
  }

  void change(const std::string& sql) { with_sqlite(state / "selfcal.db", sql); }
  static std::string line(const Json& health, const std::string& name) {
    for (const Json& each : health["lines"])
      if (each["name"] == name) return each.dump();
    return "";
  }

  const std::filesystem::path state;
};

TEST_F(DamagedStore, IsSaidOnEveryChannelAndThePreviousParametersAreUsed) {
  change(
      "UPDATE text SET body = replace(body, '0.5', '0.9')"
      " WHERE id = (SELECT robot FROM slot WHERE slot = 0)");
  const auto service = serve("rx90");

  const Json health = heard([](const Json& m) { return m["topic"] == "health"; });
  const Json status = heard([](const Json& m) { return m["topic"] == "status"; });

  EXPECT_EQ(status["active"], "session 1");
  EXPECT_THAT(line(health, "selfcal: store"),
              AllOf(HasSubstr("\"error\""), HasSubstr("the active parameters (session 2)")));
  EXPECT_THAT(line(health, "selfcal: calibration"),
              AllOf(HasSubstr("\"error\""), HasSubstr("of session 1, are used")));
  EXPECT_THAT(text_of(folder / "rx90.log"), HasSubstr("the active parameters (session 2)"));
  EXPECT_THAT(run_selfcal("history --events " + state.string()).out,
              AllOf(HasSubstr("error"), HasSubstr("the active parameters (session 2)")));
  EXPECT_THAT(run_selfcal("history " + state.string()).out,
              AllOf(HasSubstr("active     session 1"), HasSubstr("Damaged and not used"),
                    HasSubstr("the active parameters (session 2)")));
  const auto written = load_robot(state / "active.robot.yaml").value();
  const auto factory = load_robot(folder / "rx90.robot.yaml").value();
  EXPECT_NEAR(values(*written)[3] - values(*factory)[3], 0.001, 1e-12);  // rounding of 1 m
}

TEST_F(DamagedStore, OfNoBytesIsNoNewRobot) {
  std::filesystem::remove(state / "selfcal.db-wal");
  std::filesystem::resize_file(state / "selfcal.db", 0);
  std::ofstream(state / "active.robot.yaml") << "the parameters of session 2";
  EXPECT_THAT(run_selfcal("history " + state.string()).out, HasSubstr("was emptied"));
  const auto service = serve("rx90");

  const Json health = heard([](const Json& m) { return m["topic"] == "health"; });

  EXPECT_THAT(line(health, "selfcal: store"),
              AllOf(HasSubstr("\"error\""), HasSubstr("was emptied (0 bytes)")));
  EXPECT_THAT(line(health, "selfcal: calibration"),
              AllOf(HasSubstr("\"error\""), HasSubstr("the factory's are used")));
  EXPECT_EQ(text_of(state / "active.robot.yaml.before"), "the parameters of session 2");
}

TEST_F(DamagedStore, IsToldByHistoryRowByRow) {
  change(
      "UPDATE result SET check_after = 1e-9 WHERE session = 2;"
      "UPDATE session SET reason = 'nobody' WHERE id = 1;"
      "UPDATE event SET text = 'all is well' WHERE id = 1;"
      "UPDATE touch SET step = 0 WHERE id = (2 << 20) + 1;"
      "UPDATE slot SET since_ms = 5 WHERE slot = 1");

  const Ran table = run_selfcal("history " + state.string());
  const Ran events = run_selfcal("history --events " + state.string());

  EXPECT_EQ(table.status, 0) << table.out;
  EXPECT_THAT(table.out, AllOf(HasSubstr("damaged result"), HasSubstr("this row of the store"),
                               HasSubstr("previous   damaged"), HasSubstr("touch 1 of session 2")));
  EXPECT_THAT(events.out, HasSubstr("error    this row of the store is damaged"));
  EXPECT_EQ(events.out.find("all is well"), std::string::npos);
}

}  // namespace
}  // namespace selfcal
