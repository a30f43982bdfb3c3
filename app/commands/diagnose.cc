// selfcal diagnose DATASET: where the gap lies, which effect causes it, how far it closes.
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include "app/commands/foreign/simulator.h"
#include "app/commands/subcommand.h"
#include "app/commands/support/file_slips.h"
#include "app/report/diagnosis_json.h"
#include "app/report/diagnosis_summary.h"
#include "app/report/format.h"
#include "app/report/page/diagnosis_page.h"
#include "app/report/progress_line.h"
#include "app/service/session/cause_search.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/report/doubt.h"
#include "io/files/data_set_file.h"
#include "io/files/file.h"
#include "io/files/robot_file.h"

namespace selfcal {
namespace {

struct DiagnoseArguments {
  std::string data_set, since, simulated, tool, next, cell, out;
  bool json = false;
};

std::function<void(std::string_view, double)> shown_on(ProgressLine& line) {
  return [&line](std::string_view stage, double share) { line.show(stage, share); };
}

struct Inputs {
  LoadedDataSet measured;
  std::shared_ptr<const Robot> robot;
  std::optional<LoadedDataSet> before, simulated;
  std::optional<ToolPoses>
      tool;  ///< where the simulator has it, where it is a model that was asked
};

Result<std::optional<LoadedDataSet>> load_other(const std::string& path, const Robot& robot) {
  if (path.empty()) return std::nullopt;
  auto other = load_data_set(path);
  if (!other) return tl::unexpected(other.error());
  if (const std::string why = incomparable(*other->robot, robot); !why.empty())
    return bad_input(path + " " + why);
  if (const std::string why = incomparable(other->data); !why.empty())
    return bad_input(path + " " + why);
  print_notices(*other);
  return std::optional(*std::move(other));
}

/// The rows of the robot's simulator: a data set, or what a model says at the rows of the robot.
Result<void> load_simulated(const DiagnoseArguments& arguments, Inputs& inputs) {
  if (!is_simulator_model(arguments.simulated)) {
    auto other = load_other(arguments.simulated, *inputs.robot);
    if (!other) return tl::unexpected(other.error());
    inputs.simulated = *std::move(other);
    return {};
  }
  auto simulation = ask_simulator(arguments.simulated, arguments.tool, inputs.measured);
  if (!simulation) return tl::unexpected(simulation.error());
  print_notices(simulation->measured);
  inputs.simulated = std::move(simulation->measured);
  inputs.tool = std::move(simulation->tool);
  return {};
}

/// All of them, before anything that takes long.
Result<Inputs> load(const DiagnoseArguments& arguments) {
  auto measured = load_data_set(arguments.data_set);
  if (!measured) return tl::unexpected(with_likely_wrong(measured.error(), arguments.data_set));
  print_notices(*measured);
  const std::shared_ptr<const Robot> robot = std::move(measured->robot);
  auto before = load_other(arguments.since, *robot);
  if (!before) return tl::unexpected(before.error());
  Inputs inputs{*std::move(measured), robot, *std::move(before), {}, {}};
  if (const auto loaded = load_simulated(arguments, inputs); !loaded)
    return tl::unexpected(loaded.error());
  return inputs;
}

/// Of what the maker's figures leave of the rows: where the files are likely wrong and calibration
/// leaves more, it has not taken in what is wrong with them.
constexpr double kTakenIn = 0.2;

/// Where the maker's robot is far from the rows, says first what is likely wrong with the files,
/// and names no cause of a gap that one slip in them explains or that calibration leaves gross.
void look_at_files_first(const std::string& path, const Inputs& inputs,
                         const DiagnosisOptions& options, Diagnosis& diagnosis) {
  const LikelyWrong wrong =
      likely_wrong(path, inputs.measured, inputs.robot,
                   {diagnosis.gap.rms_nominal, true, *diagnosis.model, diagnosis.values,
                    diagnosis.gap.rms_before, diagnosis.angles_left});
  if (wrong.words.empty()) return;
  const bool taken_in =
      wrong.tool || diagnosis.gap.rms_before < kTakenIn * diagnosis.gap.rms_nominal;
  if (!diagnosis.named.empty() && (wrong.explained || !taken_in))
    withdraw(wrong.explained ? "one slip in the files explains the rows"
                             : "calibration does not take in what is wrong with the files",
             options, diagnosis);
  diagnosis.warnings.insert(diagnosis.warnings.begin(), wrong.words);
  diagnosis.why = wrong.words + " As the files are: " + diagnosis.why;
  NextStep step;
  step.what = wrong.words;
  step.probability_after = std::numeric_limits<double>::quiet_NaN();
  diagnosis.next.insert(diagnosis.next.begin(), std::move(step));
}

/// The further rows are touches that the cell can make.
Result<DiagnosisOptions> options_in(const std::string& cell, const Inputs& inputs,
                                    const Progress& progress) {
  DiagnosisOptions options;
  if (cell.empty()) return options;
  const auto config = load_config(cell);
  if (!config) return tl::unexpected(config.error());
  if (const std::string why = incomparable(*config->robot, *inputs.robot); !why.empty())
    return bad_input(cell + " " + why);
  const CellTouches touches =
      possible_touches(*inputs.robot, *config, {}, inputs.measured.data, options.seed, progress);
  if (touches.touches.empty())
    return bad_input(cell + ": no surface of it is touched in " + inputs.measured.name);
  options.possible = std::make_shared<PossibleRows>(touches.rows);
  options.most_further = config->causes.round;
  return options;
}

Result<Findings> find(const DiagnoseArguments& arguments, const Inputs& inputs) {
  const DataSet& data = inputs.measured.data;
  ProgressLine line;
  const auto options = options_in(arguments.cell, inputs, shown_on(line));
  if (!options) return tl::unexpected(options.error());
  Findings found{
      inputs.measured.name, diagnose(inputs.robot, data, *options, shown_on(line)), {}, {}};
  if (!found.diagnosis.problem.empty())
    return bad_input(arguments.data_set + ": " + found.diagnosis.problem);
  look_at_files_first(arguments.data_set, inputs, *options, found.diagnosis);
  if (inputs.before)
    found.since = {inputs.before->name, compare(inputs.robot, inputs.before->data, data,
                                                Between::sessions, {}, shown_on(line))};
  if (!inputs.simulated) return found;
  const DataSet& simulated = inputs.simulated->data;
  const Diagnosis other = diagnose(inputs.robot, simulated, {}, shown_on(line));
  if (!other.problem.empty()) return bad_input(arguments.simulated + ": " + other.problem);
  found.sim = {
      inputs.simulated->name,
      differences(found.diagnosis, other,
                  compare(inputs.robot, simulated, data, Between::machines, {}, shown_on(line))),
      {},
      {}};
  if (!inputs.tool) return found;
  const std::vector<Outlier>& outliers = found.diagnosis.outliers;
  found.sim->gap = simulator_gap(inputs.measured.data, without_false_rows(*inputs.tool, outliers));
  found.sim->mended =
      mended_simulator(arguments.simulated, arguments.tool, inputs.measured,
                       robot_text(*found.diagnosis.model, found.diagnosis.values), outliers);
  return found;
}

/// With the rows of each step, for `plan --separate`.
std::string json_of(const Inputs& inputs, const Findings& findings) {
  nlohmann::ordered_json json = to_json(findings);
  json["next"] = next_json(findings.diagnosis, inputs.measured.data)["steps"];
  return json.dump(1) + "\n";
}

std::string words_of(const Findings& findings) {
  std::string text = summary(findings.diagnosis);
  if (findings.since)
    text += "Since " + findings.since->name + ": " + findings.since->comparison.why + "\n";
  for (const std::string& each : simulator_sentences(findings))
    text += "Against " + findings.sim->name + ": " + each + "\n";
  return text;
}

Result<void> write_folder(const std::filesystem::path& out, const Inputs& inputs,
                          const Findings& findings) {
  if (auto made = make_folder(out); !made) return made;
  const Diagnosis& diagnosis = findings.diagnosis;
  const PageSubject subject{*inputs.robot, inputs.measured.data, inputs.measured.name,
                            unix_now_ms()};
  std::vector<std::pair<const char*, std::string>> files = {
      {"diagnosis.json", json_of(inputs, findings)},
      {"report.html", page_of(diagnosis_data(subject, findings))},
      {"corrected.robot.yaml", robot_text(*diagnosis.model, diagnosis.values)}};
  if (findings.sim && findings.sim->mended)
    files.emplace_back("mended.xml", findings.sim->mended->text);
  for (const auto& [name, text] : files)
    if (auto done = write_file_atomically(out / name, text); !done) return done;
  return {};
}

/// Writes what is asked for to be kept.
Result<void> write_findings(const DiagnoseArguments& arguments, const Inputs& inputs,
                            const Findings& findings) {
  if (!arguments.out.empty())
    if (auto done = write_folder(arguments.out, inputs, findings); !done) return done;
  if (arguments.next.empty()) return {};
  return write_file_atomically(arguments.next,
                               next_json(findings.diagnosis, inputs.measured.data).dump(1) + "\n");
}

int diagnose_command(const DiagnoseArguments& arguments) {
  if (!arguments.tool.empty() && !is_simulator_model(arguments.simulated))
    return wrong_usage("--tool names a site or body of a model, and --sim gives none");
  const auto inputs = load(arguments);
  if (!inputs) return tell(inputs.error());
  const auto findings = find(arguments, *inputs);
  if (!findings) return tell(findings.error());
  std::fputs((arguments.json ? json_of(*inputs, *findings) : words_of(*findings)).c_str(), stdout);
  if (const auto written = write_findings(arguments, *inputs, *findings); !written)
    return tell(written.error());
  return findings->diagnosis.converged ? kDone : kAnswerIsNo;
}

}  // namespace

void add_diagnose(CLI::App& app, int& status) {
  auto arguments = std::make_shared<DiagnoseArguments>();
  CLI::App* command = app.add_subcommand(
      "diagnose",
      "Where the gap between model and machine lies, what causes it, how far it closes");
  command->add_option("DATASET", arguments->data_set, "Folder with dataset.yaml")->required();
  command->add_option("--sim", arguments->simulated,
                      "The robot's simulator, its data set or its model for MuJoCo (.xml): in "
                      "what the two differ");
  command->add_option("--tool", arguments->tool,
                      "Site or body of the model that is measured (default: its only one)");
  command->add_option("--since", arguments->since,
                      "Earlier data set of the same robot: what changed");
  command->add_option("--next", arguments->next, "File for the rows to measure next");
  command->add_option("--cell", arguments->cell,
                      "CONFIG.yaml of the robot's cell: what to measure next are touches in it");
  command->add_option(
      "--out", arguments->out,
      "Folder for diagnosis.json, report.html, corrected.robot.yaml and, with a model, "
      "mended.xml");
  command->add_flag("--json", arguments->json, "Print diagnosis.json alone on standard output");
  command->callback([arguments, &status] { status = diagnose_command(*arguments); });
}

}  // namespace selfcal
