// What a person wrote in a file, as a tree with the place of every value.
//
// Robots, methods and scenarios read their own fields from a Node through Fields, which keeps
// the first mistake with its file and line and refuses keys that nobody asked for. The folder
// io turns YAML into Nodes and back; nothing here opens a file.
#pragma once

#include <Eigen/Dense>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace selfcal {

/// File and line (from 1; 0 is the file as a whole) where something stands.
struct Place {
  std::shared_ptr<const std::string> file;
  int line = 0;
};

/// "FILE:LINE", or "FILE" when the line is 0.
std::string to_string(const Place& place);

/// Nothing, a text, a list or a mapping, as the file has it.
struct Node {
  enum class Kind { none, text, list, map };
  Kind kind = Kind::none;
  std::string text;
  std::vector<Node> items;        ///< elements of a list or values of a mapping
  std::vector<std::string> keys;  ///< keys of a mapping, as many as items
  Place place;

  static Node of(std::string text);
  static Node of(double number);  ///< shortest text that reads back as the same number
  static Node of(const Eigen::VectorXd& numbers);
  static Node of(const std::vector<double>& numbers);
  static Node list();
  static Node map();

  const Node* find(std::string_view key) const;  ///< null when the mapping lacks it
  /// The mapping without these keys, what is left for somebody else to read; any other kind as is.
  Node without(const std::vector<std::string_view>& others) const;
  Node& set(std::string key, Node value);  ///< appends to a mapping; returns *this
};

/// That they say the same: numbers by value, the keys of a mapping in any order.
bool alike(const Node& a, const Node& b);

/// Mistakes found while reading; the first one is what the user is told.
struct Problems {
  std::vector<std::string> list;
  bool any() const { return !list.empty(); }
  void add(const Place& place, const std::string& what);
};

inline constexpr double kLongestPart = 50;      ///< m: no link, tool or gauge is longer
inline constexpr double kFarthestPlace = 1000;  ///< m, from the world's origin
/// C, of a robot at work: in a freezer -30; a motor's winding switches off before, and kelvin of a
/// workshop are more.
inline constexpr double kColdest = -100, kHottest = 150;
inline constexpr double kMostTurned = 8 * std::numbers::pi;  ///< rad: more turns than any wrist has

/// The surface that the tool touches.
enum class TouchedSurface { none, plane, curved };

/// Reads the fields of one mapping. A getter of a missing or broken field returns its fallback
/// and notes the problem, so that a reader runs straight through and is judged at its end.
class Fields {
 public:
  /// `what` names the mapping in messages ("frame j2"). A node that is no mapping is a problem.
  Fields(const Node& node, std::string what, Problems& problems);

  bool has(std::string_view key);
  const Node* node(std::string_view key);  ///< null when missing; counts as asked for

  std::string text(std::string_view key, std::string fallback);
  std::string text(std::string_view key);  ///< required
  double number(std::string_view key, double fallback);
  double number(std::string_view key);  ///< required
  /// From `least` to `most`.
  double number(std::string_view key, double fallback, double least, double most);
  std::optional<double> optional_number(std::string_view key);
  double positive(std::string_view key, double fallback);
  /// Metres, of a magnitude up to `most`: millimetres are guessed beyond it.
  double length(std::string_view key, double fallback, double most = kLongestPart);
  /// Radians, up to kMostTurned either way: degrees are guessed beyond it.
  double angle(std::string_view key, double fallback);
  int integer(std::string_view key, int fallback, int least, int most);
  bool flag(std::string_view key, bool fallback);
  /// A list of exactly `size` finite numbers; nothing when missing.
  std::optional<Eigen::VectorXd> numbers(std::string_view key, int size);
  /// One positive number or a list of them (`what` they are, in the message); none when missing.
  std::vector<double> positives(std::string_view key, const std::string& what);
  std::vector<std::string> texts(std::string_view key);

  void fail(std::string_view key, const std::string& expected);
  /// Refuses a key that others have and this mapping says in another way: `instead`.
  void refuse(std::string_view key, const std::string& instead);
  /// Notes every key of the mapping that no getter has asked for.
  void refuse_unknown();

  const std::string& what() const { return what_; }
  const Place& place() const { return node_.place; }

 private:
  const Node& node_;
  std::string what_;
  Problems& problems_;
  std::set<std::string, std::less<>> asked_;
};

/// The whole of `text` as a finite number, else nothing; a zero has no sign.
std::optional<double> parse_number(std::string_view text);

/// A number as a person writes it: one that parse_number reads, or a part of pi, [sign] [NUMBER *]
/// pi [/ NUMBER] with blanks around * and / at will: pi, -pi/2, 3*pi/4. Else nothing.
std::optional<double> written_number(std::string_view text);

/// Shortest decimal text that reads back as exactly `number`.
std::string format_number(double number);

}  // namespace selfcal
