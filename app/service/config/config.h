// CONFIG.yaml: one robot, its cell, and when and how it calibrates itself. Paths in it are relative
// to it.
//
//   key              default    range           meaning
//   robot            required                   file of the robot as its maker gives it
//   id               the robot's name           in topic names; one for each robot in a domain
//   serial           id                         hardware_id in the diagnostics
//   state            $STATE_DIRECTORY or state  folder of what must not be lost
//   target           1.0e-3     1e-6 to 1 m     end-position accuracy wanted there (1 sigma)
//   workspace        the touches' region        where it counts: {box: [[x, y, z], [x, y, z]],
//                                               approach: [x, y, z], cone: RAD} as in dataset.yaml
//   domain           0          0 to 232        of DDS; $ROS_DOMAIN_ID where it is set
//   encoders         {}                         where joint readings come from:
//     kind           dds                        one of io/encoders.def; its own keys are listed in
//                                               io/encoders/dds.cc, those of socketcan in
//                                               io/can/settings.h
//     joints         frames' names              names, in the robot's order, or a mapping by the
//                                               frames' names where the kind says so
//     silence        0.5        0.01 to 60 s    without a sample they count as lost
//   trigger          {}                         where the touch comes from:
//     kind           dds                        one of io/triggers.def; its own keys are listed at
//                                               the head of io/triggers/KIND.cc
//     debounce       0.002      0 to 0.1 s      a level counts once it has lasted so long
//     delay          0          0 to 0.1 s      known time from the contact to the edge
//   temperature      none                       topic of a sensor_msgs/Temperature
//   motion           required                   how the robot is asked to move:
//     home           required   rad, m          readings from which every touch can be begun
//     speed          0.5        1e-3 to 100     largest joint speed on free ways (rad/s, m/s)
//     touch_speed    0.01       1e-4 to 1 m/s   of the endpoint towards a surface
//     clearance      0.03       1e-3 to 0.5 m   how far before the surface free ways end
//     slow           search     search to       how far before it the robot, coming straight in,
//                               clearance       slows down to touch_speed; less once touches of
//                                               the set tell where the surface lies
//     search         0.01       1e-4 to 0.1 m   how far off the surface may be, either way
//     apart          0.02       0 to 0.5 m      kept from every other surface; below clearance
//     tilt           1.2        0.01 to 3.2 rad most between stylus and the way in
//     limit_margin   0.005      0 to 0.4        kept from each joint's limits, of its range
//     spacing        0          0 to 1 m        least between touched points of a surface
//     longest        0          0 to 1e6 s      most that a session's motion may take; 0: any time
//     keep_out       []                         where nothing may be: [{min: [x, y, z],
//                                               max: [x, y, z]}, {point: [x, y, z], normal: ...}]
//     capsules       []                         how thick it is: [{link: FRAME, from: [x, y, z],
//                                               to: [x, y, z], radius: R}, ...]
//     rest           1.0e-4     1e-7 to 0.1     joint speed below which the robot stands (rad/s)
//   touch            {}                         when a touch counts:
//     repeats        1          1 to 20         good touches of each configuration
//     tolerance      1.0e-4     1e-6 to 0.01 m  most between them
//     attempts       3          1 to 20         failures before a configuration is put aside
//     most_lost      5          1 to 1000       configurations put aside in a row before it stops
//   limits           {}         1 to 3600 s     time for self_test 10, planning 120, approach 60,
//                                               touch 60, settle 2, retract 30, lock 30,
//                                               computing 600, diagnosing 1800
//   sets             required                   NAME: {an entry of dataset.yaml's sets, and:
//     touches        40         4 to 10000      configurations
//     surface        planes                     {point: [x, y, z], normal: [x, y, z]}, roughly; the
//                                               normal points at the robot
//     within         planes                     {center: [x, y, z], radius: R}: where they may lie
//     places         the others                 sockets or nests, roughly:
//                                               [[x, y, z (, qw, qx, qy, qz)], ...]
//     way_out        the others                 [x, y, z]: direction out of the socket
//   }
//   accept           {}                         when a result is applied:
//     auto           false                      without asking a person
//     check          0.33       0.1 to 0.9      share of the touches kept aside to judge
//     margin         0.05       0 to 0.9        how much better the check rows must be
//     largest_change {}                         most from the active parameters: length 0.005,
//                                               angle 0.005, base_length 0.05, base_angle 0.05,
//                                               tool_length 0.05, tool_angle 0.05 (m, rad)
//   commands         {}                         who may command the service over DDS, and what:
//     over           none                       what keeps strangers out: loopback, secured (by DDS
//                                               Security), network (nothing does), or none: no
//                                               command is taken
//     allow          none                       [start, check, diagnose, done, abort, accept,
//                                               rollback]: those that are taken, by name
//   rounds           {}                         a full session planned anew as it goes:
//     touches        0          0 to 1000       between two plans; 0: all is planned at once
//     margin         1.3        1 to 100        it ends once the end position is known so
//                                               many times better than target
//   causes           {}                         looking for the cause of what calibration leaves:
//     auto           true                       by itself, after a full session that leaves more
//                                               than noise
//     touches        60         0 to 1000       further ones at most, to tell look-alikes apart
//     round          20         4 to 100        of them between two diagnoses
//     payload        none       0.1 to 1000     kg that a person can hang on the tool, its centre
//     at
//                                               the tip; without it nobody is asked
//   schedule         {}                         when it begins by itself; nothing by default:
//     every_hours    none       0.0001 to 1e5   after the last session or check
//     at             none       "HH:MM"         once a day, local time
//     after_motion_hours none   0.0001 to 1e5   of motion
//     temperature_change none   0.1 to 100      K since the last session
//     check_first    true                       a quick check, and a full session only if it fails
//     check_touches  12         8 to 200
//     check_p        0.01       1e-6 to 0.5     below it the active model does not explain them
//     full_after_checks 30      1 to 10000      then a full session all the same
//   resume           true                       after a power cut the session goes on by itself
//   store_mb         100        1 to 1e6        the store is pruned beyond it
//   simulation       none                       SCENARIO.yaml of `serve --simulate`
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/service/config/command_rules.h"
#include "app/service/config/schedule.h"
#include "app/service/transitions/transition.h"
#include "constraints/planning/touch_plan.h"
#include "constraints/sampling/cell_geometry.h"
#include "io/encoders.h"
#include "io/result.h"
#include "io/triggers.h"
#include "kinematics/by_part.h"

