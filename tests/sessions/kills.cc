// The service dies at any instant, by SIGKILL or by a power cut that forgets what was not
// synchronised: no committed touch is lost, none is made twice, and the session ends with the same
// answer.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "app/service/session/decoding.h"
#include "io/clock.h"
#include "tests/support/cell.h"

namespace selfcal {
namespace {

using nlohmann::json;

/// What identifies a touch in the store.
using TouchKey = std::tuple<int, int, Nanoseconds>;

std::set<TouchKey> stored_touches(const Store& const_store, std::int64_t session) {
  std::set<TouchKey> keys;
  for (const TouchRecord& touch : must(const_cast<Store&>(const_store).touches(session)))
    keys.insert({touch.step, touch.attempt, touch.edge});
  return keys;
}

struct SessionAnswer {
  std::string answer, decision;
  std::map<std::string, std::pair<double, double>> identified;  ///< value and sigma by name
  std::map<int, Reading> readings;                              ///< by step of the plan
};

SessionAnswer answer_of(const ResultMessage& result, Store& store) {
  SessionAnswer answer{result.answer, result.decision, {}, {}};
  const Decoding decoding = must(read_decoding(must(store.session(1)).config));
  for (const TouchRecord& touch : must(store.touches(1)))
    answer.readings[touch.step] = reading_of(touch, decoding);
  const json solution = json::parse(result.json);
  for (const json& each : solution["parameters"])
    if (each["status"] == "identified")
      answer.identified[each["name"]] = {each["value"], each["sigma"]};
  return answer;
}

/// A new session with the same plan and noise each time: the service's state is that of a new
/// robot.
void run_to_result(Cell& cell, const std::string& preload = {}) {
  cell.start_service(preload);
  EXPECT_TRUE(cell.start_session());
  cell.until([&] { return !cell.results.empty(); });
}

void expect_same(const SessionAnswer& found, const SessionAnswer& wanted) {
  EXPECT_EQ(found.answer, wanted.answer);
  EXPECT_EQ(found.decision, wanted.decision);
  for (const auto& [name, value] : wanted.identified) {
    ASSERT_TRUE(found.identified.contains(name)) << name;
    // The same touches at other places between two samples: they weigh otherwise (service/reading).
    EXPECT_NEAR(found.identified.at(name).first, value.first, value.second) << name;
  }
  // What is read at the edge differs by the rounding of the samples around it, 1 urad each, and
  // where the arm began to stop between the two by what Reading::sigma_time says.
  ASSERT_EQ(found.readings.size(), wanted.readings.size());
  for (const auto& [step, reading] : wanted.readings) {
    ASSERT_TRUE(found.readings.contains(step)) << step;
    const Reading& again = found.readings.at(step);
    const double time = std::sqrt(3) * std::max(reading.sigma_time, again.sigma_time);
    const Eigen::ArrayXd speed = reading.dq.cwiseAbs().cwiseMax(again.dq.cwiseAbs());
    const Eigen::ArrayXd off = (again.q - reading.q).cwiseAbs();
    EXPECT_LT((off - speed * time).maxCoeff(), 2e-6) << "step " << step;
  }
}

/// Kills the service again and again until `kills` are done, over as many sessions as that takes.
void kill_at_random(bool live, const std::string& preload, int kills, std::uint64_t seed) {
  CellOptions options;
  options.touches = 14;  // few enough to be quick, enough that the answer is clear
  options.live = live;
  options.id = "undisturbed";
  SessionAnswer wanted;
  {
    Cell cell(options);
    if (live) cell.start_robot();
    run_to_result(cell, preload);
    ASSERT_FALSE(cell.results.empty());
    wanted = answer_of(cell.results.back(), *cell.store());
  }
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> instants(0.0, live ? 4.0 : 0.8);
  int done = 0, sessions = 0;
  options.id = "killed";
  while (done < kills && !testing::Test::HasFailure()) {
    Cell cell(options);
    ++sessions;
    if (live) cell.start_robot();
    cell.start_service(preload);
    EXPECT_TRUE(cell.start_session());
    cell.until([&] { return cell.touches() > 0 || !cell.results.empty(); });
    std::set<TouchKey> committed;
    while (cell.results.empty() && done < kills && !testing::Test::HasFailure()) {
      const Nanoseconds end = monotonic_now() + nanoseconds(instants(random));
      cell.until([&] { return monotonic_now() > end || !cell.results.empty(); });
      if (!cell.results.empty()) break;
      cell.kill_service();
      ++done;
      cell.listen();
      const auto store = cell.store();
      const std::set<TouchKey> now = stored_touches(*store, 1);
      for (const TouchKey& touch : committed) EXPECT_TRUE(now.contains(touch)) << "lost";
      EXPECT_GE(now.size(), cell.touches()) << "a touch that was announced is gone";
      committed = now;
      cell.start_service(preload);
    }
    cell.until([&] { return !cell.results.empty(); });
    if (cell.results.empty()) break;
    const auto store = cell.store();
    const auto plan = must(store->plan(1));
    const std::set<TouchKey> touches = stored_touches(*store, 1);
    EXPECT_EQ(touches.size(), plan.size()) << "each configuration once";
    for (const TouchKey& touch : committed) EXPECT_TRUE(touches.contains(touch)) << "lost";
    expect_same(answer_of(cell.results.back(), *store), wanted);
    EXPECT_EQ(must(store->sessions(10)).size(), 1U) << "no second session";
    EXPECT_EQ(must(store->slot(Slot::active))->session, 1);
    cell.until([&] { return cell.in_state("idle"); });
    if (live) {
      cell.kill_service();
      cell.end_robot();
      // A touch that was under way at a kill is made again, and no other.
      std::ifstream file(cell.folder / "truth.json");
      const json truth = json::parse(file);
      int again = 0;
      for (const auto& [label, visits] : truth["visits"].items()) again += visits.get<int>() - 1;
      EXPECT_EQ(truth["visits"].size(), plan.size());
      EXPECT_LE(again, done);
    }
  }
  std::printf("%d kills over %d sessions\n", done, sessions);
}

TEST(Kill, LosesNoTouchAndChangesNoAnswer) {
  kill_at_random(true, "", repetitions("SELFCAL_KILLS", 12), 1);
}

/// A start that was granted, and the service killed before its session had a plan.
TEST(Kill, LosesNoStartThatWasGranted) {
  const int kills = repetitions("SELFCAL_KILLS", 5);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> instants(0.0, 0.3);
  int planning = 0;
  for (int i = 0; i < kills && !testing::Test::HasFailure(); ++i) {
    CellOptions options;
    options.touches = 8;
    options.id = "granted";
    Cell cell(options);
    cell.start_service();
    ASSERT_TRUE(cell.start_session());
    const Nanoseconds end = monotonic_now() + nanoseconds(instants(random));
    cell.until([&] { return monotonic_now() > end; });
    cell.kill_service();
    planning += must(cell.store()->sessions(10)).empty();
    cell.start_service();
    cell.until([&] { return !cell.results.empty() && cell.in_state("idle"); });
    EXPECT_EQ(must(cell.store()->sessions(10)).size(), 1U) << "the one that was asked for";
  }
  std::printf("%d kills after a start was granted, %d of them while it was planned\n", kills,
              planning);
  EXPECT_GT(planning, 0);
}

TEST(PowerCut, LosesNoTouchAndChangesNoAnswer) {
  kill_at_random(false, SELFCAL_FORGETFUL_VFS, repetitions("SELFCAL_POWER_CUTS", 12), 2);
}

}  // namespace
}  // namespace selfcal
