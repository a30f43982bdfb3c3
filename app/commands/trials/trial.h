// selfcal trial: blind trials of the diagnosis. Sealed first, answered without the truth, then
// scored.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "diagnosis/trials/trials.h"
#include "io/result.h"

namespace selfcal {

struct SealArguments {
  std::vector<std::string> data_sets;  ///< given ones, whose truth is in `truth`
  std::string truth, out, robot, measure, rows;
  int make = 0;
  unsigned long long seed = 1;
};
int seal_trials(const SealArguments& arguments);

struct RunArguments {
  std::string folder, out, baseline;
  int jobs = 0;  ///< 0: as many as cores
};
int run_trials(const RunArguments& arguments);

struct ScoreArguments {
  std::string folder;
  std::vector<std::string> answers;  ///< files; the first one decides, the others stand beside it
  bool json = false;
};
int score_trials(const ScoreArguments& arguments);

inline constexpr const char* kTruthFile = "truth.json";
inline constexpr const char* kTruthHash = "TRUTH.sha256";
inline constexpr std::size_t kMostTrialBytes = std::size_t{256} << 20;

/// Folders of `folder` that hold a data set, by name.
Result<std::vector<std::string>> trial_names(const std::filesystem::path& folder);
Result<TrialTruths> parse_truths(const std::string& text, const std::string& file);

/// What `run` writes.
struct TrialAnswerFile {
  std::string by;      ///< "diagnose", or the baseline
  std::string sealed;  ///< SHA-256 that was published when the answers were given; empty: none was
  TrialAnswers answers;
  std::map<std::string, std::string> unanswered = {};  ///< why, by trial
};
Result<TrialAnswerFile> parse_answers(const std::string& text, const std::string& file);
std::string answers_text(const TrialAnswerFile& file);
/// The published SHA-256 of the truth of `folder`.
Result<std::string> published_hash(const std::filesystem::path& folder);

}  // namespace selfcal
