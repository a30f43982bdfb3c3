// `selfcal monitor --web`: watches the domain and serves the page until told to stop.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/web/address.h"
#include "app/web/server.h"
#include "io/dds/participant.h"

namespace selfcal {

struct PageOptions {
  WebAddress address;
  int domain = 0;                    ///< of DDS, that of `participant`
  std::string robot;                 ///< the only one to show; empty: all of the domain
  std::vector<std::string> configs;  ///< CONFIG.yaml of robots, for the 3D view and the history
  bool commands = false;
  std::string token_file;  ///< empty: where one is demanded it is made and printed
  std::string from;        ///< who commands, for the service's log: "ana@cell"
};

/// Serves until `stop` says so; says where, on standard error.
Result<void> serve_page(const DdsParticipant& participant, const PageOptions& options,
                        const std::function<bool()>& stop);

}  // namespace selfcal
