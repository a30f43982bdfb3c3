// YAML to Nodes. yaml-cpp throws and keeps duplicate keys; here every mistake becomes a Failure
// with its line. Aliases are followed, so the tree is bounded in depth (a node may contain itself)
// and in size (a few lines of aliases can stand for billions of nodes).
#include "io/files/yaml.h"

#include <yaml-cpp/yaml.h>

#include <memory>
#include <set>
#include <utility>
#include <vector>

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

/// The documents in `text`. yaml-cpp takes the file's end for the end of an open quotation, but
/// refuses the mark of a new document inside one: such a mark goes below the text.
std::vector<YAML::Node> load(std::string_view text) {
  std::string marked(text);
  if (!text.ends_with('\n')) marked += '\n';
  std::vector<YAML::Node> documents = YAML::LoadAll(marked + "---\n");
  if (!documents.empty()) documents.pop_back();
  return documents;
}

/// May throw, as yaml-cpp does.
Node parse_document(std::string_view text, Converter& converter) {
  const std::vector<YAML::Node> documents = load(text);
  Node whole;
  whole.place = converter.place(YAML::Mark::null_mark());
  Problems& problems = converter.problems();
  if (documents.size() > 1) {
    problems.add(whole.place, "expected one document, got " + std::to_string(documents.size()));
  } else if (documents.empty() || documents.front().IsNull()) {
    problems.add(whole.place, "is empty");
  } else if (!documents.front().IsMap()) {
    problems.add(converter.place(documents.front().Mark()), "expected `key: value` lines");
  } else {
    whole = converter.convert(documents.front(), 1);
  }
  return whole;
}

}  // namespace

Result<Node> parse_yaml(std::string_view text, const std::string& name) {
  Converter converter(name);
  Problems& problems = converter.problems();
  if (!is_text(text)) return bad_input(name + ": expected UTF-8 text, got other bytes");
  try {
    Node node = parse_document(text, converter);
    if (!problems.any()) return node;
  } catch (const YAML::Exception& exception) {
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
