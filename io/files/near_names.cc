#include "io/files/near_names.h"

#include <algorithm>

namespace selfcal {
namespace {

constexpr std::size_t kShown = 12;  // columns

/// Slips between two words: the optimal string alignment distance.
std::size_t slips(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> least(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        least[i][j] = i + j;
        continue;
      }
      const bool same = a[i - 1] == b[j - 1];
      least[i][j] = std::min(
          {least[i - 1][j] + 1, least[i][j - 1] + 1, least[i - 1][j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        least[i][j] = std::min(least[i][j], least[i - 2][j - 2] + 1);
    }
  return least[a.size()][b.size()];
}

}  // namespace

std::string nearest_word(std::string_view typed, const std::vector<std::string>& known) {
  std::string nearest;
  std::size_t least = std::max<std::size_t>(1, typed.size() / 3) + 1;
  for (const std::string& each : known)
    if (const std::size_t count = slips(typed, each); count < least) {
      least = count;
      nearest = each;
    }
  return nearest;
}

std::string columns_instead(std::string_view missing, const std::vector<std::string>& columns,
                            const std::vector<std::string>& unknown) {
  std::string there = "the file has ";
  for (std::size_t i = 0; i < std::min(columns.size(), kShown); ++i)
    there += (i > 0 ? ", " : "") + columns[i];
  if (columns.size() > kShown) there += " and " + std::to_string(columns.size() - kShown) + " more";
  const std::string nearest = nearest_word(missing, unknown);
  return nearest.empty() ? there : there + " (did you mean '" + nearest + "'?)";
}

}  // namespace selfcal
