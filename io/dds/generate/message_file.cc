// ROS message definitions (.msg): one field a line, TYPE NAME.

#include "io/dds/generate/message_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>

namespace selfcal::generate {
namespace {

constexpr std::array kBasic = {"bool",   "byte",    "char",    "int8",   "uint8",
                               "int16",  "uint16",  "int32",   "uint32", "int64",
                               "uint64", "float32", "float64", "string"};

bool basic(std::string_view type) {
  return std::find(kBasic.begin(), kBasic.end(), type) != kBasic.end();
}

// The line without its comment and the spaces around it.
std::string content(const std::string& line) {
  const std::string text = line.substr(0, line.find('#'));
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// [] without, [<=N] with a bound, [N] of fixed length.
void set_many(const std::string& brackets, const std::string& bound, const std::string& number,
              MessageField& field) {
  if (brackets.empty()) return;
  field.many = MessageField::Many::unbounded;
  if (number.empty()) return;
  field.many = bound.empty() ? MessageField::Many::array : MessageField::Many::bounded;
  field.capacity = std::stoul(number);
}

// TYPE[<=characters][brackets] NAME
Result<MessageField> parse_field(const std::string& package, const std::string& line) {
  static const std::regex form(
      R"(^([A-Za-z][A-Za-z0-9_]*(?:/[A-Za-z][A-Za-z0-9_]*)?)(?:<=([0-9]{1,9}))?)"
      R"((\[(?:(<=)?([0-9]{1,9}))?\])?[ \t]+([a-z][a-z0-9_]*)$)");
  std::smatch part;
  if (!std::regex_match(line, part, form)) return bad_input("not a field: " + line);
  MessageField field{.name = part[6], .type = part[1]};
  if (field.name.back() == '_' || field.name.find("__") != std::string::npos)
    return bad_input("not a name that ROS takes: " + field.name);
  if (part[2].matched && field.type != "string") return bad_input("not a string: " + line);
  if (part[2].matched) field.most_characters = std::stoul(part[2]);
  set_many(part[3], part[4], part[5], field);
  if (field.type == "wstring") return bad_input("wide strings are not read: " + line);
  if (!basic(field.type) && !field.nested()) field.type = package + "/" + field.type;
  return field;
}

bool constant(const std::string& line) {
  static const std::regex form(R"(^[A-Za-z0-9_<=]+[ \t]+[A-Z][A-Z0-9_]*[ \t]*=.*$)");
  return std::regex_match(line, form);
}

}  // namespace

Result<MessageDefinition> parse_message(const std::string& package, const std::string& name,
                                        const std::string& text) {
  MessageDefinition message{package, name, {}};
  std::set<std::string> names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::string field_text = content(line);
    if (field_text.empty() || constant(field_text)) continue;
    auto field = parse_field(package, field_text);
    if (!field) return bad_input(message.full_name() + ": " + field.error().what);
    if (!names.insert(field->name).second)
      return bad_input(message.full_name() + ": two fields are called " + field->name);
    message.fields.push_back(*std::move(field));
  }
  if (message.fields.empty()) return bad_input(message.full_name() + ": there are no fields");
  return message;
}

Result<MessageDefinitions> read_messages(const std::string& folder) {
  MessageDefinitions all;
  std::error_code error;
  for (std::filesystem::recursive_directory_iterator entry(folder, error), end;
       !error && entry != end; entry.increment(error)) {
    const auto path = entry->path();
    if (path.extension() != ".msg") continue;
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    auto message =
        parse_message(path.parent_path().filename().string(), path.stem().string(), text.str());
    if (!message) return tl::make_unexpected(message.error());
    const std::string name = message->full_name();
    all[name] = *std::move(message);
  }
  if (error) return bad_input(folder + ": " + error.message());
  for (const auto& [name, message] : all)
    for (const auto& field : message.fields)
      if (field.nested() && !all.contains(field.type))
        return bad_input(name + ": there is no message " + field.type);
  return all;
}

std::vector<std::string> referenced(const MessageDefinitions& all, const std::string& name) {
  std::set<std::string> found;
  std::vector<std::string> open = {name};
  while (!open.empty()) {
    const MessageDefinition& message = all.at(open.back());
    open.pop_back();
    for (const auto& field : message.fields)
      if (field.nested() && found.insert(field.type).second) open.push_back(field.type);
  }
  return {found.begin(), found.end()};
}

}  // namespace selfcal::generate
