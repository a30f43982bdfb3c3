// Truths and answers as JSON.
#include <algorithm>
#include <cmath>

#include "app/commands/trials/trial.h"
#include "io/files/file.h"
#include "io/files/json_parts.h"
#include "io/files/utf8.h"
#include "kinematics/readable.h"

namespace selfcal {
namespace {

std::string text_or_empty(const Json& node, const char* key) {
  const auto found = node.find(key);
  return found != node.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::optional<double> number(const Json& node, const char* key) {
  const auto found = node.find(key);
  if (found == node.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::vector<std::string> texts(const Json& node, const char* key) {
  std::vector<std::string> out;
  if (const auto found = node.find(key); found != node.end() && found->is_array())
    for (const Json& each : *found)
      if (each.is_string()) out.push_back(each.get<std::string>());
  return out;
}

Json number_or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json cause_json(const TrialCauseNamed& cause) {
  return {{"effect", cause.effect},
          {"where", cause.where},
          {"probability", cause.probability},
          {"confounded_with", cause.confounded_with}};
}

TrialCauseNamed cause_of(const Json& node) {
  return {text_or_empty(node, "effect"), texts(node, "where"),
          number(node, "probability").value_or(0), texts(node, "confounded_with")};
}

TrialTruth truth_of(const Json& node) {
  TrialTruth truth;
  truth.effect = text_or_empty(node, "effect");
  truth.second = text_or_empty(node, "second");
  truth.r = number(node, "r").value_or(0);
  truth.told_closed = number(node, "told_closed");
  if (const auto where = node.find("where"); where != node.end() && where->is_object())
    for (const auto& [effect, places] : where->items())
      truth.where[effect] = texts(*where, effect.c_str());
  return truth;
}

TrialAnswer answer_of(const Json& node) {
  TrialAnswer answer;
  if (const auto verdict = node.find("verdict"); verdict != node.end())
    answer.verdict = cause_of(*verdict);
  if (const auto list = node.find("candidates"); list != node.end() && list->is_array())
    for (const Json& each : *list) answer.candidates.push_back(cause_of(each));
  answer.closed = number(node, "closed_fraction");
  answer.seconds = number(node, "seconds").value_or(0);
  return answer;
}

/// The mapping from names to objects in `text`, or under `key` of it.
Result<Json> mapping(const std::string& text, const std::string& file, const char* key) {
  Json all = Json::parse(text, nullptr, false);
  if (all.is_discarded()) return bad_input(file + ": expected JSON");
  if (all.is_object() && key) all = all.value(key, Json());
  const auto is_object = [](const Json& each) { return each.is_object(); };
  if (!all.is_object() || !std::all_of(all.begin(), all.end(), is_object))
    return bad_input(file + ": expected an object for each trial");
  return all;
}

}  // namespace

Result<std::vector<std::string>> trial_names(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (std::filesystem::exists(entry->path() / "dataset.yaml", ignored))
      names.push_back(entry->path().filename().string());
  }
  if (error) return bad_input(folder.string() + ": cannot list the folder: " + error.message());
  if (names.empty()) return bad_input(folder.string() + ": expected folders with data sets");
  std::sort(names.begin(), names.end());
  for (const std::string& name : names)
    if (!is_text(name))
      return bad_input(folder.string() + ": the folder '" + shown(name) +
                       "' has a name that is no text (UTF-8), which no answer could be told by");
  return names;
}

Result<TrialTruths> parse_truths(const std::string& text, const std::string& file) {
  const auto all = mapping(text, file, nullptr);
  if (!all) return tl::unexpected(all.error());
  TrialTruths truths;
  for (const auto& [name, node] : all->items()) {
    truths[name] = truth_of(node);
    if (truths[name].effect.empty()) return bad_input(file + ": " + name + " has no `effect`");
  }
  return truths;
}

Result<TrialAnswerFile> parse_answers(const std::string& text, const std::string& file) {
  const auto all = mapping(text, file, "answers");
  if (!all) return tl::unexpected(all.error());
  const Json head = Json::parse(text, nullptr, false);
  TrialAnswerFile out{text_or_empty(head, "by"), text_or_empty(head, "sealed"), {}, {}};
  for (const auto& [name, node] : all->items()) {
    out.answers[name] = answer_of(node);
    if (out.answers[name].verdict.effect.empty())
      return bad_input(file + ": " + name + " has no verdict");
  }
  return out;
}

std::string answers_text(const TrialAnswerFile& file) {
  Json all = Json::object();
  for (const auto& [name, answer] : file.answers) {
    Json candidates = Json::array();
    for (const TrialCauseNamed& each : answer.candidates) candidates.push_back(cause_json(each));
    all[name] = {{"verdict", cause_json(answer.verdict)},
                 {"candidates", candidates},
                 {"closed_fraction", number_or_null(answer.closed)},
                 {"seconds", answer.seconds}};
  }
  Json whole{{"by", file.by}, {"sealed", file.sealed}, {"answers", all}};
  if (!file.unanswered.empty()) whole["unanswered"] = file.unanswered;
  return whole.dump(1) + "\n";
}

Result<std::string> published_hash(const std::filesystem::path& folder) {
  const auto text = read_file(folder / kTruthHash, 4096);
  if (!text) return text;
  return text->substr(0, text->find_first_of(" \r\n"));
}

}  // namespace selfcal
