// ROS message definitions (.msg): one field a line, TYPE NAME.
//
// Read are the basic types, strings, other messages, and their arrays and sequences, with bounds.
// Constants and comments say nothing about what is sent and are passed over. Refused are wide
// strings and default values, which nothing here needs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/result.h"

namespace selfcal::generate {

struct MessageField {
  enum class Many { one, array, bounded, unbounded };
  std::string name;
  std::string type;                 ///< "float64", "string", or "std_msgs/Header"
  std::size_t most_characters = 0;  ///< of a string; 0: without bound
  Many many = Many::one;
  std::size_t capacity = 0;  ///< of an array or a bounded sequence

  bool nested() const { return type.find('/') != std::string::npos; }
};

struct MessageDefinition {
  std::string package, name;
  std::vector<MessageField> fields;

  std::string full_name() const { return package + "/" + name; }
};

/// By full name, "std_msgs/Header".
using MessageDefinitions = std::map<std::string, MessageDefinition>;

/// Reads the text of package/msg/name.msg.
Result<MessageDefinition> parse_message(const std::string& package, const std::string& name,
                                        const std::string& text);

/// Reads FOLDER/PACKAGE/NAME.msg for all of them; every type named must be there.
Result<MessageDefinitions> read_messages(const std::string& folder);

/// Names of the messages that `name` is made of, itself left out, at any depth, in order.
std::vector<std::string> referenced(const MessageDefinitions& all, const std::string& name);

}  // namespace selfcal::generate
