// The hash by which ROS 2 tells types apart, RIHS01 (REP-2016).
//
// SHA-256 of a JSON text of the type's fields and of all types it is made of, sorted by name.
#pragma once

#include <string>

#include "io/dds/generate/message_file.h"

namespace selfcal::generate {

/// "RIHS01_" and 64 hexadecimal digits of message `name`, which `all` has with all it is made of.
std::string type_hash(const MessageDefinitions& all, const std::string& name);

/// The text that is hashed.
std::string type_description(const MessageDefinitions& all, const std::string& name);

}  // namespace selfcal::generate
