// A small cell around the example robot, as a configuration's text with any value replaced.
#pragma once

#include <map>
#include <string>

#include "app/service/config/config.h"
#include "tests/io/scratch.h"
#include "tests/sim/simulated_robot.h"

namespace selfcal {

/// Values by "part.key" ("motion.home"); those of the set `table` by "sets.key".
using CellKeys = std::map<std::string, std::string>;

inline CellKeys small_cell() {
  return {{"robot", example("rx90.robot.yaml").string()},
          {"motion.home", "[0, -0.6, 0.9, 0, 1.2, 0]"},
          {"sets.method", "plane"},
          {"sets.noise", "2.0e-5"},
          {"sets.surface", "{point: [0.75, 0, 0.15], normal: [0, 0, 1]}"},
          {"sets.within", "{center: [0.75, 0, 0.15], radius: 0.25}"}};
}

inline std::string cell_text(const CellKeys& keys) {
  std::map<std::string, std::string> parts;
  std::string text;
  for (const auto& [path, value] : keys) {
    const std::size_t dot = path.find('.');
    if (dot == std::string::npos) {
      text += path + ": " + value + "\n";
      continue;
    }
    const std::string part = path.substr(0, dot);
    const bool set = part == "sets";
    parts[part] += (set ? "    " : "  ") + path.substr(dot + 1) + ": " + value + "\n";
  }
  for (const auto& [part, inside] : parts)
    text += part + ":\n" + (part == "sets" ? "  table:\n" : "") + inside;
  return text;
}

inline Result<Config> load_text(const std::string& text) {
  const Scratch scratch;
  return load_config(scratch.write("config.yaml", text));
}

/// The small cell with these values instead of its own.
inline Result<Config> load_cell(const CellKeys& changes = {}) {
  CellKeys keys = small_cell();
  for (const auto& [path, value] : changes) keys[path] = value;
  return load_text(cell_text(keys));
}

/// Why it is refused; empty when it is not.
inline std::string refusal(const CellKeys& changes) {
  const auto config = load_cell(changes);
  return config ? "" : config.error().what;
}

}  // namespace selfcal
