// YAML read with lines, written readably, and the same after a round trip.
#include "io/files/yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/io/scratch.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

bool equal(const Node& a, const Node& b) {
  if (a.kind != b.kind || a.text != b.text || a.keys != b.keys) return false;
  return std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(), equal);
}

std::string yaml_error(std::string_view text) {
  const auto node = parse_yaml(text, "f.yaml");
  return node ? "no error" : node.error().what;
}

std::string random_text(std::mt19937_64& random) {
  static const std::vector<std::string> kPieces = {
      "a",  "7",  " ",  "-",    "_",    ".",      ":",      "#",    "\"", "'",  "\n", "\t",
      "\\", ",",  "[",  "]",    "{",    "}",      "&",      "*",    "!",  "|",  ">",  "%",
      "@",  "`",  "?",  "~",    "é",    "\r",     "null",   "=",    "/",  "+1", "<",  "°C",
      "µ",  "--", "e3", "\x01", "true", "\u2028", "\u00a0", "日本", "0x", "\b"};
  std::string text;
  for (auto pieces = random() % 6; pieces > 0; --pieces) text += kPieces[random() % kPieces.size()];
  return text;
}

Node random_node(std::mt19937_64& random, int depth) {
  const auto kind = depth == 0 ? 3 : random() % 8;
  if (kind == 0) return Node();
  Node node = kind < 3 ? Node::list() : kind < 6 ? Node::map() : Node::of(random_text(random));
  if (depth == 0) node = Node::map();
  const auto size = node.kind == Node::Kind::text || depth > 4 ? 0 : 1 + random() % 6;
  for (std::size_t i = 0; i < size; ++i) {
    Node item = random_node(random, depth + 1);
    if (node.kind == Node::Kind::list) node.items.push_back(std::move(item));
    if (node.kind == Node::Kind::map) {
      node.set(std::to_string(i) + random_text(random), std::move(item));
    }
  }
  return node;
}

TEST(Yaml, KeepsOrderKindAndLineOfEveryValue) {
  const auto node =
      parse_yaml("robot: rx90\nframes:\n  - {name: base, r: 0.5}\nempty:\n", "f.yaml");
  ASSERT_TRUE(node.has_value()) << node.error().what;
  EXPECT_EQ(node->keys, (std::vector<std::string>{"robot", "frames", "empty"}));
  const Node& base = node->find("frames")->items.at(0);
  EXPECT_EQ(base.find("r")->text, "0.5");
  EXPECT_EQ(to_string(base.find("r")->place), "f.yaml:3");
  EXPECT_EQ(node->find("empty")->kind, Node::Kind::none);
  EXPECT_EQ(to_string(node->find("empty")->place), "f.yaml:4");
}

TEST(Yaml, FollowsAnchors) {
  const auto node = parse_yaml("a: &x {r: 1}\nb: *x\n", "f.yaml");
  ASSERT_TRUE(node.has_value()) << node.error().what;
  EXPECT_EQ(node->find("b")->find("r")->text, "1");
}

TEST(Yaml, ReadsWindowsLineEndsAndAByteOrderMark) {
  const auto node = parse_yaml("\xEF\xBB\xBFrobot: a\r\nkind: serial\r\n", "f.yaml");
  ASSERT_TRUE(node.has_value()) << node.error().what;
  EXPECT_EQ(node->find("robot")->text, "a");
  EXPECT_EQ(node->find("kind")->text, "serial");
}

TEST(Yaml, NamesTheLineOfWhatIsNotYaml) {
  EXPECT_THAT(yaml_error("a: 1\nb: [1, 2\n"), StartsWith("f.yaml:"));
  EXPECT_THAT(yaml_error("a: 1\nb: *nowhere\n"), StartsWith("f.yaml:2: is not valid YAML"));
  EXPECT_THAT(yaml_error("a: \"unfinished\nb: 2\n"), HasSubstr("is not valid YAML"));
  EXPECT_THAT(yaml_error("a: 1\n\tb: 2\n"), HasSubstr("f.yaml:2"));
}

TEST(Yaml, RefusesWhatWouldBeLostSilently) {
  EXPECT_EQ(yaml_error("a: 1\nb: 2\na: 3\n"), "f.yaml:3: key 'a' appears twice");
  EXPECT_EQ(yaml_error("x:\n  - {r: 1, r: 1}\n"), "f.yaml:2: key 'r' appears twice");
  EXPECT_EQ(yaml_error("a: 1\n---\na: 2\n"), "f.yaml: expected one document, got 2");
  EXPECT_EQ(yaml_error("[a]: 1\n"), "f.yaml:1: expected a text for a key");
}

