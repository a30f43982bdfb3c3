// The picture has a column of titles and one of texts. Ranks: what a person must see is 0, what
// only pleases the eye is last.
#include "app/report/live/monitor_view.h"

#include <algorithm>
#include <cmath>

#include "app/report/format.h"
#include "app/report/live/message_json.h"
#include "io/outcome.h"

namespace selfcal {
namespace {

constexpr int kTitle = 10;  // width of the column of titles

enum Rank : int { kMust, kFacts, kWell, kWords, kTouches, kBlank };

std::string upper(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

Tone tone_of(Health level) {
  return level == Health::ok ? Tone::good : level == Health::warn ? Tone::warning : Tone::bad;
}

Tone tone_of(const ResultMessage& result) {
  const bool good = parse_decision(result.decision) == ResultDecision::applied ||
                    parse_answer(result.answer) == ResultAnswer::explained ||
                    parse_answer(result.answer) == ResultAnswer::no_cause;
  return good ? Tone::good : Tone::warning;
}

class Picture {
 public:
  Picture(const Watched& watched, std::int64_t now_ms, int columns)
      : watched_(watched), now_ms_(now_ms), columns_(columns) {}

  std::vector<Line> lines() {
    head();
    if (!watched_.status) return std::move(lines_);
    session();
    touches();
    result();
    parameters();
    health();
    return std::move(lines_);
  }

 private:
  void add(std::string_view title, const std::string& text, int rank, Tone tone = Tone::plain) {
    lines_.push_back({fitted(padded(title, kTitle) + one_line(text), columns_), tone, rank});
  }
  void blank() { lines_.push_back({"", Tone::plain, kBlank}); }

  void head() {
    const std::string name = padded(one_line(watched_.robot) + " ", kTitle);
    if (!watched_.status) {
      const std::string waiting = "no service heard yet, for " + duration(watched_.silent);
      const Tone tone = watched_.silent >= kSilence ? Tone::bad : Tone::plain;
      lines_.push_back({fitted(name + waiting, columns_), tone, kMust});
      return;
    }
    const StatusMessage& s = *watched_.status;
    std::string text = s.state;
    if (!s.phase.empty()) text += ", " + s.phase;
    if (s.session > 0) text += printed(", session %lld", static_cast<long long>(s.session));
    if (!s.kind.empty()) text += " (" + s.kind + ")";
    Tone tone = s.state == "fault" ? Tone::bad : Tone::strong;
    if (watched_.silent >= kSilence) {
      text = "SILENT for " + duration(watched_.silent) + "; last heard: " + text;
      tone = Tone::bad;
    }
    lines_.push_back({fitted(name + one_line(text), columns_), tone, kMust});
    if (!s.why.empty()) add("", s.why, kWords);
    add("", "the robot may " + s.hardware, kWords);
  }

  void session() {
    const StatusMessage& s = *watched_.status;
    const auto& progress = watched_.progress;
    if (!progress || progress->session != s.session || progress->planned == 0) return;
    // Before the session's own first touch, and after its end, the last progress says nothing.
    for (const char* outside : {"self-test", "idle", "planning", "awaiting-acceptance"})
      if (s.state == outside) return;
    const int width = std::clamp(columns_ - 60, 8, 30);
    const double share = std::min(1.0, static_cast<double>(progress->done) / progress->planned);
    std::string bar(static_cast<std::size_t>(width), '.');
    std::fill_n(bar.begin(), std::lround(share * width), '#');
    blank();
    add("Progress", "[" + bar + "] " + how_far(*progress), kMust);
  }

  void touches() {
    if (watched_.touches.empty()) return;
    blank();
    int wide = 8;
    for (const ProgressMessage& each : watched_.touches)
      wide = std::max(wide, characters(each.set) + 5);
    std::string_view title = "Touches";
    for (const ProgressMessage& each : watched_.touches) {
      const std::string name = one_line(each.set) + printed(" %u", each.index);
      add(title, padded(name, wide) + in_words(each), kTouches,
          each.accepted ? Tone::plain : Tone::warning);
      title = "";
    }
  }

  void result() {
    blank();
    if (!watched_.result) return add("Result", "none yet", kFacts);
    const ResultMessage& r = *watched_.result;
    std::string text = printed("session %lld (", static_cast<long long>(r.session)) + r.kind +
                       "), " + day_time(r.unix_ms, now_ms_) + ": " + r.answer;
    if (parse_decision(r.decision) != ResultDecision::none) text += ", " + r.decision;
    add("Result", text, kMust, tone_of(r));
    if (const std::string numbers = figures(r); !numbers.empty()) add("", numbers, kFacts);
    add("", counts(r), kWords);
    // The state that follows a result has its reason.
    if (!r.why.empty() && r.why != watched_.status->why) add("", r.why, kWords);
  }

  void parameters() {
    const StatusMessage& s = *watched_.status;
    std::string text = s.active;
    if (s.active_since_ms > 0)
      text += ", for " + duration(static_cast<double>(now_ms_ - s.active_since_ms) / 1000);
    if (s.candidate) text += "; a result waits: accept or reject";
    if (std::isfinite(s.temperature)) text += printed("; %.1f °C", s.temperature);
    add("Active", text, kFacts, s.candidate ? Tone::warning : Tone::plain);
    add("Next due", s.next_due_ms > 0 ? day_time(s.next_due_ms, now_ms_) : "when asked", kFacts);
  }

  void health() {
    if (watched_.health.empty()) return;
    blank();
    std::string_view title = "Health";
    for (const HealthMessage& line : watched_.health) {
      constexpr std::string_view kOurs = "selfcal: ";
      std::string name = line.name;
      if (name.starts_with(kOurs)) name.erase(0, kOurs.size());
      std::string text =
          padded(upper(to_string(line.level)), 6) + padded(name, 13) + one_line(line.message);
      std::string_view between = " (";
      for (const auto& [key, value] : line.values) {
        if (key == "hardware" || key == "session") continue;  // told above
        text += std::string(between) + key + " " + value;
        between = ", ";
      }
      if (between == ", ") text += ")";
      add(title, text, line.level == Health::ok ? kWell : kMust, tone_of(line.level));
      title = "";
    }
  }

  const Watched& watched_;
  std::int64_t now_ms_;
  int columns_;
  std::vector<Line> lines_;
};

}  // namespace

void note(Watched& watched, const StatusMessage& status) {
  watched.status = status;
  watched.silent = 0;
}

void note(Watched& watched, const ProgressMessage& progress) {
  if (watched.progress && watched.progress->session != progress.session) watched.touches.clear();
  watched.progress = progress;
  if (progress.set.empty()) return;
  watched.touches.push_back(progress);
  if (watched.touches.size() > kTouchesShown) watched.touches.pop_front();
}

void note(Watched& watched, const ResultMessage& result) { watched.result = result; }

std::string in_words(const ProgressMessage& touch) {
  if (!touch.accepted) return "put aside: " + touch.note;
  if (!std::isfinite(touch.residual)) return "taken";
  return printed("%+9.1f µm", 1e6 * touch.residual);
}

std::string how_far(const ProgressMessage& progress) {
  std::string text = printed("%u of %u touches", progress.done, progress.planned);
  if (progress.outlier > 0) text += printed(", %u put aside", progress.outlier);
  if (progress.done < progress.planned && std::isfinite(progress.seconds_left))
    text += ", " + duration(progress.seconds_left) + " left";
  if (progress.set.empty() && !progress.note.empty()) text += ": " + progress.note;
  return text;
}

std::string figures(const ResultMessage& result) {
  if (parse_answer(result.answer) == ResultAnswer::failed) return {};
  const std::string p = std::isfinite(result.p_value) ? printed(", p = %.2g", result.p_value) : "";
  if (result.kind == "check")
    return "check " + mm(result.check_after) + " mm where " + mm(result.check_before) +
           " mm are expected" + p;
  if (result.kind == "cause" && result.cause.empty())
    return "nothing is named; calibrated " + mm(result.check_before) + " mm" + p;
  if (result.kind == "cause")
    return result.cause + printed(" (probability %.2f); ", result.cause_probability) +
           "calibrated " + mm(result.check_before) + " mm, with the cause in the model " +
           mm(result.check_after) + " mm" + p;
  return "check " + mm(result.check_before) + " mm before, " + mm(result.check_after) +
         " mm after; end position " + mm(result.endpoint_sigma) + " mm (1 sigma)" + p;
}

std::string counts(const ResultMessage& result) {
  std::string text = printed("%u touches", result.touches);
  if (result.outliers > 0) text += printed(", %u put aside", result.outliers);
  if (result.identified > 0) text += printed(", %u parameters", result.identified);
  return text;
}

std::vector<Line> picture(const Watched& watched, std::int64_t now_ms, int columns, int rows) {
  std::vector<Line> lines = Picture(watched, now_ms, columns).lines();
  while (static_cast<int>(lines.size()) > std::max(rows, 1)) {
    const auto least = std::ranges::max_element(lines, {}, &Line::rank);
    lines.erase(least->rank > kMust ? least : lines.end() - 1);
  }
  return lines;
}

std::string painted(const Line& line) {
  constexpr const char* kBefore[] = {"", "\033[1m", "\033[32m", "\033[33m", "\033[1;31m"};
  if (line.tone == Tone::plain) return line.text;
  return kBefore[static_cast<std::size_t>(line.tone)] + line.text + "\033[0m";
}

}  // namespace selfcal
