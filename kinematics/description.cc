// Trees of what a person wrote, and the reading of their fields with the place of each mistake.
#include "kinematics/description.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinematics/readable.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostQuoted = 40;  // characters of a wrong value that a message repeats

std::string found(const Node* node) {
  if (node == nullptr) return "nothing";
  switch (node->kind) {
    case Node::Kind::none:
      return "nothing";
    case Node::Kind::list:
      return "a list of " + std::to_string(node->items.size());
    case Node::Kind::map:
      return "a mapping";
    case Node::Kind::text:
      break;
  }
  if (node->text.size() <= kMostQuoted) return "'" + node->text + "'";
  return "'" + node->text.substr(0, kMostQuoted) + "...'";
}

std::optional<double> number_of(const Node* node) {
  if (node == nullptr || node->kind != Node::Kind::text) return std::nullopt;
  return written_number(node->text);
}

}  // namespace

std::string to_string(const Place& place) {
  const std::string file = place.file ? *place.file : "(no file)";
  return place.line > 0 ? file + ":" + std::to_string(place.line) : file;
}

Node Node::of(std::string text) {
  Node node;
  node.kind = Kind::text;
  node.text = std::move(text);
  return node;
}

Node Node::of(double number) { return of(format_number(number)); }

Node Node::of(const Eigen::VectorXd& numbers) {
  Node node = list();
  for (const double number : numbers) node.items.push_back(of(number));
  return node;
}

Node Node::of(const std::vector<double>& numbers) {
  return of(Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(
      numbers.data(), static_cast<Eigen::Index>(numbers.size()))));
}

Node Node::list() {
  Node node;
  node.kind = Kind::list;
  return node;
}

Node Node::map() {
  Node node;
  node.kind = Kind::map;
  return node;
}

const Node* Node::find(std::string_view key) const {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] == key) return &items[i];
  }
  return nullptr;
}

Node Node::without(const std::vector<std::string_view>& others) const {
  if (kind != Kind::map) return *this;
  Node rest = map();
  rest.place = place;
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (std::ranges::find(others, keys[i]) == others.end()) rest.set(keys[i], items[i]);
  return rest;
}

Node& Node::set(std::string key, Node value) {
  keys.push_back(std::move(key));
  items.push_back(std::move(value));
  return *this;
}

void Problems::add(const Place& place, const std::string& what) {
  list.push_back(to_string(place) + ": " + what);
}

bool alike(const Node& a, const Node& b) {
  if (a.kind != b.kind || a.items.size() != b.items.size()) return false;
  if (a.kind == Node::Kind::map)
    return std::ranges::all_of(a.keys, [&](const std::string& key) {
      const Node* other = b.find(key);
      return other != nullptr && alike(*a.find(key), *other);
    });
  if (a.kind == Node::Kind::list) return std::ranges::equal(a.items, b.items, alike);
  if (a.text == b.text) return true;
  const std::optional<double> one = number_of(&a), other = number_of(&b);
  return one && other && *one == *other;
}

Fields::Fields(const Node& node, std::string what, Problems& problems)
    : node_(node), what_(std::move(what)), problems_(problems) {
  if (node_.kind != Node::Kind::map) {
    problems_.add(node_.place, what_ + ": expected a mapping, got " + found(&node_));
  }
}

const Node* Fields::node(std::string_view key) {
  asked_.emplace(key);
  return node_.find(key);
}

bool Fields::has(std::string_view key) { return node(key) != nullptr; }

std::string Fields::text(std::string_view key, std::string fallback) {
  const Node* value = node(key);
  if (value == nullptr) return fallback;
  if (value->kind == Node::Kind::text && !has_control(value->text)) return value->text;
  fail(key, value->kind == Node::Kind::text ? "a text without control characters" : "a text");
  return fallback;
}

std::string Fields::text(std::string_view key) {
  if (!has(key)) fail(key, "a text");
  return text(key, std::string());
}

double Fields::number(std::string_view key, double fallback) {
  return optional_number(key).value_or(fallback);
}

double Fields::number(std::string_view key) {
  if (!has(key)) fail(key, "a number");
  return number(key, 0.0);
}

std::optional<double> Fields::optional_number(std::string_view key) {
  const Node* value = node(key);
  if (value == nullptr) return std::nullopt;
  const std::optional<double> number = number_of(value);
  if (!number) fail(key, "a number");
  return number;
}

double Fields::positive(std::string_view key, double fallback) {
  const std::optional<double> value = optional_number(key);
  if (!value) return fallback;
  if (*value > 0) return *value;
  fail(key, "a positive number");
  return fallback;
}

