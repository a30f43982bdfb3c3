// A calibrated linear delta for firmwares: by the numbers that they get, the carriages stand where
// the robot has them.
#include "io/models/delta_firmware.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <sstream>

#include "tests/io/calibrated_case.h"
#include "tests/io/urdf_case.h"

namespace selfcal {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// The number behind `word` in `text`.
double number_after(const std::string& text, const std::string& word, size_t from = 0) {
  const size_t at = text.find(word, from);
  EXPECT_NE(at, std::string::npos) << word;
  return std::stod(text.substr(at + word.size()));
}

TEST(DeltaFirmware, HasTheCarriagesWhereTheRobotHasThem) {
  const std::string text = R"(robot: d
kind: linear-delta
towers:
  - {radius: 0.105, angle: 3.667, rod: 0.2153, endstop: 0.5821, limits: [-0.35, 0]}
  - {radius: 0.105, angle: 5.7596, rod: 0.2155, endstop: 0.5825, limits: [-0.35, 0]}
  - {radius: 0.105, angle: 1.57, rod: 0.2151, endstop: 0.5818, limits: [-0.35, 0]}
)";
  Problems problems;
  const auto delta = linear_delta::read(*parse_yaml(text, "d.yaml"), problems);
  const auto made = delta_firmware(delta, delta.value, "", "d.yaml");
  ASSERT_TRUE(made);
  EXPECT_THAT(made->left_out, IsEmpty());
  const auto robot = robot_of(text, "d.yaml");
  const Eigen::Vector3d q(-0.20, -0.21, -0.19);
  const Eigen::Vector3d p = 1e3 * locate(**robot, values(**robot), q).p;
  const size_t line = made->text.find("M665");
  const double R = number_after(made->text, " R", line), H = number_after(made->text, " H", line);
  const size_t stops = made->text.find("M666"), klipper = made->text.find("# Klipper");
  std::istringstream arms(made->text.substr(made->text.find("M665 L") + 6));
  for (int t = 0; t < 3; ++t) {
    std::string arm;
    std::getline(arms, arm, t < 2 ? ':' : ' ');
    const double L = std::stod(arm);
    const std::string axis = std::string(" ") + "XYZ"[t];
    const double angle =
        (std::array{210, 330, 90}[t] + number_after(made->text, axis, line)) * M_PI / 180;
    const double root = std::sqrt(L * L - R * R);
    const Eigen::Vector3d c(R * std::cos(angle), R * std::sin(angle),
                            H + root + number_after(made->text, axis, stops) + 1e3 * q[t]);
    EXPECT_NEAR((p - c).norm(), L, 2e-4) << "written to 0.1 um";
    const size_t stepper = made->text.find(std::string("[stepper_") + "abc"[t], klipper);
    EXPECT_NEAR(number_after(made->text, "position_endstop: ", stepper) + root + 1e3 * q[t], c.z(),
                2e-4);
    EXPECT_NEAR(number_after(made->text, "arm_length: ", stepper), L, 1e-9);
  }
}

TEST(DeltaFirmware, HasNoSignAtZero) {
  Problems problems;
  const auto delta = linear_delta::read(*parse_yaml(R"(robot: d
kind: linear-delta
towers:
  - {radius: 0.105, angle: 3.66519142, rod: 0.2153, endstop: 0.5821}
  - {radius: 0.105, angle: 5.75958653, rod: 0.2153, endstop: 0.5821}
  - {radius: 0.105, angle: 1.57079632, rod: 0.2153, endstop: 0.5821}
)",
                                                    "d.yaml"),
                                        problems);
  const auto made = delta_firmware(delta, delta.value, "", "d.yaml");
  ASSERT_TRUE(made);
  EXPECT_THAT(made->text, Not(HasSubstr("-0.0000")));
}

