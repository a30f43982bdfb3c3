// urdfdom names no lines; TinyXML, on which it stands, knows them.
#include "io/models/urdf_lines.h"

#include <cstring>

namespace selfcal {
namespace {

std::string at_line(const std::string& file, int line) {
  return line > 0 ? file + ":" + std::to_string(line) : file;
}

bool is_xacro(const TiXmlElement& element) {
  if (std::strncmp(element.Value(), "xacro:", 6) == 0) return true;
  for (const TiXmlAttribute* a = element.FirstAttribute(); a; a = a->Next())
    if (a->ValueStr().find("${") != std::string::npos) return true;
  return false;
}

/// The first element, in the order of the file, that only xacro understands; null without one.
const TiXmlElement* first_xacro(const TiXmlElement& element) {
  if (is_xacro(element)) return &element;
  for (auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement())
    if (const TiXmlElement* found = first_xacro(*child)) return found;
  return nullptr;
}

}  // namespace

Result<UrdfLines> UrdfLines::of(const std::string& text, const std::string& file) {
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
