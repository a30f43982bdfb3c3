// The hash by which ROS 2 tells types apart, RIHS01 (REP-2016).
//
// The numbers are those of type_description_interfaces/msg/FieldType; a .msg file's char is a
// uint8.

#include "io/dds/generate/type_hash.h"

#include <openssl/evp.h>

#include <array>
#include <map>

namespace selfcal::generate {
namespace {

int value_type(const MessageField& field) {
  static const std::map<std::string, int> numbers = {
      {"int8", 2},     {"uint8", 3},  {"char", 3},  {"int16", 4},  {"uint16", 5},
      {"int32", 6},    {"uint32", 7}, {"int64", 8}, {"uint64", 9}, {"float32", 10},
      {"float64", 11}, {"bool", 15},  {"byte", 16}, {"string", 17}};
  if (field.nested()) return 1;
  if (field.most_characters > 0) return 21;
  return numbers.at(field.type);
}

int type_number(const MessageField& field) {
  switch (field.many) {
    case MessageField::Many::one:
      return value_type(field);
    case MessageField::Many::array:
      return value_type(field) + 48;
    case MessageField::Many::bounded:
      return value_type(field) + 96;
    case MessageField::Many::unbounded:
      return value_type(field) + 144;
  }
  return 0;
}

// "std_msgs/Header" is "std_msgs/msg/Header" in full.
std::string ros_type_name(const std::string& name) {
  return std::string(name).replace(name.find('/'), 1, "/msg/");
}

std::string description_of(const MessageDefinition& message) {
  std::string text =
      R"({"type_name": ")" + ros_type_name(message.full_name()) + R"(", "fields": [)";
  for (const auto& field : message.fields) {
    if (&field != &message.fields.front()) text += ", ";
    text += R"({"name": ")" + field.name + R"(", "type": {"type_id": )" +
            std::to_string(type_number(field)) + R"(, "capacity": )" +
            std::to_string(field.capacity) + R"(, "string_capacity": )" +
            std::to_string(field.most_characters) + R"(, "nested_type_name": ")" +
            (field.nested() ? ros_type_name(field.type) : "") + R"("}})";
  }
  return text + "]}";
}

}  // namespace

std::string type_description(const MessageDefinitions& all, const std::string& name) {
  std::string text = R"({"type_description": )" + description_of(all.at(name)) +
                     R"(, "referenced_type_descriptions": [)";
  bool first = true;
  for (const auto& other : referenced(all, name)) {
    if (!first) text += ", ";
    first = false;
    text += description_of(all.at(other));
  }
  return text + "]}";
}

std::string type_hash(const MessageDefinitions& all, const std::string& name) {
  const std::string text = type_description(all, name);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  EVP_Digest(text.data(), text.size(), digest.data(), &length, EVP_sha256(), nullptr);
  std::string hash = "RIHS01_";
  for (unsigned int i = 0; i < length; ++i) {
    hash += "0123456789abcdef"[digest[i] >> 4];
    hash += "0123456789abcdef"[digest[i] & 15];
  }
  return hash;
}

}  // namespace selfcal::generate
