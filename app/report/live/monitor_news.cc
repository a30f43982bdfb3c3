#include "app/report/live/monitor_news.h"

#include <cmath>

#include "app/report/format.h"
#include "app/report/live/message_json.h"
#include "io/outcome.h"

namespace selfcal {

std::string News::of(const StatusMessage& status) {
  // The phase changes ten times a second and stands in no line.
  std::string text = status.state;
  if (status.session > 0) text += printed(", session %lld", static_cast<long long>(status.session));
  if (!status.kind.empty()) text += " (" + status.kind + ")";
  if (!status.why.empty()) text += ": " + status.why;
  text += "; " + status.active + " is active";
  if (status.candidate) text += ", a result waits";
  text = one_line(text);
  if (text == status_) return {};
  return status_ = text;
}

std::string News::of(const ProgressMessage& progress) const {
  if (progress.set.empty()) return one_line(how_far(progress));
  std::string residual = in_words(progress);
  residual.erase(0, residual.find_first_not_of(' '));
  return one_line(progress.set + printed(" %u: ", progress.index) + residual + "; " +
                  how_far(progress));
}

std::string News::of(const ResultMessage& result) const {
  std::string text = printed("result of session %lld (", static_cast<long long>(result.session)) +
                     result.kind + "), " + date_time(result.unix_ms) + ": " + result.answer;
  if (parse_decision(result.decision) != ResultDecision::none) text += ", " + result.decision;
  if (const std::string numbers = figures(result); !numbers.empty()) text += "; " + numbers;
  text += "; " + counts(result);
  if (!result.why.empty()) text += "; " + result.why;
  return one_line(text);
}

std::string News::of(const HealthMessage& line) {
  const auto [known, is_new] = levels_.try_emplace(line.name, line.level);
  // A line that begins as ok is no news.
  if (known->second == line.level && !(is_new && line.level != Health::ok)) return {};
  known->second = line.level;
  return one_line(line.name + " is " + std::string(to_string(line.level)) + ": " + line.message);
}

std::string News::of_silence(const Watched& watched) {
  const bool silent = watched.silent >= kSilence;
  if (silent == silent_) return {};
  silent_ = silent;
  if (!silent) return "the service is heard again";
  if (!watched.status) return "no service of robot " + one_line(watched.robot) + " is heard";
  return "SILENT: nothing heard for " + duration(watched.silent);
}

}  // namespace selfcal
