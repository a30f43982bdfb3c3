// Which commands are taken over DDS. A domain is open to anyone who can reach it: none is taken
// unless the configuration allows it by name and says what keeps strangers out.
#pragma once

#include <string>
#include <vector>

#include "app/service/transitions/state.h"
#include "io/dds/reach.h"
#include "io/result.h"

namespace selfcal {

struct CommandRules {
  enum class Over : std::uint8_t {
    none,      ///< no command is taken
    loopback,  ///< DDS is confined to this computer
    secured,   ///< by DDS Security
    network,   ///< nothing: whoever is in the domain may command
  };
  Over over = Over::none;
  std::vector<Verb> allow;

  /// Why this one is not taken; empty when it is.
  std::string forbids(Verb verb) const;
  /// Fails when what shall keep strangers out is not there.
  Result<void> hold(const DdsReach& reach) const;
  /// Who may command what, in a sentence for the log.
  std::string text() const;
};

}  // namespace selfcal
