#include "app/commands/support/suggestion.h"

#include <algorithm>

#include "io/files/near_names.h"

namespace selfcal {
namespace {

std::vector<const CLI::App*> subcommands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string meant(const std::string& typed, const std::vector<std::string>& known) {
  const std::string nearest = nearest_word(typed, known);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

}  // namespace

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
