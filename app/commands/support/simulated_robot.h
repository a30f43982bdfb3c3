// The simulated robot of a configuration's scenario: loaded, and played in a process of its own
// over the transports that the configuration names.
#pragma once

#include <memory>
#include <string>

#include "app/service/config/config.h"
#include "sim/machine.h"

namespace selfcal {

/// The scenario of a file.
Result<Scenario> load_scenario(const std::string& path);

/// The machine of a scenario, standing at the configuration's home.
Result<std::unique_ptr<Machine>> load_machine(const std::string& scenario, const Config& config);

/// What the machine really is, and what it did: false touches and how often each label was visited.
std::string machine_truth(const Machine& machine);

/// Whether the configuration's transports are stamped by the kernel that receives them.
bool paced(const Config& config);

/// Plays the machine at the pace of the clock until told to stop. Where it is paced, every edge it
/// drove then goes to the file `touches` with the truth of its moment
/// (app/commands/support/paced_output.h), unless that is empty.
Result<void> play(Machine& machine, const Config& config, const std::string& touches);

}  // namespace selfcal
