// One robot, calibrated by its own touches and by each of the chapter's measuring devices with its
// usual noise, side by side: how good touches alone become.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/recovery/rx90.h"
#include "tests/support/end_position.h"

namespace selfcal::recovery {
namespace {

constexpr int kRobotsPerDevice = 6;
constexpr int kRows = 300;  // of every device

struct Device {
  const char* name;
  double noise;  ///< m, see session.h
  std::vector<SetPart> sets;
};

std::vector<SetPart> with_step(std::vector<SetPart> planes) {
  planes.push_back(step_of_a(kRows / 5));
  return planes;
}

SetPart of(const char* name, std::initializer_list<std::pair<const char*, const char*>> fields,
           int rows) {
  return {name, entry(fields), rows};
}

std::vector<Device> devices() {
  const auto cable = [](const char* name) {
    return of(name, {{"method", "fixed-point-distance"}, {"offset", "unknown"}}, kRows / 3);
  };
  // Two stations see the robot at nearly all rows; the step gives the scale.
  const auto seen = [](double times) {
    std::vector<SetPart> sets = {of("one", {{"method", "bearing"}, {"frame", "unknown"}}, 120),
                                 of("two", {{"method", "bearing"}, {"frame", "unknown"}}, 120),
                                 of("a", {{"method", "plane"}}, 30), step_of_a(30)};
    for (SetPart& each : sets)
      if (each.name == "one" || each.name == "two") each.noise_times = times;
    return sets;
  };
  return {
      {"touches of five planes, a step of 200 mm", 20e-6, with_step(four_planes(kRows / 5))},
      {"two theodolites of 20 urad, and the step", 20e-6, seen(1)},
      {"two laser scanners of 100 urad, and the step", 20e-6, seen(5)},
      {"three cables", 0.1e-3, {cable("a"), cable("b"), cable("c")}},
      {"laser tracker of today",
       20e-6,
       {of("tracker", {{"method", "position"}, {"frame", "unknown"}}, kRows)}},
      {"cameras, whole location",
       0.2e-3,
       {of("cameras", {{"method", "location"}, {"frame", "unknown"}}, kRows)}},
      {"extendable ball bar of 5 um, from three nests",
       5e-6,
       {of("a", {{"method", "fixed-point-distance"}}, kRows / 3),
        of("b", {{"method", "fixed-point-distance"}}, kRows / 3),
        of("c", {{"method", "fixed-point-distance"}}, kRows / 3)}},
      {"extendable ball bar of 5 um, from one nest",
       5e-6,
       {of("a", {{"method", "fixed-point-distance"}}, kRows)}},
      {"telescoping link of 50 um at one point, its zero unknown",
       50e-6,
       {of("a", {{"method", "fixed-point-distance"}, {"offset", "unknown"}}, kRows)}},
  };
}

TEST(Devices, LeaveErrorsOfTheSizeThatTheyStateAndTouchesAreNoWorseThanCables) {
  const auto robot = robot_of(kRx90);
  std::printf("%-45s %6s %10s %16s %16s\n", "RX-90, 1 mm and 1 mrad off", "rows", "noise [um]",
              "end median [um]", "stated [um]");
  std::vector<double> medians;
  for (const Device& device : devices()) {
    double median = 0, stated = 0;
    int rows = 0;
    for (int seed = 1; seed <= kRobotsPerDevice; ++seed) {
      Random random(static_cast<unsigned>(seed));
      const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
      const Session session = make_session(*robot, truth, device.sets, device.noise, random);
      ASSERT_EQ(session.unreached, "") << device.name;
      const Solution solution = identify(*robot, session.data);
      EXPECT_EQ(solution.verdict.answer, Answer::improved)
          << device.name << ": " << solution.verdict.why;
      median += aligned_errors(*robot, solution.values, truth)[250] / kRobotsPerDevice;
      stated += solution.endpoint.median / kRobotsPerDevice;
      rows = static_cast<int>(session.data.rows.rows());
    }
    std::printf("%-45s %6d %10.3g %16.3g %16.3g\n", device.name, rows, 1e6 * device.noise,
                1e6 * median, 1e6 * stated);
    EXPECT_LT(median, 2 * stated) << device.name;
    EXPECT_GT(median, stated / 4) << device.name;
    medians.push_back(median);
  }
  EXPECT_LT(medians[0], medians[3]);
}

}  // namespace
}  // namespace selfcal::recovery
