#include "app/commands/support/suggestion.h"

#include <algorithm>

namespace selfcal {
namespace {

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

std::vector<const CLI::App*> subcommands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string meant(const std::string& typed, const std::vector<std::string>& known) {
  const std::string nearest = nearest_word(typed, known);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
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

std::string unknown_word(const CLI::App& app, const std::vector<std::string>& arguments) {
  const CLI::App* at = &app;
  for (const std::string& word : arguments) {
    if (word == "--") return "";
    if (word.starts_with("--")) {
      const std::string option = word.substr(0, word.find('='));
      if (at->get_option_no_throw(option)) continue;
      std::vector<std::string> known;
      for (const CLI::Option* each : at->get_options())
        for (const std::string& name : each->get_lnames()) known.push_back("--" + name);
      return at->get_name() + " has no option '" + option + "'" + meant(option, known);
    }
    const std::vector<const CLI::App*> below = subcommands(*at);
    if (word.starts_with("-") || below.empty()) continue;
    const auto found = std::ranges::find(below, word, &CLI::App::get_name);
    if (found == below.end()) {
      std::vector<std::string> known;
      for (const CLI::App* each : below) known.push_back(each->get_name());
      return at->get_name() + " has no command '" + word + "'" + meant(word, known);
    }
    at = *found;
  }
  return "";
}

}  // namespace selfcal
