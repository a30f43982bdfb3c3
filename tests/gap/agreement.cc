// Whether parts of one real data set tell the same: every part answers alone, and what it names is
// judged on the rows of the others. Halves in turn, halves and thirds in time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <tuple>

#include "diagnosis/diagnosis.h"
#include "io/files/data_set_file.h"
#include "tests/shared_data.h"

namespace selfcal {
namespace {

constexpr double kCertain = 0.9;  // from which an answer must carry over

/// By row, the part of `parts` that its configuration falls into: in turn, or one after the other
/// in the order of the rows. Rows of one group (pairs, shared points) or repeat stay together.
std::vector<int> parts_of(const Observations& rows, int parts, bool in_turn) {
  std::map<std::pair<int, int>, int> known;
  std::vector<int> unit;
  for (int row = 0; row < rows.rows(); ++row) {
    const int repeat = rows.repeat.empty() ? -1 : rows.repeat[row];
    const int tied = rows.group[row] >= 0 ? 2 * rows.group[row] + 1 : repeat >= 0 ? 2 * repeat : -1;
    const std::pair<int, int> key = tied >= 0 ? std::pair(rows.set[row], tied) : std::pair(-1, row);
    unit.push_back(known.try_emplace(key, static_cast<int>(known.size())).first->second);
  }
  const auto count = static_cast<int>(known.size());
  for (int& each : unit) each = in_turn ? each % parts : each * parts / count;
  return unit;
}

/// The rows of one part identify and choose, all the others judge.
Diagnosis of_part(const std::shared_ptr<const Robot>& robot, const DataSet& data,
                  const std::vector<int>& part, int own) {
  DataSet some = data;
  for (int row = 0; row < data.rows.rows(); ++row) some.rows.check[row] = part[row] != own;
  return diagnose(robot, some);
}

/// It happened at one moment: only rows on both sides of that can show it.
bool happened(const CauseResult& cause) {
  return std::ranges::any_of(cause.correction, [](const FoundEffect& found) {
    return found.what.shape.moment.has_value();
  });
}

bool is_of(const std::string& label, const std::string& effect) {
  return label.substr(0, label.find('@')) == effect;
}

/// What one part is certain of, and how it fares with another part.
struct Carried {
  int certain = 0, same = 0, placed = 0, closed = 0, judged = 0;

  void add(const Diagnosis& from, const Diagnosis& to, bool in_turn) {
    for (const CauseResult& each : from.named) {
      if (each.probability < kCertain || (!in_turn && happened(each))) continue;
      ++certain;
      const auto says = [&](const CauseResult& other) {
        const bool alike = std::ranges::any_of(
            other.confounded_with, [&](const auto& label) { return is_of(label, each.effect); });
        return other.probability > 0.5 && (other.effect == each.effect || alike);
      };
      const auto found = std::ranges::find_if(to.candidates, says);
      if (found == to.candidates.end()) continue;
      ++same;
      placed += each.where.empty() || found->effect != each.effect ||
                std::ranges::any_of(each.where, [&](const std::string& place) {
                  return std::ranges::count(found->where, place) > 0;
                });
    }
  }
};

std::string named_in_words(const Diagnosis& diagnosis) {
  if (!diagnosis.problem.empty()) return "too few rows";
  std::string words = names_effect(diagnosis.verdict.effect) ? "" : diagnosis.verdict.effect;
  for (const CauseResult& each : diagnosis.named) {
    char text[32];
    std::snprintf(text, sizeof text, " %.2f", each.probability);
    words += (words.empty() ? "" : "; ") + each.effect;
    for (const std::string& place : each.where) words += " " + place;
    words += text;
  }
  return words;
}

std::string share(const Closed& closed) {
  if (!closed.fraction) return "-";
  return std::to_string(std::lround(100 * *closed.fraction));
}

std::vector<const char*> agreeing_sets() {
  if (std::getenv("SELFCAL_ALL_SETS"))
    return {"motoman-tracker", "mukca-panda-1",  "mukca-panda-3",
            "mukca-panda-6",   "mukca-kuka-14",  "ipa-ur10-random",
            "ipa-ur10-joint",  "motoman-planes", "motoman-selfcontact"};
  return {"mukca-panda-3", "mukca-kuka-14"};
}

class Agreement : public testing::TestWithParam<const char*> {};

TEST_P(Agreement, HoldsBetweenPartsOfOneSet) {
  SELFCAL_NEED_SHARED();
  auto loaded = load_data_set(shared_dir() / "data" / GetParam());
  ASSERT_TRUE(loaded);
  const std::shared_ptr<const Robot> robot = std::move(loaded->robot);
  Carried carried;
  for (const auto& [title, parts, in_turn] :
       {std::tuple("halves in turn", 2, true), std::tuple("halves in time", 2, false),
        std::tuple("thirds in time", 3, false)}) {
    const std::vector<int> part = parts_of(loaded->data.rows, parts, in_turn);
    std::vector<Diagnosis> answers;
    for (int own = 0; own < parts; ++own) {
      answers.push_back(of_part(robot, loaded->data, part, own));
      const Diagnosis& answer = answers.back();
      std::printf("| %s | %s %d | %s | %.4g | %.4g | %.4g | %s | %s |\n", GetParam(), title,
                  own + 1, named_in_words(answer).c_str(), 1e3 * answer.gap.rms_before,
                  1e3 * answer.gap.rms_after, 1e3 * answer.gap.rms_all,
                  share(answer.gap.closed).c_str(), share(answer.gap.closed_all).c_str());
      EXPECT_LE(answer.gap.rms_all, 1.05 * answer.gap.rms_after)
          << "what leaves more of the others' rows is in the corrected model";
      if (!answer.named.empty() && answer.gap.closed.fraction) {
        ++carried.judged;
        carried.closed += *answer.gap.closed.fraction > 0;
      }
    }
    for (int a = 0; a < parts; ++a)
      for (int b = 0; b < parts; ++b)
        if (a != b) carried.add(answers[a], answers[b], in_turn);
  }
  std::printf(
      "%s: certain %d, of these the other part says the same cause %d, at the same place "
      "%d; of %d parts that name something it closes a part of the others' gap in %d\n",
      GetParam(), carried.certain, carried.same, carried.placed, carried.judged, carried.closed);
  // Nine of ten is what a probability of 0.9 promises; two sigma of so few less.
  const double promised = kCertain * carried.certain - 2 * std::sqrt(0.09 * carried.certain);
  EXPECT_GE(carried.same, promised);
  EXPECT_GE(carried.placed, promised);
  EXPECT_GE(carried.closed, 0.9 * carried.judged - 1);
}

INSTANTIATE_TEST_SUITE_P(Sets, Agreement, testing::ValuesIn(agreeing_sets()), [](const auto& each) {
  std::string name = each.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace selfcal
