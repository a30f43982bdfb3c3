// What is told of a store: results, drift, slots, and what cannot be exported.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "app/report/drift.h"
#include "app/report/page/history_page.h"
#include "io/files/file.h"
#include "io/files/robot_file.h"
#include "io/store/store.h"
#include "tests/app/cell.h"

namespace selfcal {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kDay = 86'400'000, kFirst = 1'790'000'000'000;
constexpr const char* kRobot = SELFCAL_SOURCE_DIR "/app/examples/rx90.robot.yaml";

/// The example robot with its parameter `index` moved by `change`.
std::shared_ptr<const Robot> moved(int index, double change) {
  const auto robot = load_robot(kRobot).value();
  Eigen::VectorXd xi = values(*robot);
  xi[index] += change;
  return robot_of(robot_text(*robot, xi), "moved").value();
}

AcceptedParameters calibration(std::int64_t session, int index, double change) {
  return {session, kFirst + session * kDay, moved(index, change)};
}

TEST(Drifts, ComeWithTheOneThatMovedMostFirst) {
  // Parameter 3 jumps at the first calibration and stays; parameter 5 comes and goes after it.
  const std::vector<AcceptedParameters> all = {calibration(1, 3, 2e-3), calibration(2, 5, 1e-3),
                                               calibration(3, 5, 1.5e-3)};
  const std::vector<Drift> found = drifts(all, 10);

  ASSERT_EQ(found.size(), 2);
  EXPECT_NEAR(found[0].since_factory[0], 2e-3, 1e-15);  // rounding of a value of 1
  EXPECT_NEAR(found[0].since_last[1], -2e-3, 1e-15);
  EXPECT_NEAR(found[1].since_factory[2], 1.5e-3, 1e-15);
  EXPECT_NEAR(found[1].since_last[2], 0.5e-3, 1e-15);
  EXPECT_EQ(drifts(all, 1).size(), 1);
  EXPECT_THAT(drift_table(all, found), HasSubstr("(+0.500)"));
}

TEST(Drifts, PutWhatMovedByLessThanItsSigmaLast) {
  std::vector<AcceptedParameters> all = {calibration(1, 3, 2e-3)};
  Eigen::VectorXd xi = values(*all[0].robot);
  xi[5] += 1e-3;
  all[0].robot = robot_of(robot_text(*all[0].robot, xi), "moved").value();
  const auto& parameters = all[0].robot->parameters();
  all[0].sigma = {{parameters[3].name, 25e-3}, {parameters[5].name, 1e-5}};

  const std::vector<Drift> found = drifts(all, 10);

  ASSERT_EQ(found.size(), 2);
  EXPECT_EQ(found[0].name, full_name(parameters[5]));
  EXPECT_EQ(found[0].sigma[0], 1e-5);
  EXPECT_THAT(drift_table(all, found), HasSubstr("   25.000"));
}

TEST(Drifts, OfOneCalibrationAreThoseFromTheFactory) {
  const std::vector<Drift> found = drifts({calibration(1, 3, 2e-3)}, 10);
  ASSERT_EQ(found.size(), 1);
  EXPECT_NEAR(found[0].since_factory[0], 2e-3, 1e-15);  // rounding of a value of 1
  EXPECT_TRUE(drifts({}, 10).empty());
}

TEST(DriftTable, HasAPrefixThatACompoundUnitsFiguresNeed) {
  const Drift compliance{.name = "j2.c",
                         .unit = "rad/(N m)",
                         .since_factory = {2.5e-7},
                         .since_last = {2.5e-7},
                         .sigma = {1e-8}};
  const std::string table = drift_table({calibration(1, 3, 2e-3)}, {compliance});
  EXPECT_THAT(table, HasSubstr("nrad/(N m)"));
  EXPECT_THAT(table, HasSubstr("+250.000"));
  EXPECT_THAT(table, HasSubstr("10.000"));
}

TEST(HistoryPage, TellsWhenAParameterLeavesItsLimitAtThisRate) {
  HistoryFindings findings;
  for (int session = 1; session <= 3; ++session)
    findings.calibrations.push_back(calibration(session, 3, 0.5e-3 + 0.5e-3 * session));
  findings.unix_ms = kFirst + 4 * kDay;
  const double limit = 3 * findings.calibrations[0].robot->parameters()[3].tolerance;

  const nlohmann::ordered_json data = history_data(findings);

  const nlohmann::ordered_json& drift = data["drifts"][0];
  EXPECT_EQ(data["drifts"].size(), 1);
  EXPECT_EQ(drift["limit"], limit);
  EXPECT_TRUE(drift["sigma"][0].is_null());            // no result.json is kept
  EXPECT_NEAR(drift["trend"]["rate"], 0.5e-3, 1e-12);  // m a day; rounding of values of 1
  EXPECT_NEAR(drift["trend"]["leaves_in_days"], (limit - 2.5e-3) / 0.5e-3, 1e-4);
  EXPECT_THAT(data["verdict"]["sentence"].get<std::string>(), HasSubstr("leaves its limit in 295"));
}

TEST(HistoryPage, TellsFirstWhatIsBeyondItsLimit) {
  HistoryFindings findings;
  const double limit = 3 * calibration(1, 3, 0).robot->parameters()[3].tolerance;
  for (int session = 1; session <= 3; ++session)
    findings.calibrations.push_back(calibration(session, 3, limit + 1e-3 * session));
  findings.unix_ms = kFirst + 4 * kDay;
  EXPECT_THAT(history_data(findings)["verdict"]["sentence"].get<std::string>(),
              HasSubstr("is beyond the limit now"));
}

TEST(HistoryPage, GivesAQuickCheckItsIntervalByItsTouches) {
  HistoryFindings findings;
  findings.sessions.resize(1);
  findings.sessions[0].session.kind = "check";
  findings.sessions[0].result = ResultRecord{};
  findings.sessions[0].result->touches = 12;
  findings.sessions[0].result->check_after = 1e-4;

  const nlohmann::ordered_json point = history_data(findings)["residual"]["points"][0];

  // chi2 of 12 freedoms: 23.337 at 97.5 %, 4.404 at 2.5 % (tables, four digits).
  EXPECT_NEAR(point["least"], 1e-4 * std::sqrt(12 / 23.337), 1e-9);
  EXPECT_NEAR(point["most"], 1e-4 * std::sqrt(12 / 4.404), 1e-8);
}

class History : public ::testing::Test {
 protected:
  History()
      : folder_(std::filesystem::path(testing::TempDir()) /
                (std::string("history_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(folder_);
    store_ = std::move(Store::open(folder_).value().store);
  }

  std::int64_t begin(const std::string& kind) {
    SessionRecord session;
    session.kind = kind;
    session.reason = "by command";
    session.model_hash = "none";
    session.config = "target: 0.001\ndelay: 0\nsets: {}\n";
    session.started_ms = kFirst;
    return store_->begin(session, {StepRecord{}}).value();
  }
  /// A full session whose result is applied, with parameter 3 moved.
  std::int64_t accepted(double change) {
    ResultRecord result;
    result.session = begin("full");
    result.unix_ms = kFirst + result.session * kDay;
    result.answer = ResultAnswer::improved;
    result.decision = ResultDecision::candidate;
    result.check_before = 1.92e-3;
    result.check_after = 0.0228e-3;
    result.identified = 21;
    const auto robot = moved(3, change);
    result.robot_text = robot_text(*robot, values(*robot));
    const SlotRecord slot{result.session, result.unix_ms, "none", result.robot_text};
    EXPECT_TRUE(store_->finish(result, &slot));
    EXPECT_TRUE(store_->accept(result.unix_ms));
    return result.session;
  }
  Ran history(const std::string& arguments) const {
    return run_selfcal("history " + folder_.string() + " " + arguments);
  }

  std::filesystem::path folder_;
  std::unique_ptr<Store> store_;
};

TEST_F(History, TellsOfResultsNewestFirstWithDriftAndSlots) {
  accepted(2e-3);
  accepted(2.5e-3);
  ASSERT_TRUE(store_->set_state(begin("check"), SessionState::aborted, kFirst));

  const Ran ran = history("");

  EXPECT_EQ(ran.status, 0) << ran.out;
  const auto third = ran.out.find("      3  "), second = ran.out.find("      2  "),
             first = ran.out.find("      1  ");
  EXPECT_LT(third, second);
  EXPECT_LT(second, first);
  EXPECT_THAT(ran.out, HasSubstr("aborted         by command"));
  EXPECT_THAT(ran.out, HasSubstr("improved        applied          1.92   0.0228"));
  EXPECT_THAT(ran.out, HasSubstr("+2.500  (+0.500)"));
  EXPECT_THAT(ran.out, HasSubstr("active     session 2"));
  EXPECT_THAT(ran.out, HasSubstr("previous   session 1"));
  EXPECT_THAT(ran.out, HasSubstr("candidate  none"));
}

TEST_F(History, KeepsItsColumnsBesideAResultThatWasRolledBack) {
  accepted(2e-3);
  accepted(2.5e-3);
  ASSERT_TRUE(store_->roll_back(kFirst));

  const std::string out = history("").out;

  const auto column = [&](const std::string& line) {
    const std::size_t at = out.find(line);
    return at == std::string::npos ? at : out.find("0.0228", at) - at;
  };
  EXPECT_THAT(out, HasSubstr("rolled-back"));
  EXPECT_EQ(column("      2  2026"), column("      1  2026")) << out;
}

TEST_F(History, PrintsRecordsAndEventsInJson) {
  accepted(2e-3);
  begin("check");
  ASSERT_TRUE(store_->add(EventRecord{0, kFirst, "warning", "trigger stuck"}));

  const auto records = nlohmann::json::parse(history("--json").out);
  ASSERT_EQ(records.size(), 2);
  EXPECT_EQ(records[0]["state"], "unfinished");
  EXPECT_TRUE(records[0]["result"].is_null());
  EXPECT_EQ(records[1]["result"]["check_before"], 1.92e-3);
  EXPECT_EQ(nlohmann::json::parse(history("--json --newest 1").out).size(), 1);
  EXPECT_EQ(nlohmann::json::parse(history("--events --json").out)[0]["text"], "trigger stuck");
  EXPECT_THAT(history("--events").out, HasSubstr("warning  trigger stuck"));
}

TEST_F(History, GivesNoFiguresOfAResultThatFailed) {
  ResultRecord result;
  result.session = begin("full");
  result.answer = ResultAnswer::failed;
  result.decision = ResultDecision::rejected;
  result.touches = 40;
  ASSERT_TRUE(store_->finish(result, nullptr));

  const auto record = nlohmann::json::parse(history("--json").out)[0]["result"];
  for (const char* figure : {"p_value", "check_before", "check_after", "endpoint_sigma"})
    EXPECT_TRUE(record[figure].is_null()) << figure << " " << record[figure];
  EXPECT_EQ(record["touches"], 40);
}

TEST_F(History, WritesAPage) {
  accepted(2e-3);
  const std::string page = (folder_ / "history.html").string();

  EXPECT_EQ(history("--report " + page).status, 0);
  EXPECT_EQ(history("--json --report " + page).status, 2);

  EXPECT_THAT(read_file(page, 2'000'000).value(), HasSubstr("1 accepted calibration so far"));
  const Ran unknown = run_selfcal("report 9 " + folder_.string());
  EXPECT_NE(unknown.status, 0);
  EXPECT_THAT(unknown.out, HasSubstr("9"));
}

TEST_F(History, HasNoPageOfACheckWhoseTouchesAreTooFewToCalibrateBy) {
  accepted(2e-3);
  begin("check");
  const std::string page = (folder_ / "check.html").string();

  const Ran ran = run_selfcal("report 2 " + folder_.string() + " --out " + page);

  EXPECT_EQ(ran.status, 3);
  EXPECT_THAT(ran.out, HasSubstr("session 2 is a quick check"));
  EXPECT_FALSE(std::filesystem::exists(page));
}

TEST_F(History, SaysWhichSessionsThereAreWhereOneIsNot) {
  const auto report = [&] {
    return run_selfcal("report 9 " + folder_.string() + " --out " + (folder_ / "9.html").string());
  };
  const Ran none = report();
  EXPECT_EQ(none.status, 3);
  EXPECT_THAT(none.out, HasSubstr("there is no session 9: it has none yet\n"));

  for (int session = 0; session < 3; ++session) begin("full");
  const Ran some = report();
  EXPECT_EQ(some.status, 3);
  EXPECT_THAT(some.out, HasSubstr("there is no session 9: it has sessions 1 to 3\n"));
}

TEST_F(History, SaysThatThereIsNoSession) {
  const Ran ran = history("");
  EXPECT_EQ(ran.status, 0);
  EXPECT_THAT(ran.out, HasSubstr("No session yet."));
  EXPECT_THAT(ran.out, HasSubstr("active     the factory's"));
  EXPECT_THAT(ran.out, HasSubstr("previous   none"));
}

TEST_F(History, RefusesWhatCannotBeExported) {
  accepted(2e-3);
  const std::string out = (folder_ / "out").string();
  EXPECT_EQ(history("--export x " + out).status, 2);
  EXPECT_EQ(history("--export 1").status, 2);
  const Ran unknown = history("--export 7 " + out);
  EXPECT_EQ(unknown.status, 3);
  EXPECT_THAT(unknown.out, HasSubstr("there is no session 7: it has session 1\n"));
  const Ran empty = history("--export 1 " + out);
  EXPECT_EQ(empty.status, 3);
  EXPECT_THAT(empty.out, HasSubstr("has no rows"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(History, NamesTheStoreThatIsNotThere) {
  const Ran ran = run_selfcal("history " + (folder_ / "nowhere").string());
  EXPECT_EQ(ran.status, 3);
  EXPECT_THAT(ran.out, HasSubstr("nowhere"));
}

}  // namespace
}  // namespace selfcal
