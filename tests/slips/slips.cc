// What is said of each was read and judged by hand; what is named is compared in answers.cc.
#include "tests/slips/slips.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tests/shared_data.h"
#include "tests/slips/changes.h"

namespace selfcal::slips {
namespace {

constexpr const char* kMoved = "The instrument or the robot's base was moved then";

/// Positions of a tracker: motoman-tracker.
std::vector<Slip> of_a_tracker() {
  return {
      {"motoman-tracker", "a joint's sign", sign("q2"), "S1 is read with the other sign",
       "S1 is read with the other sign"},
      {"motoman-tracker", "another joint's sign", sign("q4"), "U1 is read with the other sign",
       "U1 is read with the other sign"},
      {"motoman-tracker", "degrees", every_reading([](double q) { return q / kDegree; }),
       "(degrees instead of radians?)", "(degrees instead of radians?)"},
      {"motoman-tracker", "millimetres", position_times(1000), "(millimetres?)", "(millimetres?)"},
      {"motoman-tracker", "inches", position_times(1 / 0.0254), "the measured positions are inches",
       "the measured positions are inches"},
      {"motoman-tracker", "two joints exchanged", exchanged("q2", "q3"),
       "the columns of S1 and L1 are exchanged", "the columns of S1 and L1 are exchanged"},
      {"motoman-tracker", "two wrist joints exchanged", exchanged("q5", "q6"),
       "row 2: column q6: -1.579509 is far outside the limits",
       "row 2: column q6: -1.579509 is far outside the limits"},
      {"motoman-tracker", "x and y exchanged", exchanged("x", "y"),
       "two of the columns x, y and z are exchanged",
       "two of the columns x, y and z are exchanged"},
      {"motoman-tracker", "z upside down", place([](Numbers& p, double) { p[2] *= -1; }),
       "or one has the other sign", "or one has the other sign"},
      {"motoman-tracker",
       "a zero lost by 10 degrees",
       offset("q3", 10),
       "the zero of L1 is 10.1 degrees from",
       "the zero of L1 is 10.1 degrees from",
       {},
       true},
      {"motoman-tracker", "a zero lost by 90 degrees", offset("q2", 90),
       "is far outside the limits [-2.967, 2.967] of joint S1",
       "is far outside the limits [-2.967, 2.967] of joint S1"},
      {"motoman-tracker", "a gear of 2", factor("q4", 2),
       "the readings of U1 are twice what it moves", "the readings of U1 are twice what it moves"},
      {"motoman-tracker",
       "a gear off by 1 percent",
       factor("q2", 1.01),
       "Not determined",
       "with the gear ratio of S1 -1 % off",
       {},
       true},
      {"motoman-tracker",
       "tracker moved 4 mm",
       moved_from_half({3e-3, -2e-3, 1e-3}),
       "Not determined",
       kMoved,
       {"base_drift"}},
      {"motoman-tracker", "tracker moved 40 mm", moved_from_half({3e-2, -2e-2, 2e-2}),
       "between rows 100 and 101 the instrument of set tracker",
       "between rows 100 and 101 the instrument of set tracker"},
      {"motoman-tracker",
       "tracker turned 0.2 degrees",
       turned_from_half(0.2),
       "Not determined",
       kMoved,
       {"base_drift"}},
      {"motoman-tracker", "tracker drifts 20 mm",
       place([](Numbers& p, double done) { p[0] += 0.02 * done; }), "Not determined",
       "no machine has base.x"},
      {"motoman-tracker", "positions 1 percent large", position_times(1.01), "Not determined", ""},
      {"motoman-tracker", "measurements shuffled", measured_elsewhere(false),
       "none of the usual slips explains the rows", "none of the usual slips explains the rows"},
      {"motoman-tracker", "measurements one row late", measured_elsewhere(true),
       "none of the usual slips explains the rows", "none of the usual slips explains the rows"},
      {"motoman-tracker", "30 percent off by 5 mm", false_places(0.3, 5e-3), "Not determined",
       "state a noise of 0.01 mm"},
      {"motoman-tracker", "30 percent off by 100 mm", false_places(0.3, 0.1), "Not improved",
       "state a noise of 0.01 mm"},
      {"motoman-tracker", "10 percent off by 1 m", false_places(0.1, 1), "Not determined",
       "look at the rows and files first"},
      {"motoman-tracker", "noise stated 100 times too small",
       data_set("noise: 1.0e-5", "noise: 1.0e-7"), "times as much as its data sheet says", ""},
      {"motoman-tracker", "noise stated in millimetres", data_set("noise: 1.0e-5", "noise: 1.0e-2"),
       "is `noise` in metres, and 1 sigma?", ""},
      {"motoman-tracker", "every row ten times", twice_or_more(10),
       "1800 rows say what another says in every digit",
       "1800 rows say what another says in every digit"},
      {"motoman-tracker", "kelvin", temperature([](double) { return 294.3; }),
       "294.3 is no temperature of a robot at work, degrees Celsius expected (kelvin?)",
       "294.3 is no temperature of a robot at work, degrees Celsius expected (kelvin?)"},
      {"motoman-tracker", "-1000 degrees",
       temperature([](double done) { return done < 0.5 ? 20 : -1000; }),
       "-1000 is no temperature of a robot at work", "-1000 is no temperature of a robot at work"},
      {"motoman-tracker", "times shuffled", shuffled_times(), "the times go back 102 times",
       "the times go back 102 times"},
      {"motoman-tracker", "forces that never were", wrench({"fx", "fy", "fz", "tx", "ty", "tz"}),
       "", "the rows fit better without their forces"},
      {"motoman-tracker", "forces without torques", wrench({"fx", "fy", "fz"}),
       "column 'tx' is missing: 'fx' needs it", "column 'tx' is missing: 'fx' needs it"},
      {"motoman-tracker", "all rows on one line", on_one_line(), "Not determined", ""},
      {"motoman-tracker", "ten rows", first_rows(10), "Not determined", ""},
      {"motoman-tracker", "three rows", first_rows(3), "Not determined", ""},
      {"motoman-tracker", "readings rounded to a degree", rounded(kSix, kDegree), "Not determined",
       ""},
      {"motoman-tracker", "positions rounded to a millimetre", rounded(kPosition, 1e-3), "", ""},
      {"motoman-tracker", "another robot's file",
       [](Files& files) { files.robot = Files(shared_dir() / "data/mukca-panda-1").robot; },
       "is far outside the limits [-3.08, -0.06] of joint j4",
       "is far outside the limits [-3.08, -0.06] of joint j4"},
      {"motoman-tracker", "lengths of the robot twice as large",
       [](Files& files) { files.scale_robot(2); },
       "the lengths in the robot's file are twice what they are",
       "the lengths in the robot's file are twice what they are"},
      {"motoman-tracker", "a newline in a name", data_set("tracker:", "\"tra\\ncker\":"),
       "a name with a control character", "a name with a control character"},
      {"motoman-tracker", "escape sequences in a name",
       [](Files& files) {
         Files::replace_all(files.data_set, "tracker:", "\"tr\\u001b[31macker\":");
         renamed("set", "tracker", "tr\x1b[31macker")(files);
       },
       "dataset.yaml:5: sets: a name with a control character",
       "dataset.yaml:5: sets: a name with a control character"},
  };
}

/// Locations, on another robot: ipa-ur10-random.
std::vector<Slip> of_locations() {
  return {
      {"ipa-ur10-random", "a joint's sign", sign("q2"), "shoulder_lift is read with the other sign",
       "shoulder_lift is read with the other sign"},
      {"ipa-ur10-random", "two joints exchanged", exchanged("q2", "q3"),
       "the columns of shoulder_lift and elbow are exchanged",
       "the columns of shoulder_lift and elbow are exchanged"},
      {"ipa-ur10-random", "y and z exchanged", exchanged("y", "z"),
       "the columns y and z are exchanged", "the columns y and z are exchanged"},
      {"ipa-ur10-random", "millimetres", position_times(1000), "(millimetres?)", "(millimetres?)"},
      {"ipa-ur10-random", "quaternions in another order",
       [](Files& files) {
         files.change({"qw", "qx", "qy", "qz"}, [](Numbers& v, double) {
           v = {v[3], v[0], v[1], v[2]};
         });
       },
       "the quaternions are read in another order", "look at the rows and files first"},
      {"ipa-ur10-random",
       "a zero lost by 10 degrees",
       offset("q3", 10),
       "the zero of elbow is 10.1 degrees from",
       "the zero of elbow is 10.1 degrees from",
       {},
       true},
      {"ipa-ur10-random",
       "another stylus from half on",
       other_tip_from_half({0.01, 0, 0.02}),
       "Not improved",
       "",
       {"tool_shift"}},
      {"ipa-ur10-random",
       "tracker moved 4 mm",
       moved_from_half({3e-3, -2e-3, 1e-3}),
       "between rows 100 and 101 the instrument of set tmac",
       kMoved,
       {"base_drift"}},
      {"ipa-ur10-random", "measurements one row late", measured_elsewhere(true),
       "Look at the files first", "Look at the files first"},
      {"ipa-ur10-random", "30 percent off by 5 mm", false_places(0.3, 5e-3), "Not improved", ""},
      {"ipa-ur10-random", "noise stated in millimetres", data_set("noise: 3.0e-5", "noise: 3.0e-2"),
       "is `noise` in metres, and 1 sigma?", "is it in metres, and 1 sigma?"},
      {"ipa-ur10-random", "times shuffled", shuffled_times(), "the times go back 102 times",
       "the times go back 102 times"},
      {"ipa-ur10-random", "every row twice", twice_or_more(2),
       "200 rows say what another says in every digit",
       "200 rows say what another says in every digit"},
      {"ipa-ur10-random", "a tool 100 mm longer", robot("r: 0.093", "r: 0.193"), "", ""},
  };
}

/// Touches by hand of real robots: planes, and sockets that are 50 mm apart.
std::vector<Slip> of_touches() {
  return {
      {"motoman-planes", "a joint's sign", sign("q4"), "U1 is read with the other sign",
       "U1 is read with the other sign"},
      {"motoman-planes", "two joints exchanged", exchanged("q2", "q3"),
       "the columns of S1 and L1 are exchanged", "the columns of S1 and L1 are exchanged"},
      {"motoman-planes", "two planes as one", renamed("set", "lower", "higher"),
       "set 'lower' has no rows", "the touches of set higher are of two planes"},
      {"motoman-planes", "a zero lost by 10 degrees", offset("q4", 10), "Not determined", ""},
      {"motoman-planes", "a tool 100 mm shorter", robot("r: 0.354", "r: 0.254"), "Not determined",
       ""},
      {"motoman-planes", "readings rounded to a degree", rounded(kSix, kDegree), "Not improved",
       ""},
      {"mukca-panda-1", "a joint's sign", sign("q4"),
       "is far outside the limits [-3.08, -0.06] of joint j4",
       "is far outside the limits [-3.08, -0.06] of joint j4"},
      {"mukca-panda-1", "two joints exchanged", exchanged("q2", "q6"),
       "is far outside the limits [-1.77, 1.77] of joint j2",
       "is far outside the limits [-1.77, 1.77] of joint j2"},
      {"mukca-panda-1",
       "a zero lost by 10 degrees",
       offset("q4", 10),
       "the zero of j4 is 11.3 degrees from",
       "the zero of j4 is 11.3 degrees from",
       {},
       true},
      {"mukca-panda-1", "sockets 55 mm apart", data_set("distance: 0.050", "distance: 0.055"),
       "check the length given", ""},
      {"mukca-panda-1", "sockets 50 m apart", data_set("distance: 0.050", "distance: 50"),
       "check the length given", ""},
      {"mukca-panda-1", "one socket under another's name",
       [](Files& files) {
         for (std::size_t i = 0; i < files.rows.size(); i += 3)
           if (std::string& group = files.cell(files.rows[i], "group"); group == "front_0")
             group = "right_0";
       },
       "Not determined", ""},
      {"mukca-panda-1", "readings rounded to a degree",
       rounded({"q1", "q2", "q3", "q4", "q5", "q6", "q7"}, kDegree), "Not determined", ""},
  };
}

/// Touches of a simulated robot, whose truth is known: rx90_planes.
std::vector<Slip> of_simulated_touches() {
  return {
      {"rx90-planes", "a joint's sign", sign("q3"), "j3 is read with the other sign",
       "j3 is read with the other sign"},
      {"rx90-planes", "a gear of 2", factor("q5", 0.5), "the readings of j5 are half what it moves",
       "the readings of j5 are half what it moves"},
      {"rx90-planes", "two planes as one", renamed("set", "wall", "side"),
       "the touches of set side are of two planes", "the touches of set side are of two planes"},
      {"rx90-planes", "a step of 202 mm", data_set("distance: 0.200", "distance: 0.202"),
       "distance from step_near of set step_far is given as 202 mm", ""},
      {"rx90-planes", "a step in millimetres", data_set("distance: 0.200", "distance: 200"),
       "(millimetres?), got '200'", "(millimetres?), got '200'"},
      {"rx90-planes", "noise stated in millimetres", data_set("noise: 2.0e-5", "noise: 2.0e-2"),
       "is `noise` in metres, and 1 sigma?", ""},
      {"rx90-planes", "a robot twice as large", robot("0.5", "1.0"), "Look at the files first",
       "Look at the files first"},
      {"rx90-planes", "a table of the other convention",
       robot("kind: serial", "kind: serial\nconvention: standard"),
       "the table is modified DH and no standard one",
       "the table is modified DH and no standard one"},
      {"rx90-planes", "kelvin", temperature([](double) { return 294.3; }), "(kelvin?)",
       "(kelvin?)"},
      {"rx90-planes", "three rows", first_rows(3), "Not determined",
       "too few rows for a diagnosis"},
  };
}

}  // namespace

std::vector<Slip> slips() {
  std::vector<Slip> all;
  for (auto list : {of_a_tracker(), of_locations(), of_touches(), of_simulated_touches()})
    std::ranges::move(list, std::back_inserter(all));
  return all;
}

}  // namespace selfcal::slips
