// What is generated from message definitions: IDL, and the C++ header of the generated types.

#include "io/dds/generate/interface_text.h"

#include <map>
#include <set>

#include "io/dds/generate/type_hash.h"

namespace selfcal::generate {
namespace {

// "std_msgs/Header" with `separator` between package, msg and what follows.
std::string joined(const std::string& name, const std::string& separator) {
  const auto slash = name.find('/');
  return name.substr(0, slash) + separator + "msg" + separator + name.substr(slash + 1);
}

std::string idl_type(const MessageField& field) {
  static const std::map<std::string, std::string> names = {
      {"bool", "boolean"},  {"byte", "octet"},  {"char", "uint8"},    {"int8", "int8"},
      {"uint8", "uint8"},   {"int16", "int16"}, {"uint16", "uint16"}, {"int32", "int32"},
      {"uint32", "uint32"}, {"int64", "int64"}, {"uint64", "uint64"}, {"float32", "float"},
      {"float64", "double"}};
  if (field.nested()) {
    const auto slash = field.type.find('/');
    return field.type.substr(0, slash) + "::msg::dds_::" + field.type.substr(slash + 1) + "_";
  }
  if (field.type != "string") return names.at(field.type);
  if (field.most_characters == 0) return "string";
  return "string<" + std::to_string(field.most_characters) + ">";
}

std::string idl_field(const MessageField& field) {
  const std::string capacity = std::to_string(field.capacity);
  switch (field.many) {
    case MessageField::Many::one:
      return idl_type(field) + " " + field.name + "_";
    case MessageField::Many::array:
      return idl_type(field) + " " + field.name + "_[" + capacity + "]";
    case MessageField::Many::bounded:
      return "sequence<" + idl_type(field) + ", " + capacity + "> " + field.name + "_";
    case MessageField::Many::unbounded:
      return "sequence<" + idl_type(field) + "> " + field.name + "_";
  }
  return "";
}

// The C name of a generated type.
std::string c_name(const MessageDefinition& message) {
  return message.package + "_msg_dds__" + message.name + "_";
}

constexpr const char* kHeaderStart = R"(// Generated from the .msg files.
#pragma once

#include <dds/dds.h>

namespace selfcal::dds {

/// A type's descriptor for the DDS library and its ROS hash.
struct MessageType {
  const dds_topic_descriptor_t* descriptor;
  const char* hash;
};

template <class T>
inline constexpr MessageType message_type{};

}  // namespace selfcal::dds

)";

}  // namespace

std::string idl_text(const MessageDefinition& message) {
  std::set<std::string> includes;
  for (const auto& field : message.fields)
    if (field.nested()) includes.insert(joined(field.type, "/"));
  const std::string guard = joined(message.full_name(), "__") + "_IDL";
  std::string text = "#ifndef " + guard + "\n#define " + guard + "\n";
  for (const auto& include : includes) text += "#include \"" + include + ".idl\"\n";
  text += "module " + message.package + " { module msg { module dds_ {\nstruct " + message.name +
          "_ {\n";
  for (const auto& field : message.fields) text += "  " + idl_field(field) + ";\n";
  return text + "};\n}; }; };\n#endif\n";
}

Result<std::string> header_text(const MessageDefinitions& all) {
  std::set<std::string> names;
  std::string includes, types;
  for (const auto& [full_name, message] : all) {
    if (!names.insert(message.name).second)
      return bad_input("two packages have a message " + message.name);
    const std::string type = c_name(message);
    includes += "#include <" + joined(full_name, "/") + ".h>\n";
    types += "\nusing " + message.name + " = ::" + type + ";\n" +
             "template <>\ninline constexpr MessageType message_type<" + message.name +
             ">{&::" + type + "_desc,\n    \"" + type_hash(all, full_name) + "\"};\n";
  }
  return includes + kHeaderStart + "namespace selfcal::dds {\n" + types +
         "\n}  // namespace selfcal::dds\n";
}

}  // namespace selfcal::generate
