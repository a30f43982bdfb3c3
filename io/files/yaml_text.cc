// Nodes to YAML. The layout is chosen here and left to yaml-cpp's emitter to write: a list or
// mapping that fits on a line goes in flow style. A text is written bare only when it is made of
// harmless characters; everything else is double quoted, which keeps any UTF-8 text as it is.
#include <yaml-cpp/emitter.h>
#include <yaml-cpp/null.h>

#include <algorithm>
#include <cstdlib>

#include "io/files/yaml.h"

namespace selfcal {
namespace {

constexpr std::size_t kLineLength = 100;
constexpr std::size_t kIndent = 2;

bool is_alphanumeric(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_harmless(char c) {
  return is_alphanumeric(c) || std::string_view("_-+./ ").find(c) != std::string_view::npos;
}

/// True when bare `text` is read as itself in block and in flow style.
bool plain(const std::string& text) {
  if (text.empty() || text.back() == ' ') return false;
  if (text == "null" || text == "Null" || text == "NULL") return false;
  const char sign = text.front();
  const bool starts_well = is_alphanumeric(sign) || sign == '_' || sign == '.' || sign == '/' ||
                           ((sign == '-' || sign == '+') && text.size() > 1 &&
                            (is_alphanumeric(text[1]) || text[1] == '.'));
  return starts_well && !text.starts_with("...") && std::ranges::all_of(text, is_harmless);
}

/// Characters of `node` in flow style, nearly; counted no further than past a line.
std::size_t width(const Node& node) {
  if (node.kind == Node::Kind::none) return 1;
  if (node.kind == Node::Kind::text) return node.text.size() + (plain(node.text) ? 0 : 2);
  std::size_t sum = 2;
  for (std::size_t i = 0; i < node.items.size() && sum <= kLineLength; ++i) {
    if (node.kind == Node::Kind::map) sum += node.keys[i].size() + 2;
    sum += width(node.items[i]) + 2;
  }
  return sum;
}

void write_text(const std::string& text, YAML::Emitter& out) {
  if (!plain(text)) out << YAML::DoubleQuoted;
  out << text;
}

/// Writes `node`, whose own lines begin at column `indent` and whose first, if it is to hold all of
/// it, begins `prefix` characters later. The outermost node (indent 0) is never put on one line.
void write_node(const Node& node, std::size_t indent, std::size_t prefix, YAML::Emitter& out) {
  if (node.kind == Node::Kind::none) {
    out << YAML::Null;
    return;
  }
  if (node.kind == Node::Kind::text) return write_text(node.text, out);
  const bool short_enough = indent > 0 && indent + prefix + width(node) <= kLineLength;
  const bool map = node.kind == Node::Kind::map;
  out << (short_enough || node.items.empty() ? YAML::Flow : YAML::Block);
  out << (map ? YAML::BeginMap : YAML::BeginSeq);
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    if (map) {
      out << YAML::Key;
      write_text(node.keys[i], out);
      out << YAML::Value;
    }
    // Within a line that is short enough, everything is.
    const std::size_t inner = short_enough ? 1 : indent + kIndent;
    write_node(node.items[i], inner, short_enough || !map ? 0 : node.keys[i].size() + 2, out);
  }
  out << (map ? YAML::EndMap : YAML::EndSeq);
}

}  // namespace

std::string write_yaml(const Node& node) {
  YAML::Emitter out;
  write_node(node, 0, 0, out);
  if (!out.good()) std::abort();  // an unbalanced tree of our own making
  return std::string(out.c_str(), out.size()) + "\n";
}

}  // namespace selfcal
