// selfcal trial score: opens the truth, which must be the one that was sealed, and prints the
// table.
#include <cstdio>
#include <filesystem>
#include <vector>

#include "app/commands/subcommand.h"
#include "app/commands/trials/trial.h"
#include "io/files/file.h"
#include "io/files/json_parts.h"

namespace selfcal {
namespace {

namespace fs = std::filesystem;

/// The truth as it was sealed, `hash` being what was published of it.
Result<std::string> unsealed(const fs::path& folder, const std::string& hash) {
  auto text = read_file(folder / kTruthFile, kMostTrialBytes);
  if (text && hash != sha256_hex(*text))
    return bad_input((folder / kTruthFile).string() + ": is not the truth that was sealed: " +
                     kTruthHash + " says " + hash + ", the file has " + sha256_hex(*text));
  return text;
}

/// What one file of answers reaches.
struct Scored {
  std::string by;
  std::vector<ScoreLine> lines;
};

Result<Scored> scored(const std::string& file, const TrialTruths& truths, const std::string& hash) {
  const auto text = read_file(file, kMostTrialBytes);
  if (!text) return tl::unexpected(text.error());
  const auto answers = parse_answers(*text, file);
  if (!answers) return tl::unexpected(answers.error());
  if (!answers->sealed.empty() && answers->sealed != hash)
    return bad_input(file + ": answers trials that were sealed as " + answers->sealed +
                     ", not these");
  return Scored{answers->by, score(truths, answers->answers)};
}

std::string value_of(const ScoreLine& line) {
  char text[16] = "-";
  if (line.value) std::snprintf(text, sizeof text, "%.3f", *line.value);
  return text;
}

/// The first one's table, with the values of the others in columns of their own.
void print_scores(const std::vector<Scored>& all) {
  const std::vector<ScoreLine>& lines = all.front().lines;
  std::printf("%-64s %9s", "", "trials");
  for (const Scored& each : all) std::printf("  %10s", each.by.c_str());
  std::printf("  wanted\n");
  for (size_t i = 0; i < lines.size(); ++i) {
    const ScoreLine& line = lines[i];
    const std::string trials = line.count
                                   ? std::to_string(*line.count) + "/" + std::to_string(line.of)
                                   : std::to_string(line.of);
    std::printf("%-64s %9s", line.what.c_str(), trials.c_str());
    for (const Scored& each : all) std::printf("  %10s", value_of(each.lines[i]).c_str());
    std::printf("  %s %.2f%s\n", line.at_most ? "<=" : ">=", line.target,
                !line.value || line.met() ? "" : "  missed");
  }
}

Json scores_json(const std::vector<Scored>& all) {
  Json json = Json::object();
  const std::vector<ScoreLine>& lines = all.front().lines;
  for (size_t i = 0; i < lines.size(); ++i) {
    const ScoreLine& line = lines[i];
    const auto number = [](const ScoreLine& of) { return of.value ? Json(*of.value) : Json(); };
    json[line.name] = {{"what", line.what},
                       {"trials", line.of},
                       {"count", line.count ? Json(*line.count) : Json()},
                       {"value", number(line)},
                       {line.at_most ? "at_most" : "at_least", line.target},
                       {"met", line.value ? Json(line.met()) : Json()}};
    for (size_t other = 1; other < all.size(); ++other)
      json[line.name]["beside"][all[other].by] = number(all[other].lines[i]);
  }
  return json;
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
  std::vector<Scored> all;
  for (const std::string& file : arguments.answers) {
    auto one = scored(file, *truths, *hash);
    if (!one) return tell(one.error());
    all.push_back(*std::move(one));
  }
  if (arguments.json)
    std::printf("%s\n", scores_json(all).dump(1).c_str());
  else
    print_scores(all);
  for (const ScoreLine& line : all.front().lines)
    if (line.value && !line.met()) return kAnswerIsNo;
  return kDone;
}

}  // namespace selfcal
