// `selfcal compensate` as its user runs it: commands, refusals, what a controller takes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <random>
#include <sstream>

#include "io/files/robot_file.h"
#include "kinematics/robot.h"
#include "tests/support/domain.h"
#include "tests/support/program.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

const std::string kExamples = SELFCAL_SOURCE_DIR "/app/examples/";

/// With the first joint turned so far.
Eigen::VectorXd bent(double turn) {
  return (Eigen::VectorXd(6) << turn, -0.6, 0.9, 0.2, 1.2, 0.1).finished();
}

class CompensateProgram : public testing::Test {
 protected:
  CompensateProgram() : nominal_(must(load_robot(kExamples + "rx90.robot.yaml"))) {
    folder_ = std::filesystem::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    Eigen::VectorXd xi = values(*nominal_);
    for (std::size_t i = 0; i < nominal_->parameters().size(); ++i)
      if (nominal_->parameters()[i].free) xi[static_cast<Eigen::Index>(i)] += 1e-3 * normal(random);
    const std::string text = robot_text(*nominal_, xi);
    calibrated_ = must(robot_of(text, "calibrated"));
    std::ofstream(at("calibrated.robot.yaml")) << text;
  }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }

  /// A row for the maker's robot at `q`, `away` metres along x, with the readings to stay near.
  std::string pose(const Eigen::VectorXd& q, double away = 0) {
    Location X = locate(*nominal_, values(*nominal_), q);
    X.p.x() += away;
    wanted_.push_back(X);
    const Eigen::Quaterniond turn(X.R);
    std::ostringstream row;
    row << std::setprecision(17) << X.p.x() << ',' << X.p.y() << ',' << X.p.z() << ',' << turn.w()
        << ',' << turn.x() << ',' << turn.y() << ',' << turn.z();
    for (const double each : q) row << ',' << each;
    return row.str() + "\n";
  }
  void write_poses_at(const std::vector<double>& turns) {
    std::string rows;
    for (const double each : turns) rows += pose(bent(each));
    write_poses(rows);
  }
  void write_poses(const std::string& rows) {
    std::ofstream(at("poses.csv")) << "x,y,z,qw,qx,qy,qz,q1,q2,q3,q4,q5,q6\n" << rows;
  }
  Ran compensate(const std::string& more = {}) {
    return run_selfcal("compensate " + at("calibrated.robot.yaml") + " --nominal " + kExamples +
                       "rx90.robot.yaml " + at("poses.csv") + " --out " + at("joints.csv") + more);
  }
  /// The cells of each row of the answer.
  std::vector<std::vector<std::string>> answer() const {
    std::vector<std::vector<std::string>> rows;
    std::istringstream text(text_of(at("joints.csv")));
    for (std::string line; std::getline(text, line);) {
      std::vector<std::string> cells(1);
      for (const char each : line)
        if (each == ',')
          cells.emplace_back();
        else
          cells.back() += each;
      rows.push_back(cells);
    }
    return rows;
  }

  std::filesystem::path folder_;
  std::shared_ptr<const Robot> nominal_, calibrated_;
  std::vector<Location> wanted_;
};

TEST_F(CompensateProgram, AsksWhetherPosesThatNoRobotReachesAreInMillimetres) {
  write_poses_at({0, 0.4});
  EXPECT_THAT(compensate().out, testing::Not(HasSubstr("millimetres?")));
  wanted_[1].p *= 500;  // as far as a file may say
  std::string text = "x,y,z,qw,qx,qy,qz\n";
  for (const Location& each : wanted_)
    text += format_number(each.p.x()) + "," + format_number(each.p.y()) + "," +
            format_number(each.p.z()) + ",1,0,0,0\n";
  std::ofstream(at("poses.csv")) << text;
  const Ran ran = compensate();
  EXPECT_EQ(ran.status, 1) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("poses.csv: pose 2 is "));
  EXPECT_THAT(ran.out, HasSubstr("are these millimetres?"));
}