double Fields::number(std::string_view key, double fallback, double least, double most) {
  const double value = number(key, fallback);
  if (value >= least && value <= most) return value;
  fail(key, "a number from " + format_number(least) + " to " + format_number(most));
  return fallback;
}

double Fields::length(std::string_view key, double fallback, double most) {
  const double value = number(key, fallback);
  if (std::abs(value) <= most) return value;
  fail(key, "metres, at most " + format_number(most) + " (millimetres?)");
  return fallback;
}

double Fields::angle(std::string_view key, double fallback) {
  const double value = number(key, fallback);
  if (std::abs(value) <= kMostTurned) return value;
  fail(key, "radians, at most four turns (degrees?)");
  return fallback;
}

int Fields::integer(std::string_view key, int fallback, int least, int most) {
  const Node* value = node(key);
  if (value == nullptr) return fallback;
  const std::optional<double> number = number_of(value);
  if (number && std::trunc(*number) == *number && *number >= least && *number <= most) {
    return static_cast<int>(*number);
  }
  fail(key, "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return fallback;
}

bool Fields::flag(std::string_view key, bool fallback) {
  const Node* value = node(key);
  if (value == nullptr) return fallback;
  if (value->kind == Node::Kind::text && value->text == "true") return true;
  if (value->kind == Node::Kind::text && value->text == "false") return false;
  fail(key, "true or false");
  return fallback;
}

std::optional<Eigen::VectorXd> Fields::numbers(std::string_view key, int size) {
  const Node* value = node(key);
  if (value == nullptr) return std::nullopt;
  const std::string expected = "a list of " + std::to_string(size) + " numbers";
  if (value->kind != Node::Kind::list || std::cmp_not_equal(value->items.size(), size)) {
    fail(key, expected);
    return std::nullopt;
  }
  Eigen::VectorXd numbers(size);
  for (int i = 0; i < size; ++i) {
    const Node& item = value->items[static_cast<std::size_t>(i)];
    const std::optional<double> number = number_of(&item);
    if (!number) {
      problems_.add(item.place, what_ + ": key '" + std::string(key) + "': expected " + expected +
                                    ", got " + found(&item) + " among them");
      return std::nullopt;
    }
    numbers[i] = *number;
  }
  return numbers;
}

std::vector<double> Fields::positives(std::string_view key, const std::string& what) {
  const Node* value = node(key);
  if (value == nullptr) return {};
  std::vector<double> numbers;
  const auto take = [&](const Node& item) {
    const auto number =
        item.kind == Node::Kind::text ? written_number(item.text) : std::optional<double>();
    if (number && *number > 0)
      numbers.push_back(*number);
    else
      fail(key, "a positive number of " + what + ", or a list of them");
  };
  if (value->kind == Node::Kind::list)
    for (const Node& item : value->items) take(item);
  else
    take(*value);
  if (value->kind == Node::Kind::list && value->items.empty())
    fail(key, "at least one number of " + what);
  return numbers;
}

std::vector<std::string> Fields::texts(std::string_view key) {
  const Node* value = node(key);
  if (value == nullptr) return {};
  std::vector<std::string> texts;
  bool all_texts = value->kind == Node::Kind::list;
  for (const Node& item : value->items) {
    all_texts = all_texts && item.kind == Node::Kind::text && !has_control(item.text);
    texts.push_back(item.text);
  }
  if (all_texts) return texts;
  fail(key, "a list of texts");
  return {};
}

void Fields::fail(std::string_view key, const std::string& expected) {
  if (node_.kind != Node::Kind::map) return;  // noted once, when the reading began
  const std::string subject = what_ + ": key '" + std::string(key) + "'";
  const Node* value = node(key);
  if (value == nullptr) {
    problems_.add(node_.place, subject + " is missing: expected " + expected);
  } else {
    problems_.add(value->place, subject + ": expected " + expected + ", got " + found(value));
  }
}

void Fields::refuse(std::string_view key, const std::string& instead) {
  if (const Node* value = node_.find(key))
    problems_.add(value->place, what_ + ": unknown key '" + std::string(key) + "': " + instead);
}

void Fields::refuse_unknown() {
  std::string known;
  for (const std::string& key : asked_) known += (known.empty() ? "" : ", ") + key;
  for (std::size_t i = 0; i < node_.keys.size(); ++i) {
    if (asked_.contains(node_.keys[i])) continue;
    problems_.add(node_.items[i].place,
                  what_ + ": unknown key '" + node_.keys[i] + "'; known: " + known);
  }
}

}  // namespace selfcal