// By Marlin's own sums (module/delta.cpp, motion.cpp): each carriage meets its endstop, backs off
// by M666, and all three then stand where the nozzle is at (0, 0, H).
TEST(DeltaFirmware, HasTheCarriagesWhereMarlinPutsThem) {
  const std::string text = R"(robot: d
kind: linear-delta
towers:
  - {radius: 0.105, angle: 3.667, rod: 0.2153, endstop: 0.5821, limits: [-0.35, 0]}
  - {radius: 0.105, angle: 5.7596, rod: 0.2155, endstop: 0.5825, limits: [-0.35, 0]}
  - {radius: 0.105, angle: 1.57, rod: 0.2151, endstop: 0.5818, limits: [-0.35, 0]}
)";
  Problems problems;
  auto delta = linear_delta::read(*parse_yaml(text, "d.yaml"), problems);
  delta.nominal[linear_delta::index(0, linear_delta::kRod)] = 0.2140;
  const auto made = delta_firmware(delta, delta.value, "", "d.yaml");
  ASSERT_TRUE(made);
  const auto robot = robot_of(text, "d.yaml");
  const Eigen::Vector3d q(-0.20, -0.21, -0.19);
  const Eigen::Vector3d p = 1e3 * locate(**robot, values(**robot), q).p;
  const size_t marlin = made->text.find("; Marlin"), line = made->text.find("\nM665", marlin),
               stops = made->text.find("\nM666", line);
  ASSERT_NE(stops, std::string::npos);
  const double L = number_after(made->text, " L", line), R = number_after(made->text, " R", line),
               H = number_after(made->text, " H", line);
  for (int t = 0; t < 3; ++t) {
    const std::string axis = std::string(" ") + "XYZ"[t], arm = std::string(" ") + "ABC"[t];
    const double rod = L + number_after(made->text, arm, line);
    const double angle =
        (std::array{210, 330, 90}[t] + number_after(made->text, axis, line)) * M_PI / 180;
    const double adjustment = number_after(made->text, axis, stops);
    EXPECT_LE(adjustment, 0) << "Marlin refuses positive ones";
    const double at_endstop = H + std::sqrt(rod * rod - R * R) - adjustment;
    const Eigen::Vector3d c(R * std::cos(angle), R * std::sin(angle), at_endstop + 1e3 * q[t]);
    EXPECT_NEAR((p - c).norm(), rod, 3e-4) << "three numbers written to 0.1 um";
  }
  const size_t undo = made->text.find("; To undo it", stops);
  EXPECT_NEAR(number_after(made->text, " A", undo), 214.0 - (214.0 + 215.5 + 215.1) / 3, 1e-4);
}

TEST(DeltaFirmware, NamesWhatItLacksAndRefusesOtherTowers) {
  linear_delta::Delta delta;
  for (int t = 0; t < 3; ++t) {
    delta.value.segment<7>(linear_delta::index(t, 0)) << 0.1,
        std::array{210, 330, 90}[t] * M_PI / 180, 0.2, 0.4, 0, 0, 1;
  }
  delta.nominal = delta.value;
  delta.value[linear_delta::index(1, linear_delta::kTiltX)] = 0.002;
  delta.value[linear_delta::index(1, linear_delta::kScale)] = 1.0001;
  const auto made = delta_firmware(delta, delta.value, "", "d.yaml");
  ASSERT_TRUE(made);
  EXPECT_THAT(made->left_out, Contains(HasSubstr("up to 2.0000 mrad")));
  // A carriage goes scale times what it is told: with fewer steps to the mm as far as that.
  EXPECT_THAT(made->left_out,
              Contains(HasSubstr("up to 100.0000 ppm: divide the steps per mm by them")));
  std::swap(delta.value[linear_delta::index(0, linear_delta::kAngle)],
            delta.value[linear_delta::index(1, linear_delta::kAngle)]);
  EXPECT_FALSE(delta_firmware(delta, delta.value, "", "d.yaml"));
}

TEST(DeltaFirmware, RefusesRodsThatDoNotReachOverTheRadius) {
  linear_delta::Delta delta;
  for (int t = 0; t < 3; ++t)
    delta.value.segment<7>(linear_delta::index(t, 0)) << 0.105,
        std::array{210, 330, 90}[t] * M_PI / 180, 0.1, 0.4, 0, 0, 1;
  delta.nominal = delta.value;
  const auto made = delta_firmware(delta, delta.value, "", "d.yaml");
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().what, HasSubstr("does not reach over the radius of 105.0000 mm"));
}

}  // namespace
}  // namespace selfcal
