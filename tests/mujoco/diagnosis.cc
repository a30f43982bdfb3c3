// The diagnosis on touches that MuJoCo simulates: of an arm whose joints are rigid, of one whose
// second joint gives way, and of one whose second and third do. Nothing that made these rows is
// the product's.
#include "diagnosis/diagnosis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "io/files/data_set_file.h"
#include "tests/io/scratch.h"
#include "tests/mujoco/session.h"

namespace selfcal::mujoco {
namespace {

constexpr unsigned kSessions = 4;  // of each kind
// rad/(N m), of a spring of 2e5 N m/rad: 1 mrad under the stretched arm, of which calibration
// leaves 2 to 5 times the noise.
constexpr double kTrueCompliance = 5e-6;

struct Tally {
  int right = 0, weighed = 0, as_stiff = 0;  ///< compliances that were identified; rightly
};

bool holds(const std::vector<std::string>& list, const std::string& what) {
  return std::find(list.begin(), list.end(), what) != list.end();
}

/// The joint's compliance, or an answer that says it cannot be told from that. Where gravity alone
/// loads the arm, the link that carries a joint bends about its axis as the joint does.
bool stands_for(const CauseResult& cause, const std::string& joint) {
  return (cause.effect == "joint_compliance" && holds(cause.where, joint)) ||
         holds(cause.confounded_with, "joint_compliance@" + joint);
}

/// What the diagnosis names: its verdict, and beside it what is more probable than not.
std::vector<CauseResult> named(const Diagnosis& diagnosis) {
  std::vector<CauseResult> list = {diagnosis.verdict};
  for (const CauseResult& each : diagnosis.candidates)
    if (each.probability > 0.5 && each.effect != "none" && each.effect != "unknown")
      list.push_back(each);
  return list;
}

bool right(const Diagnosis& diagnosis, const std::vector<std::string>& joints) {
  if (joints.empty()) return diagnosis.verdict.effect == "none";
  const auto is_one = [&](const CauseResult& cause) {
    return std::any_of(joints.begin(), joints.end(),
                       [&](const std::string& joint) { return stands_for(cause, joint); });
  };
  const std::vector<CauseResult> list = named(diagnosis);
  return is_one(diagnosis.verdict) &&
         std::all_of(joints.begin(), joints.end(), [&](const std::string& joint) {
           return std::any_of(list.begin(), list.end(),
                              [&](const CauseResult& cause) { return stands_for(cause, joint); });
         });
}

/// Sigma of the identified parameter, as its candidate has it.
double sigma_of(const Diagnosis& diagnosis, const std::string& name) {
  for (const CauseResult& cause : diagnosis.candidates)
    for (const NamedValue& value : cause.parameters)
      if (value.name == name) return value.sigma;
  return 0;
}

/// The model's compliances against the springs'. The file's masses are 3 % off, and so is what it
/// makes of them: 10 %, or three sigma where the rows say less.
void weigh(const Diagnosis& diagnosis, const std::vector<std::string>& joints, Tally& tally) {
  for (const std::string& joint : joints) {
    const int at = diagnosis.model ? find_parameter(*diagnosis.model, joint + ".c") : -1;
    if (at < 0) continue;
    const double c = diagnosis.values[at], sigma = sigma_of(diagnosis, joint + ".c");
    std::printf("  %s.c %.2fe-6", joint.c_str(), c * 1e6);
    ++tally.weighed;
    tally.as_stiff += std::abs(c - kTrueCompliance) <= std::max(0.1 * kTrueCompliance, 3 * sigma);
  }
}

Diagnosis diagnosed(const std::vector<std::string>& joints, unsigned seed) {
  const Scratch scratch;
  SessionOrder order;
  order.seed = seed;
  for (const std::string& joint : joints) order.compliance.emplace_back(joint, kTrueCompliance);
  const Session session = make_session(scratch.folder() / "session", order);
  std::printf("%4u %5d %9.1f", seed, session.rows, session.noise * 1e6);
  auto loaded = load_data_set(scratch.folder() / "session");
  if (!loaded) {
    ADD_FAILURE() << loaded.error().what;
    return {};
  }
  return diagnose(std::move(loaded->robot), loaded->data);
}

/// Prints the table and returns what is counted over it.
Tally ask(const std::vector<std::string>& joints, unsigned first_seed) {
  std::printf("seed  rows  noise_um  right  verdict  probability  r  closed  model\n");
  Tally tally;
  for (unsigned seed = first_seed; seed < first_seed + kSessions; ++seed) {
    const Diagnosis diagnosis = diagnosed(joints, seed);
    const CauseResult& verdict = diagnosis.verdict;
    std::string name = verdict.effect;
    for (const std::string& place : verdict.where) name += " " + place;
    const bool is_right = right(diagnosis, joints);
    tally.right += is_right;
    std::printf("  %-5s  %-24s %.3f %5.2f %6.3f", is_right ? "yes" : "no", name.c_str(),
                verdict.probability, verdict.visible,
                diagnosis.gap.closed_all.fraction.value_or(NAN));
    weigh(diagnosis, joints, tally);
    std::printf("\n");
    // Whatever is answered, it is an answer.
    EXPECT_TRUE(verdict.probability >= 0 && verdict.probability <= 1) << seed;
  }
  return tally;
}

// Of four, one may go astray: the product promises 0.97 of those that are visible as these are, and
// one false name in a hundred where there is none.
constexpr int kLeastRight = kSessions - 1;

TEST(MujocoSessions, OfARigidArmShowNone) { EXPECT_GE(ask({}, 1).right, kLeastRight); }

TEST(MujocoSessions, OfAnArmWhoseShoulderGivesWayNameItsCompliance) {
  const Tally tally = ask({"j2"}, 11);
  EXPECT_GE(tally.right, kLeastRight);
  EXPECT_GE(tally.weighed, 1);
  EXPECT_GE(tally.as_stiff, tally.weighed - 1);
}

TEST(MujocoSessions, OfAnArmWhoseShoulderAndElbowGiveWayNameBoth) {
  const Tally tally = ask({"j2", "j3"}, 21);
  EXPECT_GE(tally.right, kLeastRight);
  EXPECT_GE(tally.weighed, kSessions);
  EXPECT_GE(tally.as_stiff, tally.weighed - 1);
}

}  // namespace
}  // namespace selfcal::mujoco
