// Configurations visited under a lock: which are put aside, and what each engagement makes.
#include <gmock/gmock.h>

#include "app/service/session/session.h"
#include "app/service/session/session_rows.h"
#include "app/service/session/touch_decision.h"
#include "tests/service/cell.h"

namespace selfcal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<EncoderScale> kLegScales(6, EncoderScale{1e-6, 0});

Config lock_config() {
  const auto config = load_text(
      "robot: " + example("stewart.robot.yaml").string() +
      "\nmotion: {home: [0.8, 0.8, 0.8, 0.8, 0.8, 0.8]}\nsets:\n"
      "  a: {method: locked-joint, lock: {leg: 1, joint: universal}, noise: 2.0e-5, touches: 6}\n");
  EXPECT_TRUE(config) << config.error().what;
  return *config;
}

Reading legs(std::initializer_list<double> lengths) {
  Reading reading;
  reading.q = Eigen::Map<const Eigen::VectorXd>(lengths.begin(), 6);
  reading.dq = Eigen::VectorXd::Zero(6);
  return reading;
}

TEST(RuleOnVisit, TakesLegsThatMeetWithinTheirRanges) {
  EXPECT_EQ(decide_on_visit(*lock_config().robot, legs({0.8, 0.8, 0.8, 0.8, 0.8, 0.8})).outcome,
            TouchOutcome::taken);
}

TEST(RuleOnVisit, PutsALegOutOfItsRangeAsideByName) {
  const TouchDecision decided =
      decide_on_visit(*lock_config().robot, legs({0.8, 0.8, 1.2, 0.8, 0.8, 0.8}));
  EXPECT_EQ(decided.outcome, TouchOutcome::outlier);
  EXPECT_THAT(decided.why, HasSubstr("leg3 reads 1.2, out of its range"));
}

TEST(RuleOnVisit, PutsLegsThatDoNotMeetAside) {
  // Neighbours on one end of the platform half a metre apart in length: it has no such position.
  const TouchDecision decided =
      decide_on_visit(*lock_config().robot, legs({0.56, 1.14, 0.56, 1.14, 0.56, 1.14}));
  EXPECT_EQ(decided.outcome, TouchOutcome::outlier);
  EXPECT_THAT(decided.why, HasSubstr("the assembly mode is lost"));
}

/// Touches of a plane above the platform by its probe.
struct ProbedPlatform {
  Config config;
  Decoding decoding;
  Session session;

  ProbedPlatform() {
    const auto loaded = load_text(
        "robot: " + example("stewart.robot.yaml").string() +
        "\nmotion: {home: [0.8, 0.8, 0.8, 0.8, 0.8, 0.8]}\nsets:\n"
        "  top: {method: plane, noise: 2.0e-5, surface: {point: [0, 0, 0.95], normal: [0, 0, -1]}, "
        "within: {center: [0, 0, 0.95], radius: 0.15}}\n");
    EXPECT_TRUE(loaded) << loaded.error().what;
    config = *loaded;
    decoding = *read_decoding(decoding_text(config, kLegScales));
    session.record.kind = "full";
    StepRecord step;
    step.set = "top";
    step.touch.assign(6, 0.9);
    session.plan = {step};
  }
  TouchDecision rule(std::initializer_list<double> lengths) const {
    return decide_on_touch(*config.robot, session, decoding, session.plan[0], legs(lengths), 0.012,
                           1e-4);
  }
};

TEST(RuleOnTouchOfAPlatform, TakesItWhereItsLegsMeet) {
  EXPECT_EQ(ProbedPlatform().rule({0.9, 0.9, 0.9, 0.9, 0.9, 0.9}).outcome, TouchOutcome::taken);
}

TEST(RuleOnTouchOfAPlatform, NamesALegOutOfItsRange) {
  const TouchDecision decided = ProbedPlatform().rule({0.9, 0.9, 1.2000001, 0.9, 0.9, 0.9});
  EXPECT_EQ(decided.outcome, TouchOutcome::outlier);
  EXPECT_EQ(decided.why, "leg3 reads 1.2, out of its range");
}

TEST(RuleOnTouchOfAPlatform, NamesALostAssemblyModeAndNoPlaceOfTheEndpoint) {
  // The platform's origin, where no location is, lies far before the plane.
  const TouchDecision decided = ProbedPlatform().rule({0.56, 1.14, 0.56, 1.14, 0.56, 1.14});
  EXPECT_EQ(decided.outcome, TouchOutcome::outlier);
  EXPECT_THAT(decided.why, HasSubstr("the assembly mode is lost: no location of the platform"));
}

TEST(RowsOfAPlatform, AddNoNoiseForASpeedThatNobodyKnows) {
  ProbedPlatform cell;
  TouchRecord touch;
  touch.outcome = TouchOutcome::taken;
  touch.edge = kSecond;
  touch.before.time = kSecond - 10 * kMillisecond;
  touch.after.time = kSecond + 10 * kMillisecond;
  touch.before.joints = touch.after.joints = 6;
  for (int leg = 0; leg < 6; ++leg) {
    touch.before.counts[leg] = leg % 2 == 0 ? 560000 : 1140000;
    touch.after.counts[leg] = touch.before.counts[leg] + 1000;
  }
  cell.session.touches = {touch};
  const DataSet data = rows_of(*cell.config.robot, cell.session, cell.decoding);
  EXPECT_EQ(data.rows.factor(0), 1);
}

/// Visits of one lock; `engaged`: the moment of the engagement of each (s).
Session visits(const std::vector<int>& engaged) {
  Session session;
  session.record.kind = "full";
  for (int i = 0; i < static_cast<int>(engaged.size()); ++i) {
    StepRecord step;
    step.index = i;
    step.set = "a";
    step.touch.assign(6, 0.8);
    session.plan.push_back(step);
    TouchRecord visit;
    visit.step = i;
    visit.outcome = TouchOutcome::taken;
    visit.edge = engaged[i] * kSecond;
    visit.before.time = visit.after.time = (100 + i) * kSecond;
    visit.before.joints = visit.after.joints = 6;
    visit.before.counts.fill(800000);
    visit.after.counts = visit.before.counts;
    session.touches.push_back(visit);
  }
  return session;
}

DataSet rows_of_visits(const Session& session) {
  const Config config = lock_config();
  const auto decoding = read_decoding(decoding_text(config, kLegScales));
  EXPECT_TRUE(decoding) << decoding.error().what;
  EXPECT_EQ(steps_of_rows(session, *decoding).size(),
            static_cast<std::size_t>(rows_of(*config.robot, session, *decoding).rows.rows()));
  return rows_of(*config.robot, session, *decoding);
}

TEST(RowsOfVisits, GiveEachEngagementASetOfItsOwn) {
  const DataSet data = rows_of_visits(visits({1, 1, 1, 1, 50, 50, 50, 50}));
  ASSERT_EQ(data.sets.size(), 2u);
  EXPECT_EQ(data.sets[1].name, "a-2");
  EXPECT_THAT(data.rows.set, ElementsAre(0, 0, 0, 0, 1, 1, 1, 1));
  EXPECT_EQ(data.rows.time[7] - data.rows.time[0], 7);
}

TEST(RowsOfVisits, LeaveOutAnEngagementThatTellsNothing) {
  const DataSet data = rows_of_visits(visits({1, 50, 50, 50, 50}));
  EXPECT_EQ(data.sets.size(), 1u);
  EXPECT_THAT(data.rows.set, ElementsAre(0, 0, 0, 0));
}

}  // namespace
}  // namespace selfcal
