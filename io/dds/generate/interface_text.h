// What is generated from message definitions: IDL for the DDS library's compiler, and a C++ header
// that gives the generated types short names, descriptors and hashes.
#pragma once

#include <string>

#include "io/dds/generate/message_file.h"

namespace selfcal::generate {

/// PACKAGE/msg/NAME.idl: module PACKAGE::msg::dds_, struct NAME_ and fields that end in an
/// underscore, as ROS does it, so that no name is a keyword of IDL or C.
std::string idl_text(const MessageDefinition& message);

/// selfcal_messages/types.h. Fails when two packages have a message of the same name.
Result<std::string> header_text(const MessageDefinitions& all);

}  // namespace selfcal::generate
