// How the simulated robot moves, feels and fails: `machine` in SCENARIO.yaml.
//
//   key             default   range          meaning
//   encoder_period  0.002     1e-4 to 0.1 s  between two samples of all joints
//   speed           2         1e-3 to 100    largest joint speed (rad/s or m/s)
//   acceleration    20        0.1 to 1e4     of the fastest joint (rad/s^2), in moving and stopping
//   trigger_delay   0         0 to 0.1 s     from the contact to the edge
//   bounce          0         0 to 20        times that the trigger opens again at once
//   missed          0         0 to 0.5       share of the touches that trigger nothing
//   lock_time       0.2       0 to 10 s      from the request to the lock's engaging or opening
//   lock_slip       1e-3      0 to 0.1 rad   by which a slipping lock turns
//   lock_slips      none      from 1         configurations under locks, counted from the first, on
//                                            the way to which the lock slips
//   temperature     20        -40 to 80      °C at the start
//   warming         0         -20 to 20      °C per hour
//   effects         []                       what the model lacks: entries as of a robot file's
//                                            `effects` ({effect: backlash, at: j2, play: 5e-4});
//                                            moment, begin, end (3600) are s from the start,
//                                            reference is the temperature then
//   payload         0         0 to 1000 kg   on the tool, its centre at the tip, in moves whose
//                                            label ends with ", payload"
//   trigger_pull    none                     played in a process of its own with a trigger of
//                                            kind gpio: file of gpio-sim that drives the line,
//                                            /sys/devices/platform/DEVICE/CHIP/sim_gpioN/pull
//   faults          []                       [{what: WHAT, at: S, for: S}]: what breaks, when
//                                            (s from the start), for how long; WHAT is one of
//     encoders        no sample comes
//     stuck           the trigger stays closed
//     refuse          every move is refused
//     silent          moves are neither answered nor carried out
//     lock_refuse     no lock is engaged
//     lock_late       locks neither engage nor open
//     lock_open       an engaged lock opens by itself
//     misread         the encoder of `joint` reads `by` (rad or m) too much
#pragma once

#include <string>
#include <vector>

#include "kinematics/description.h"

namespace selfcal {

struct MachineFault {
  enum class What { encoders, stuck, refuse, silent, lock_refuse, lock_late, lock_open, misread };
  What what = What::encoders;
  double at = 0, duration = 0;  ///< s
  std::string joint = {};       ///< of misread
  double by = 0;                ///< rad or m, of misread
};

struct MachineScenario {
  double encoder_period = 0.002;
  double speed = 2, acceleration = 20;
  double trigger_delay = 0;
  int bounce = 0;
  double missed = 0;
  double lock_time = 0.2, lock_slip = 1e-3;
  std::vector<int> lock_slips;
  double temperature = 20, warming = 0;
  std::vector<Node> effects;
  double payload = 0;
  std::string trigger_pull;
  std::vector<MachineFault> faults;
};

MachineScenario read_machine_scenario(const Node& node, Problems& problems);

}  // namespace selfcal
