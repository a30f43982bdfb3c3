// urdfdom names no lines; TinyXML, on which it stands, knows them.
#include "io/models/urdf_lines.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <locale>
#include <sstream>
#include <string_view>
#include <utility>

#include "io/files/utf8.h"
#include "kinematics/description.h"

namespace selfcal {
namespace {

/// Levels of elements: TinyXML, and all that reads its tree, calls itself for each.
constexpr int kDeepest = 200;

std::string at_line(const std::string& file, int line) {
  return line > 0 ? file + ":" + std::to_string(line) : file;
}

/// `foreign`: inside what other programs read of a URDF, whose texts are their own.
bool is_xacro(const TiXmlElement& element, bool foreign) {
  if (std::strncmp(element.Value(), "xacro:", 6) == 0) return true;
  if (foreign) return false;
  for (const TiXmlAttribute* a = element.FirstAttribute(); a; a = a->Next())
    if (a->ValueStr().find("${") != std::string::npos) return true;
  return false;
}

/// The first element, in the order of the file, that only xacro understands; null without one.
const TiXmlElement* first_xacro(const TiXmlElement& element, bool foreign = false) {
  for (const char* other : {"gazebo", "ros2_control", "transmission"})
    foreign = foreign || element.ValueStr() == other;
  if (is_xacro(element, foreign)) return &element;
  for (auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement())
    if (const TiXmlElement* found = first_xacro(*child, foreign)) return found;
  return nullptr;
}

/// The first joint or link, or the robot itself, whose name is no text; null without one.
const TiXmlElement* first_named_by_other_bytes(const TiXmlElement& root) {
  const auto is_named = [](const TiXmlElement& element) {
    const char* name = element.Attribute("name");
    return !name || is_text(name);
  };
  if (!is_named(root)) return &root;
  for (auto* child = root.FirstChildElement(); child; child = child->NextSiblingElement())
    if (!is_named(*child)) return child;
  return nullptr;
}

/// The first origin of a joint that is turned by more than any file in radians, and by how much;
/// null where none is.
std::pair<const TiXmlElement*, double> first_in_degrees(const TiXmlElement& root) {
  for (auto* joint = root.FirstChildElement("joint"); joint;
       joint = joint->NextSiblingElement("joint")) {
    const TiXmlElement* origin = joint->FirstChildElement("origin");
    const char* rpy = origin ? origin->Attribute("rpy") : nullptr;
    std::istringstream angles(rpy ? rpy : "");
    angles.imbue(std::locale::classic());
    for (double angle = 0; angles >> angle;)
      if (std::abs(angle) > kMostTurned) return {origin, angle};
  }
  return {nullptr, 0};
}

/// Place behind the next `end` from `from` on; the text's end without one.
std::size_t behind(const std::string& text, std::size_t from, std::string_view end) {
  const std::size_t found = text.find(end, from);
  return found == std::string::npos ? text.size() : found + end.size();
}

/// Place behind the tag that begins at `from`; its quotations may hold anything.
std::size_t behind_tag(const std::string& text, std::size_t from) {
  char quote = 0;
  for (std::size_t i = from; i < text.size(); ++i) {
    const char c = text[i];
    if (quote == 0 && c == '>') return i + 1;
    if (quote == 0 && (c == '"' || c == '\''))
      quote = c;
    else if (c == quote)
      quote = 0;
  }
  return text.size();
}

/// The place where elements nest deeper than kDeepest; the text's end without one.
std::size_t too_deep(const std::string& text) {
  int depth = 0;
  std::size_t i = text.find('<');
  for (std::size_t next = 0; i < text.size(); i = text.find('<', next)) {
    const std::string_view rest = std::string_view(text).substr(i);
    const unsigned char first = rest.size() > 1 ? static_cast<unsigned char>(rest[1]) : ' ';
    if (rest.starts_with("<!--")) {
      next = behind(text, i, "-->");
    } else if (rest.starts_with("<![CDATA[")) {
      next = behind(text, i, "]]>");
    } else if (std::isalpha(first) || first == '_' || first > 126) {
      next = behind_tag(text, i);
      if (text[next - 2] != '/' && ++depth > kDeepest) return i;
    } else {
      next = behind(text, i, ">");
      if (first == '/') --depth;
    }
  }
  return text.size();
}

}  // namespace

Result<UrdfLines> UrdfLines::of(const std::string& text, const std::string& file) {
  if (const auto place = static_cast<std::ptrdiff_t>(too_deep(text)); place < std::ssize(text))
    return bad_input(
        at_line(file, 1 + static_cast<int>(std::count(text.begin(), text.begin() + place, '\n'))) +
        ": elements nest deeper than " + std::to_string(kDeepest) + " levels");
  TiXmlDocument document;
  document.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  if (document.Error())
    return bad_input(at_line(file, document.ErrorRow()) +
                     ": is not valid XML: " + document.ErrorDesc());
  const TiXmlElement* root = document.RootElement();
  if (!root) return bad_input(file + ": is empty");
  if (root->ValueStr() != "robot")
    return bad_input(at_line(file, root->Row()) +
                     ": expected a URDF, whose root is 'robot', got '" + root->ValueStr() + "'");
  if (const TiXmlElement* xacro = first_xacro(*root))
    return bad_input(at_line(file, xacro->Row()) +
                     ": is xacro, which becomes a URDF by `xacro FILE > robot.urdf`");
  if (const TiXmlElement* element = first_named_by_other_bytes(*root))
    return bad_input(at_line(file, element->Row()) + ": expected a name in UTF-8, got other bytes");
  if (const auto [origin, angle] = first_in_degrees(*root); origin)
    return bad_input(at_line(file, origin->Row()) + ": rpy " + format_number(angle) +
                     " is more than four turns, radians expected (degrees?)");
  return UrdfLines(file, std::move(document));
}

int UrdfLines::line(const char* element, const std::string& name) const {
  const TiXmlElement* root = document_.RootElement();
  for (auto* e = root->FirstChildElement(element); e; e = e->NextSiblingElement(element))
    if (const char* found = e->Attribute("name"); found && name == found) return e->Row();
  return 0;
}

std::string UrdfLines::place(const char* element, const std::string& name) const {
  return at_line(file_, line(element, name));
}

std::string UrdfLines::place_of(const std::string& message) const {
  std::string longest;
  int row = 0;
  for (auto* e = document_.RootElement()->FirstChildElement(); e; e = e->NextSiblingElement()) {
    const char* name = e->Attribute("name");
    if (!name || std::strlen(name) <= longest.size() || message.find(name) == std::string::npos)
      continue;
    longest = name;
    row = e->Row();
  }
  return at_line(file_, row);
}

}  // namespace selfcal
