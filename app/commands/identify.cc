// selfcal identify DATASET: identifies, tells, and writes report.html, result.json and
// calibrated.robot.yaml.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>

#include "app/commands/subcommand.h"
#include "app/commands/support/circle_robot.h"
#include "app/commands/support/file_slips.h"
#include "app/commands/support/leg_start.h"
#include "app/report/format.h"
#include "app/report/page/identification_page.h"
#include "app/report/progress_line.h"
#include "app/report/summary.h"
#include "constraints/estimation/controller_sigma.h"
#include "constraints/estimation/engagements.h"
#include "constraints/measurement_context.h"
#include "diagnosis/evidence/usual_masses.h"
#include "diagnosis/search/shapes.h"
#include "io/files/data_set_file.h"
#include "io/files/file.h"
#include "io/files/robot_file.h"
#include "io/files/solution_json.h"
#include "kinematics/corrected_robot.h"

namespace selfcal {
namespace {

struct IdentifyArguments {
  std::string data_set, out;
  Options options;
  std::vector<std::string> effects;
  bool json = false;
};

/// The first name that no parameter has, or empty.
std::string unknown_name(const Robot& robot, const Options& options) {
  for (const auto* names : {&options.fix, &options.free})
    for (const std::string& name : *names)
      if (match_parameters(robot, name).empty()) return name;
  return {};
}

Result<void> write_solution(const IdentifyArguments& arguments, const Robot& robot,
                            const LoadedDataSet& loaded, const Solution& solution,
                            const std::string& json, const std::string& robot_file) {
  const std::filesystem::path out(arguments.out);
  const PageSubject subject{robot, loaded.data, loaded.name, unix_now_ms()};
  if (auto done = write_file_atomically(out / "report.html",
                                        page_of(identification_data(subject, solution)));
      !done)
    return done;
  if (auto done = write_file_atomically(out / "result.json", json + "\n"); !done) return done;
  return write_file_atomically(out / "calibrated.robot.yaml", robot_file);
}

/// Whether the effect of a robot file's `entry` is one of those asked for (EFFECT or EFFECT@PLACE).
bool is_requested(const Node& entry, const std::vector<std::string>& requested) {
  const std::string effect = entry.find("effect")->text;
  const Node* at = entry.find("at");
  return std::ranges::count(requested, effect) > 0 ||
         (at && std::ranges::count(requested, effect + "@" + at->text) > 0);
}

/// The robot of a data set with the effects that are asked for beside its own, or why not.
tl::expected<std::shared_ptr<const Robot>, std::string> with_effects(
    std::shared_ptr<const Robot> robot, const DataSet& data, const IdentifyArguments& arguments) {
  if (arguments.effects.empty()) return robot;
  ChosenEffects chosen = choose_effects(robot, data, arguments.effects);
  if (!chosen.problem.empty()) return tl::unexpected(chosen.problem);
  if (data.order_is_time)
    std::fputs("note: the rows carry no time: their order is taken for it\n", stderr);
  Problems problems;
  const auto geometry = with_mass_of_its_size(geometry_of(robot));
  std::vector<Node> entries = effect_entries(*robot);
  std::erase_if(entries, [&](const Node& each) { return is_requested(each, arguments.effects); });
  std::ranges::transform(chosen.effects, std::back_inserter(entries), entry_of);
  std::shared_ptr<const Robot> corrected =
      correct(geometry, entries, context_of(*geometry, data), problems);
  if (!corrected) return tl::unexpected(problems.list.front());
  return corrected;
}

/// Where the maker's robot is far from the rows, says first what is likely wrong with the files.
void look_first(const std::string& path, const LoadedDataSet& loaded,
                const std::shared_ptr<const Robot>& as_filed, const Robot& robot,
                Solution& solution) {
  if (solution.sets.empty()) return;
  const Figures& before = solution.residual.fit;
  const std::string wrong = likely_wrong(path, loaded, as_filed,
                                         {before.rms_before, !before.angle_alone, robot,
                                          solution.values, 0, before.angle.rms_after})
                                .words;
  if (!wrong.empty()) solution.warnings.insert(solution.warnings.begin(), wrong);
}

int identify_command(const IdentifyArguments& arguments) {
  auto loaded = load_data_set(arguments.data_set);
  if (!loaded) return tell(with_likely_wrong(loaded.error(), arguments.data_set));
  print_notices(*loaded);
  std::optional<CircleRobot> circles;
  if (of_circles_alone(loaded->data)) {
    auto found = circle_robot(*loaded);
    if (!found) return tell(found.error());
    circles = std::move(*found);
    loaded->robot = circles->robot;
  }
  auto by_legs = leg_start(*loaded);
  if (!by_legs) return tell(by_legs.error());
  if (*by_legs) {
    std::fprintf(
        stderr,
        "note: with the file's figures the loops of %s do not close where it was measured: "
        "it is identified from what its chains say one by one\n",
        loaded->robot->name().c_str());
    loaded->robot = std::move(*by_legs);
  }
  const std::shared_ptr<const Robot> as_filed = loaded->robot;
  const auto model = with_effects(as_filed, loaded->data, arguments);
  if (!model) return wrong_usage(model.error());
  const Robot& robot = **model;
  Options options = arguments.options;
  if (!arguments.effects.empty())
    for (const Parameter& p : robot.parameters())
      if (p.part == Part::effect) options.free.push_back(p.name);
  if (const std::string name = unknown_name(robot, options); !name.empty())
    return wrong_usage("no parameter of " + robot.name() + " is called '" + name +
                       "'; its names are like " + name_example(robot) + ", * stands for any text");
  if (const auto both = std::ranges::find_first_of(options.fix, arguments.options.free);
      both != options.fix.end())
    return wrong_usage("'" + *both + "' is both fixed and freed");
  if (!arguments.out.empty())
    if (const auto made = make_folder(arguments.out); !made) return tell(made.error());
  Solution solution;
  {
    ProgressLine line;
    Engagements found = identify_engagements(
        robot, std::move(loaded->data), options,
        [&](std::string_view stage, double share) { line.show(stage, share); });
    solution = std::move(found.solution);
    loaded->data = std::move(found.data);
  }
  if (circles)
    compare_with_file(*circles, solution);
  else
    look_first(arguments.data_set, *loaded, as_filed, robot, solution);
  nlohmann::ordered_json result = to_json(solution, robot.name(), model_hash(robot));
  if (!solution.uncertainty.budget.empty())
    result["uncertainty"]["controller"] = to_json(controller_sigma(robot, loaded->data, solution));
  const std::string json = result.dump(1);
  if (arguments.json)
    std::printf("%s\n", json.c_str());
  else
    std::fputs(summary(loaded->data, solution).c_str(), stdout);
  if (!arguments.out.empty())
    if (const auto written = write_solution(arguments, robot, *loaded, solution, json,
                                            circles && arguments.effects.empty()
                                                ? nominal_text(*circles, solution)
                                                : robot_text(robot, solution.values));
        !written)
      return tell(written.error());
  return solution.verdict.answer == Answer::improved ? kDone : kAnswerIsNo;
}

}  // namespace

void add_identify(CLI::App& app, int& status) {
  auto arguments = std::make_shared<IdentifyArguments>();
  CLI::App* command =
      app.add_subcommand("identify", "Identify a robot's parameters from a data set");
  command->add_option("DATASET", arguments->data_set, "Folder with dataset.yaml")->required();
  command->add_option("--fix", arguments->options.fix,
                      "Parameters held at the model's value (theta2, j2.theta, d*)");
  command->add_option("--free", arguments->options.free, "Parameters freed (K3, K*)");
  std::string known;
  for (const std::string_view effect : effect_names())
    known += (known.empty() ? "" : ",") + std::string(effect);
  command
      ->add_option("--effects", arguments->effects,
                   "Effects identified with it: EFFECT or EFFECT@PLACE (joint_compliance@j2)")
      ->type_name("TEXT:{" + known + "}");
  command->add_option("--out", arguments->out,
                      "Folder for report.html, result.json and calibrated.robot.yaml");
  command->add_flag("--json", arguments->json, "Print result.json alone on standard output");
  command->callback([arguments, &status] { status = identify_command(*arguments); });
}

}  // namespace selfcal
