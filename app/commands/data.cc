// selfcal data check FOLDER: a first look at rows and robot, and what is likely wrong with them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "app/commands/subcommand.h"
#include "app/commands/support/file_slips.h"
#include "app/report/format.h"

namespace selfcal {
namespace {

constexpr std::size_t kShown = 3;

std::string size_of_misfit(const FirstLook& look, double left) {
  return look.lengths ? mm(left) + " mm" : mm(left) + " mrad";
}

int print_first_look(const FirstLook& look) {
  if (look.found.empty() && !std::isinf(look.left) && look.equations <= look.taken) {
    std::printf(
        "too few rows to tell whether anything is wrong: they give %d equations, and placing base, "
        "tool and surfaces takes %d\n",
        look.equations, look.taken);
    return kAnswerIsNo;
  }
  if (std::isinf(look.left)) {
    std::printf("no row is one that the robot of its file can take\n");
  } else {
    std::printf(
        "%s are left of half the rows with the robot as its file has it, base and tool placed; "
        "the maker's tolerances leave about %s\n",
        size_of_misfit(look, look.left).c_str(), size_of_misfit(look, look.expected).c_str());
  }
  if (look.found.empty() && std::isinf(look.left)) {
    std::printf(
        "none of the usual slips explains it: limits, places and units are to be looked at\n");
    return kAnswerIsNo;
  }
  if (look.found.empty()) {
    std::printf("nothing is likely wrong\n");
    return kDone;
  }
  std::printf("likely wrong: %s\n", look.found.c_str());
  if (look.tool)
    std::printf("  with the tool as its file has it %s are left; the rows put it %s mm away\n",
                size_of_misfit(look, look.tool_held).c_str(), mm(look.tool_moved).c_str());
  for (std::size_t i = 0; look.explained && i < std::min(kShown, look.tried.size()); ++i)
    std::printf("  %s where %s\n", size_of_misfit(look, look.tried[i].left).c_str(),
                look.tried[i].what.c_str());
  return kAnswerIsNo;
}

int data_check(const std::string& folder) {
  const auto loaded = load_data_set(folder);
  if (!loaded) return tell(with_likely_wrong(loaded.error(), folder));
  print_notices(*loaded);
  const std::vector<char>& check = loaded->data.rows.check;
  if (std::ranges::none_of(check, [](char each) { return each == 0; })) {
    std::printf("every row is `part: check`: none is left to look at\n");
    return kAnswerIsNo;
  }
  const auto look = look_at_files(folder, *loaded, loaded->robot);
  return look ? print_first_look(*look) : tell(look.error());
}

}  // namespace

void add_data(CLI::App& app, int& status) {
  CLI::App* data = app.add_subcommand("data", "Work on data sets");
  data->require_subcommand(1);
  auto folder = std::make_shared<std::string>();
  CLI::App* command = data->add_subcommand(
      "check", "Say what is likely wrong with rows or robot; exit 1 if anything");
  command->add_option("FOLDER", *folder, "Data set: a folder or its dataset.yaml")->required();
  command->callback([folder, &status] { status = data_check(*folder); });
}

}  // namespace selfcal
