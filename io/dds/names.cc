// What topics are called, so that ROS 2 reads them.

#include "io/dds/names.h"

namespace selfcal {
namespace {

bool digit(char c) { return c >= '0' && c <= '9'; }

// The lower case letter or digit that c stands for; an underscore for anything else.
char ros_letter(char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<char>(c - 'A' + 'a');
  return (c >= 'a' && c <= 'z') || digit(c) ? c : '_';
}

}  // namespace

std::string ros_name(std::string_view robot) {
  std::string name;
  for (const char c : robot) {
    const char letter = ros_letter(c);
    if (letter != '_' || (!name.empty() && name.back() != '_')) name += letter;
  }
  if (!name.empty() && name.back() == '_') name.pop_back();
  if (name.empty()) return "robot";
  return digit(name.front()) ? "robot_" + name : name;
}

std::string robot_topic(std::string_view robot, std::string_view topic) {
  return "rt/selfcal/" + ros_name(robot) + "/" + std::string(topic);
}

std::string ros_topic(std::string_view topic) {
  return "rt" + std::string(topic.starts_with('/') ? "" : "/") + std::string(topic);
}

}  // namespace selfcal
