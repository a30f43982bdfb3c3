// YAML to Nodes. yaml-cpp throws and keeps duplicate keys; here every mistake becomes a Failure
// with its line. Aliases are followed, so the tree is bounded in depth (a node may contain itself)
// and in size (a few lines of aliases can stand for billions of nodes).
#include "io/files/yaml.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "io/files/file.h"
#include "io/files/utf8.h"

namespace selfcal {
namespace {

constexpr int kMostNodes = 1 << 20;
constexpr int kDeepest = 64;

/// Turns yaml-cpp's nodes into ours, noting the first mistake.
class Converter {
 public:
  explicit Converter(const std::string& name) : file_(std::make_shared<const std::string>(name)) {}

  Node convert(const YAML::Node& source, int depth) {
    Node node;
    node.place = place(source.Mark());
    if (!within_bounds(node.place, depth)) return node;
    if (source.IsScalar()) {
      node.kind = Node::Kind::text;
      node.text = source.Scalar();
    } else if (source.IsSequence()) {
      node.kind = Node::Kind::list;
      for (const YAML::Node& item : source) {
        node.items.push_back(convert(item, depth + 1));
        if (problems_.any()) break;
      }
    } else if (source.IsMap()) {
      node.kind = Node::Kind::map;
      convert_entries(source, depth, node);
    }
    return node;
  }

  Place place(const YAML::Mark& mark) const { return {file_, mark.is_null() ? 0 : mark.line + 1}; }
  Problems& problems() { return problems_; }

 private:
  bool within_bounds(const Place& place, int depth) {
    if (depth > kDeepest) {
      problems_.add(place, "nested deeper than " + std::to_string(kDeepest) + " levels");
    } else if (++nodes_ > kMostNodes) {
      problems_.add(place, "more than " + std::to_string(kMostNodes) + " values");
    }
    return !problems_.any();
  }

  void convert_entries(const YAML::Node& source, int depth, Node& node) {
    std::set<std::string> seen;
    for (const auto& entry : source) {
      const Place where = place(entry.first.Mark());
      if (!entry.first.IsScalar()) return problems_.add(where, "expected a text for a key");
      const std::string& key = entry.first.Scalar();
      if (!seen.insert(key).second) return problems_.add(where, "key '" + key + "' appears twice");
      Node value = convert(entry.second, depth + 1);
      if (problems_.any()) return;
      if (value.kind == Node::Kind::none) value.place = where;
      node.set(key, std::move(value));
    }
  }

  std::shared_ptr<const std::string> file_;
  Problems problems_;
  int nodes_ = 0;
};

/// `text` as yaml-cpp is to read it: it takes the file's end for the end of an open quotation, but
/// refuses the mark of a new document inside one, so such a mark goes below the text.
std::string marked(std::string_view text) {
  return std::string(text) + (text.ends_with('\n') ? "" : "\n") + "---\n";
}

/// Counts documents, and where the last one begins.
class Documents : public YAML::EventHandler {
 public:
  int count = 0;
  YAML::Mark last = YAML::Mark::null_mark();

  void OnDocumentStart(const YAML::Mark& mark) override {
    ++count;
    last = mark;
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

/// Notes the problem unless `text`, marked, has one document. May throw, as yaml-cpp does. At what
/// begins no value, a comma between no brackets, it begins one document after the other.
void expect_one_document(const std::string& text, Converter& converter) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Documents documents;
  for (int before = -1; parser.HandleNextDocument(documents); before = documents.last.pos)
    if (documents.last.pos == before)
      return converter.problems().add(converter.place(documents.last),
                                      "is not valid YAML: expected `key: value` lines");
  const Place whole = converter.place(YAML::Mark::null_mark());
  if (documents.count > 2)
    converter.problems().add(whole,
                             "expected one document, got " + std::to_string(documents.count - 1));
}

/// May throw, as yaml-cpp does.
Node parse_document(const std::string& text, Converter& converter) {
  Node whole;
  whole.place = converter.place(YAML::Mark::null_mark());
  Problems& problems = converter.problems();
  expect_one_document(text, converter);
  if (problems.any()) return whole;
  const YAML::Node document = YAML::Load(text);
  if (document.IsNull()) {
    problems.add(whole.place, "is empty");
  } else if (!document.IsMap()) {
    problems.add(converter.place(document.Mark()), "expected `key: value` lines");
  } else {
    whole = converter.convert(document, 1);
  }
  return whole;
}

/// `text` with quotation marks about every `HEADER [UNIT]` between braces, which YAML asks for and
/// people leave out; nothing where none lacks them. Lines stay what they are.
std::optional<std::string> with_units_quoted(std::string_view text) {
  std::string quoted;
  std::size_t done = 0;
  for (std::size_t colon = text.find(": "); colon != std::string_view::npos;
       colon = text.find(": ", colon + 1)) {
    const std::size_t begin = text.find_first_not_of(' ', colon + 1);
    const std::size_t open = text.find_first_of("\"'{}[],#\n", begin);
    if (open == std::string_view::npos || open == begin || text[open] != '[') continue;
    const std::size_t close = text.find_first_of("\"'{}[],#\n", open + 1);
    if (close == std::string_view::npos || text[close] != ']') continue;
    const std::size_t next = text.find_first_not_of(' ', close + 1);
    if (next == std::string_view::npos || (text[next] != ',' && text[next] != '}')) continue;
    quoted.append(text.substr(done, begin - done))
        .append("\"")
        .append(text.substr(begin, close + 1 - begin))
        .append("\"");
    done = close + 1;
    colon = close;
  }
  if (done == 0) return std::nullopt;
  return quoted.append(text.substr(done));
}

}  // namespace

Result<Node> parse_yaml(std::string_view text, const std::string& name) {
  Converter converter(name);
  Problems& problems = converter.problems();
  if (!is_text(text)) return bad_input(name + ": expected UTF-8 text, got other bytes");
  if (first_of(text) == '<')
    return bad_input(name + ":1: is XML where YAML is expected; `selfcal robot convert " + name +
                     "` makes a robot file of a URDF");
  try {
    Node node = parse_document(marked(text), converter);
    if (!problems.any()) return node;
  } catch (const YAML::Exception& exception) {
    if (const auto quoted = with_units_quoted(text)) return parse_yaml(*quoted, name);
    problems.add(converter.place(exception.mark), "is not valid YAML: " + exception.msg);
  } catch (const std::exception& exception) {
    problems.add(converter.place(YAML::Mark::null_mark()), exception.what());
  }
  return bad_input(problems);
}

Result<Node> read_yaml(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path, kMostYamlBytes);
  if (!text) return tl::unexpected(text.error());
  return parse_yaml(*text, path.string());
}

}  // namespace selfcal