TEST(Yaml, RefusesAFileWithoutAMapping) {
  EXPECT_EQ(yaml_error(""), "f.yaml: is empty");
  EXPECT_EQ(yaml_error("# nothing\n"), "f.yaml: is empty");
  EXPECT_EQ(yaml_error("- 1\n- 2\n"), "f.yaml:1: expected `key: value` lines");
  EXPECT_EQ(yaml_error("text\n"), "f.yaml:1: expected `key: value` lines");
  EXPECT_EQ(yaml_error("\xEF\xBB\xBF\n<?xml version=\"1.0\"?>\n<robot name=\"a\"/>\n"),
            "f.yaml:1: is XML where YAML is expected; `selfcal robot convert f.yaml` makes a robot "
            "file of a URDF");
  // yaml-cpp reads one document after the other here, and never comes to the end.
  for (const char* text : {", [", ",srrv:", ","})
    EXPECT_THAT(yaml_error(text), HasSubstr("f.yaml:1: is not valid YAML")) << text;
  EXPECT_THAT(yaml_error("a: 1\n---\n]\n"), StartsWith("f.yaml:"));
  EXPECT_EQ(yaml_error(std::string_view("\xFF\xFE\0a", 4)),
            "f.yaml: expected UTF-8 text, got other bytes");
}

TEST(Yaml, RefusesNestingAndAliasesWithoutEnd) {
  EXPECT_THAT(yaml_error("a: " + std::string(65, '[') + std::string(65, ']')),
              HasSubstr("nested deeper than 64 levels"));
  EXPECT_THAT(yaml_error("a: " + std::string(100000, '[')), StartsWith("f.yaml"));
  EXPECT_THAT(yaml_error("a: &x [*x, *x]\n"), StartsWith("f.yaml"));
  std::string laughs = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 10; ++i) {
    const std::string one = "*a" + std::to_string(i - 1) + " ";
    laughs += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + one;
    for (int k = 0; k < 9; ++k) laughs += ", " + one;
    laughs += "]\n";
  }
  EXPECT_THAT(yaml_error(laughs), HasSubstr("more than"));
}

TEST(Yaml, SaysWhichFileCannotBeRead) {
  const Scratch scratch;
  const auto missing = read_yaml(scratch.folder() / "none.yaml");
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().exit_status, kBadInput);
  EXPECT_THAT(missing.error().what, HasSubstr("none.yaml: cannot be read: No such file"));
  const auto folder = read_yaml(scratch.folder());
  ASSERT_FALSE(folder.has_value());
  EXPECT_THAT(folder.error().what, HasSubstr("expected a file, got a folder"));
  const auto huge = read_yaml(scratch.write("huge.yaml", std::string(5 << 20, ' ')));
  ASSERT_FALSE(huge.has_value());
  EXPECT_THAT(huge.error().what, HasSubstr("longer than"));
}

TEST(Yaml, WritesShortMappingsOnOneLine) {
  Node frame = Node::map();
  frame.set("name", Node::of("j1")).set("joint", Node::of("revolute")).set("r", Node::of(0.5));
  frame.set("limits", Node::of(Eigen::VectorXd(Eigen::Vector2d(-2.79, 2.79))));
  Node frames = Node::list();
  frames.items = {frame, frame};
  Node robot = Node::map();
  robot.set("robot", Node::of("rx 90: old")).set("frames", frames);
  EXPECT_EQ(write_yaml(robot),
            "robot: \"rx 90: old\"\n"
            "frames:\n"
            "  - {name: j1, joint: revolute, r: 0.5, limits: [-2.79, 2.79]}\n"
            "  - {name: j1, joint: revolute, r: 0.5, limits: [-2.79, 2.79]}\n");
}

TEST(Yaml, ReadsBackWhatItWrote) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 500; ++i) {
    const Node node = random_node(random, 0);
    const std::string text = write_yaml(node);
    const auto read = parse_yaml(text, "f.yaml");
    ASSERT_TRUE(read.has_value()) << read.error().what << "\n" << text;
    ASSERT_TRUE(equal(node, *read)) << text;
    ASSERT_EQ(write_yaml(*read), text);
  }
}

}  // namespace
}  // namespace selfcal