TEST_F(CompensateProgram, WritesCommandsThatPutTheCalibratedRobotThere) {
  write_poses_at({0, 0.4, -0.7});
  const Ran ran = compensate();
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("3 of 3 poses: reached"));
  EXPECT_THAT(ran.out, HasSubstr("those reached are left 0 um and 0 urad off at most"));
  EXPECT_THAT(ran.out, HasSubstr("a controller that takes parameters in place of these commands "
                                 "is off by "));
  const auto rows = answer();
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0],
            (std::vector<std::string>{"x", "y", "z", "qw", "qx", "qy", "qz", "q1", "q2", "q3", "q4",
                                      "q5", "q6", "iterations", "error", "error_angle", "status"}));
  for (std::size_t row = 1; row < rows.size(); ++row) {
    Eigen::VectorXd q(6);
    for (std::size_t j = 0; j < 6; ++j)
      q[static_cast<Eigen::Index>(j)] = std::stod(rows[row][7 + j]);
    const Location is = locate(*calibrated_, values(*calibrated_), q);
    EXPECT_LT((is.p - wanted_[row - 1].p).norm(), 1e-6);
    EXPECT_LT((is.R - wanted_[row - 1].R).norm(), 1e-6);
    EXPECT_GT((q - bent(0)).norm() + (q - bent(0.4)).norm(), 1e-4) << "not the maker's own";
    EXPECT_GE(std::stoi(rows[row][13]), 1);
    EXPECT_EQ(rows[row].back(), "reached");
  }
}

TEST_F(CompensateProgram, ReadsPosesBetweenSemicolonsWithDecimalCommas) {
  write_poses_at({0, 0.4});
  ASSERT_EQ(compensate().status, 0);
  const auto between_commas = answer();
  std::string text = text_of(at("poses.csv"));
  std::ranges::replace(text, ',', ';');
  std::ranges::replace(text, '.', ',');
  std::ofstream(at("poses.csv")) << text;
  const Ran ran = compensate();
  ASSERT_EQ(ran.status, 0) << ran.out;
  EXPECT_EQ(answer(), between_commas);
}

TEST_F(CompensateProgram, SaysThatTheMakersRobotNeedsNoCompensation) {
  write_poses_at({0});
  std::ofstream(at("calibrated.robot.yaml")) << text_of(kExamples + "rx90.robot.yaml");
  const Ran ran = compensate();
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("is the nominal robot itself: there is nothing to compensate"));
}

TEST_F(CompensateProgram, NamesAPoseThatIsOutOfReachAndGivesNoCommandForIt) {
  const std::string there = pose(bent(0)), beyond = pose(bent(0), 5);
  write_poses(there + beyond);
  const Ran ran = compensate();
  EXPECT_EQ(ran.status, 1) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("1 of 2 poses: reached"));
  const auto rows = answer();
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1].back(), "reached");
  EXPECT_EQ(rows[2].back(), "out-of-reach");
  EXPECT_EQ(rows[2][7], "");
}

TEST_F(CompensateProgram, RefusesTheCalibrationOfAnotherRobotAndPosesThatAreNone) {
  write_poses(pose(bent(0)));
  const Ran other = run_selfcal("compensate " + at("calibrated.robot.yaml") + " --nominal " +
                                kExamples + "irb1600.robot.yaml " + at("poses.csv"));
  EXPECT_EQ(other.status, 3);
  EXPECT_THAT(other.out, HasSubstr("is no calibration of the robot in"));
  write_poses("0.5,0,0.5,2,0,0,0,0,0,0,0,0,0\n");
  const Ran turned = compensate();
  EXPECT_EQ(turned.status, 3);
  EXPECT_THAT(turned.out, HasSubstr("poses.csv"));
  EXPECT_FALSE(std::filesystem::exists(at("joints.csv")));
  write_poses("0.5,0,0.5,1,0,0,0,0,0,0,0,0,90\n");
  EXPECT_THAT(compensate().out, HasSubstr("row 1: column q6: 90 is more than four turns (degrees"));
  EXPECT_EQ(compensate(" --payload-centre 0 0 0.1").status, 2) << "a centre of no payload";
}

TEST_F(CompensateProgram, GivesAControllerWhatItCanTakeAlone) {
  write_poses_at({0, 0.4, -0.7, 1.1});
  const Ran ran = compensate(" --controller " + at("controller.robot.yaml"));
  EXPECT_EQ(ran.status, 0) << ran.out;
  const auto controller = must(load_robot(at("controller.robot.yaml")));
  int taken = 0;
  for (std::size_t i = 0; i < nominal_->parameters().size(); ++i) {
    const Parameter& each = nominal_->parameters()[i];
    const auto k = static_cast<Eigen::Index>(i);
    const double maker = values(*nominal_)[k], now = values(*controller)[k];
    taken += now != maker;
    // Parallel and square axes are so in any controller, but those of base and tool.
    if (each.part == Part::link && each.name.starts_with("alpha") &&
        std::abs(std::remainder(maker, M_PI / 2)) < 1e-9) {
      EXPECT_EQ(now, maker) << each.name;
    }
  }
  EXPECT_GT(taken, 6);
}

}  // namespace
}  // namespace selfcal
