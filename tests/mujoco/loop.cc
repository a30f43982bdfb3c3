// The gap between a machine and the user's own simulator, closed in the simulator: makers' arms in
// MuJoCo, whose machine is the same model with changes that nobody tells, and real robots with
// models made of their robot files.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <sstream>

#include "io/models/mujoco.h"
#include "kinematics/description.h"
#include "tests/io/scratch.h"
#include "tests/mujoco/arm.h"
#include "tests/mujoco/public_arms.h"
#include "tests/shared_data.h"
#include "tests/support/program.h"
#include "tests/support/text.h"

namespace selfcal::mujoco {
namespace {

using testing::HasSubstr;

constexpr int kLoopRows = 150;
constexpr double kLoopNoise = 20e-6;  // m, of a coordinate

/// What `diagnose --sim` says of a model, in mm.
struct LoopFigures {
  double before = NAN, after = NAN, noise = NAN;
};

LoopFigures loop_figures(const std::string& text) {
  const auto after = [&](const std::string& words, std::size_t from) {
    const auto at = text.find(words, from);
    return at == std::string::npos ? NAN : std::strtod(text.c_str() + at + words.size(), nullptr);
  };
  const auto first = text.find("Against ");
  if (first == std::string::npos) return {};
  return {after(": ", first), after("run again, ", first), after(" mm, of which ", first)};
}

void print_loop(const std::string& name, const LoopFigures& figures) {
  std::printf("%s: %.3g mm before, %.3g mm mended, of which %.3g mm are noise\n", name.c_str(),
              figures.before, figures.after, figures.noise);
}

/// Rows of the machine `hidden` at random readings, three in ten to judge by.
void write_rows(const Scratch& scratch, const PublicArm& arm, const std::string& hidden,
                unsigned seed) {
  Random random(seed);
  std::vector<MujocoLoad> loads;
  for (int i = 0; i < kLoopRows; ++i) {
    MujocoLoad load{Eigen::VectorXd(static_cast<Eigen::Index>(arm.bodies.size()))};
    for (std::size_t j = 0; j < arm.bodies.size(); ++j)
      load.q[static_cast<Eigen::Index>(j)] =
          uniform(random, 0.9 * arm.bodies[j].lower, 0.9 * arm.bodies[j].upper);
    loads.push_back(std::move(load));
  }
  const auto poses = settled_poses(scratch.write("machine.xml", hidden), "tool", loads);
  ASSERT_TRUE(poses) << poses.error().what;
  std::string csv = "set,part,";
  for (std::size_t j = 0; j < arm.bodies.size(); ++j) csv += "q" + std::to_string(j + 1) + ",";
  csv += "x,y,z\n";
  for (std::size_t i = 0; i < loads.size(); ++i) {
    ASSERT_TRUE(poses->tool[i]);
    csv += i % 10 < 7 ? "tracker,fit" : "tracker,check";
    for (const double q : loads[i].q) csv += "," + format_number(q);
    for (const double x : poses->tool[i]->p)
      csv += "," + format_number(x + kLoopNoise * normal(random));
    csv += "\n";
  }
  scratch.write("observations.csv", csv);
  scratch.write("dataset.yaml",
                "robot: arm.robot.yaml\nobservations: observations.csv\n"
                "sets: {tracker: {method: position, noise: 2.0e-5}}\n");
}

struct LoopCase {
  int arm;
  Hidden hidden;
  const char* lacks;
};

class SimulatorLoop : public testing::TestWithParam<LoopCase> {};

TEST_P(SimulatorLoop, IsClosedInTheUsersOwnModel) {
  const PublicArm arm = public_arms()[static_cast<std::size_t>(GetParam().arm)];
  const Scratch scratch;
  const std::string folder = scratch.folder().string() + "/";
  const std::string model = mjcf(arm);
  scratch.write(arm.name + ".xml", model);
  const Ran converted =
      run_selfcal("robot convert " + folder + arm.name + ".xml --out " + folder + "arm.robot.yaml");
  ASSERT_EQ(converted.status, 0) << converted.out;
  write_rows(scratch, arm, mjcf(arm, GetParam().hidden, 7), 8);
  const Ran ran = run_selfcal("diagnose " + folder + " --sim " + folder + arm.name + ".xml --out " +
                              folder + "why");
  const LoopFigures figures = loop_figures(ran.out);
  print_loop(arm.name, figures);
  EXPECT_THAT(ran.out, HasSubstr("its position actuators let the tool sag by"));
  EXPECT_THAT(ran.out, HasSubstr(GetParam().lacks));
  EXPECT_GT(figures.before, 1) << ran.out;
  // The noise of three coordinates is 35 um; a fit of some 40 parameters to 315 numbers adds a
  // sixteenth, 45 rows tell their rms to a tenth.
  EXPECT_LT(figures.after, 0.045) << ran.out;

  // The file that is written is the user's own, mended, and as near when it is asked in its turn.
  const Ran mended =
      run_selfcal("robot convert " + folder + "why/corrected.robot.yaml --to mjcf " + "--like " +
                  folder + arm.name + ".xml --out " + folder + "mended.xml");
  ASSERT_EQ(mended.status, 0) << mended.out;
  EXPECT_THAT(text_of(scratch.folder() / "mended.xml"), HasSubstr("<position joint="));
  const Ran again = run_selfcal("diagnose " + folder + " --sim " + folder + "mended.xml", true);
  EXPECT_LT(loop_figures(again.out).before, 0.045) << again.out;
}

const LoopCase kLoopCases[] = {
    {0,
     {0.5e-3, 0.5e-3, 3e-3, "shoulder_lift", 3e-6, 0},
     "its simulation lacks: "},  // a shoulder that bends looks the same
    {1,
     {0.3e-3, 0.3e-3, 3e-3, "joint2", 4e-6, 3},
     "its simulation lacks: joint compliance at joint2"},
    {2,
     {0.3e-3, 0.3e-3, 3e-3, "joint2", 1e-5, 2},
     "its simulation lacks: joint compliance at joint2"},
};

INSTANTIATE_TEST_SUITE_P(Of, SimulatorLoop, testing::ValuesIn(kLoopCases), [](const auto& tested) {
  return public_arms()[static_cast<std::size_t>(tested.param.arm)].name;
});

/// A real robot before an instrument, and the model that its own file makes.
struct RealLoop {
  const char* set;
  int each;  ///< of its rows that are taken
};

class RealSimulatorLoop : public testing::TestWithParam<RealLoop> {};

TEST_P(RealSimulatorLoop, IsCloserThanItWas) {
  SELFCAL_NEED_SHARED();
  const auto real = shared_dir() / "data" / GetParam().set;
  const Scratch scratch;
  const std::string folder = scratch.folder().string() + "/";
  scratch.write("robot.yaml", text_of(real / "robot.yaml"));
  scratch.write("dataset.yaml", text_of(real / "dataset.yaml"));
  std::istringstream lines(text_of(real / "observations.csv"));
  std::string kept, line;
  for (int row = 0; std::getline(lines, line); ++row)
    if (row == 0 || row % GetParam().each == 0) kept += line + "\n";
  scratch.write("observations.csv", kept);
  const Ran made =
      run_selfcal("robot convert " + folder + "robot.yaml --to mjcf --out " + folder + "model.xml");
  ASSERT_EQ(made.status, 0) << made.out;
  const Ran ran =
      run_selfcal("diagnose " + folder + " --sim " + folder + "model.xml --out " + folder + "why");
  const LoopFigures figures = loop_figures(ran.out);
  print_loop(GetParam().set, figures);
  // Geometry alone, which any model carries, takes half of these robots' gaps.
  EXPECT_LT(figures.after, 0.6 * figures.before) << ran.out;
  EXPECT_GT(figures.after, figures.noise) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("the mended model lacks: ")) << ran.out;
}

INSTANTIATE_TEST_SUITE_P(Of, RealSimulatorLoop,
                         testing::Values(RealLoop{"motoman-tracker", 1},
                                         RealLoop{"ipa-ur10-random", 7}),
                         [](const auto& tested) {
                           std::string name = tested.param.set;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace selfcal::mujoco