namespace selfcal {

struct Acceptance {
  bool automatic = false;
  double check = 0.33, margin = 0.05;
  ByPart largest_change{5e-3, 5e-3, 0.05, 0.05, 0.05, 0.05};
};

struct TouchRules {
  int repeats = 1;
  double tolerance = 1e-4;             ///< m
  double debounce = 0.002, delay = 0;  ///< s
  double rest = 1e-4;                  ///< rad/s
};

struct Speeds {
  double travel = 0.5;  ///< rad/s
  double touch = 0.01;  ///< m/s
};

/// How a full session is planned anew as it goes.
struct RoundRules {
  int touches = 0;      ///< between two plans; 0: all is planned at once
  double margin = 1.3;  ///< times better than the target, and no more is touched
};

/// How the cause of what calibration leaves is looked for.
struct CauseRules {
  bool automatic = true;
  int touches = 60, round = 20;
  std::optional<double> payload;  ///< kg
};

struct Config {
  std::string robot_text;  ///< the robot file's content, as the maker gives it
  std::shared_ptr<const Robot> robot;
  std::string id, serial;
  std::filesystem::path state;
  double target = 1e-3;
  Workspace workspace;
  int domain = 0;
  EncoderKindPtr encoders;
  TriggerKindPtr trigger;  ///< stamped by the same clock as the encoders
  Node transports;         ///< what the file says of both, as far as it changes what readings mean
  std::string temperature_topic;
  std::vector<std::string> joint_names;
  double silence = 0.5;  ///< s
  Speeds speeds;
  TouchPlanOptions plan;
  TouchRules touch;
  Limits limits;
  std::vector<Set> sets;
  std::vector<TouchTarget> targets;
  std::vector<Obstacle> obstacles;
  Node description;  ///< of the data set that a session's touches make
  Acceptance accept;
  RoundRules rounds;
  CauseRules causes;
  CommandRules commands;
  Schedule schedule;
  bool resume = true;
  std::int64_t store_bytes = 100'000'000;
  std::filesystem::path simulation;  ///< empty when none is given
};

/// Reads CONFIG.yaml and the robot it names; the first mistake with file and line otherwise.
Result<Config> load_config(const std::filesystem::path& path);

/// The sets of a stored description, with their methods.
Result<std::vector<Set>> sets_of(const std::string& description);

}  // namespace selfcal
