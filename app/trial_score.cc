// selfcal trial score: opens the truth, which must be the one that was sealed, and prints the
// table.
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/command.h"
#include "app/trial.h"
#include "io/file.h"

namespace selfcal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The truth as it was sealed, `hash` being what was published of it.
Result<std::string> unsealed(const fs::path& folder, const std::string& hash) {
  auto text = read_file(folder / kTruthFile, kMostTrialBytes);
  if (text && hash != sha256_hex(*text))
    return bad_input((folder / kTruthFile).string() + ": is not the truth that was sealed: " +
                     kTruthHash + " says " + hash + ", the file has " + sha256_hex(*text));
  return text;
}

void print(const std::vector<ScoreLine>& lines) {
  std::printf("%-64s %9s  %6s  %s\n", "", "trials", "", "wanted");
  for (const ScoreLine& line : lines) {
    const std::string trials = line.count
                                   ? std::to_string(*line.count) + "/" + std::to_string(line.of)
                                   : std::to_string(line.of);
    char value[16] = "-";
    if (line.value) std::snprintf(value, sizeof value, "%.3f", *line.value);
    std::printf("%-64s %9s  %6s  %s %.2f%s\n", line.what.c_str(), trials.c_str(), value,
                line.at_most ? "<=" : ">=", line.target,
                !line.value || line.met() ? "" : "  missed");
  }
}

Json to_json(const std::vector<ScoreLine>& lines) {
  Json all = Json::object();
  for (const ScoreLine& line : lines)
    all[line.name] = {{"what", line.what},
                      {"trials", line.of},
                      {"count", line.count ? Json(*line.count) : Json()},
                      {"value", line.value ? Json(*line.value) : Json()},
                      {line.at_most ? "at_most" : "at_least", line.target},
                      {"met", line.value ? Json(line.met()) : Json()}};
  return all;
}

}  // namespace

int score_trials(const ScoreArguments& arguments) {
  const fs::path folder(arguments.folder);
  const auto hash = published_hash(folder);
  if (!hash) return tell(hash.error());
  const auto truth = unsealed(folder, *hash);
  if (!truth) return tell(truth.error());
  const auto truths = parse_truths(*truth, (folder / kTruthFile).string());
  if (!truths) return tell(truths.error());
  const auto text = read_file(arguments.answers, kMostTrialBytes);
  if (!text) return tell(text.error());
  const auto answers = parse_answers(*text, arguments.answers);
  if (!answers) return tell(answers.error());
  if (!answers->sealed.empty() && answers->sealed != *hash)
    return tell({kInputIsBad, arguments.answers + ": answers trials that were sealed as " +
                                  answers->sealed + ", not these"});
  const std::vector<ScoreLine> lines = score(*truths, answers->answers);
  if (arguments.json)
    std::printf("%s\n", to_json(lines).dump(1).c_str());
  else
    print(lines);
  for (const ScoreLine& line : lines)
    if (line.value && !line.met()) return kAnswerIsNo;
  return kDone;
}

}  // namespace selfcal
