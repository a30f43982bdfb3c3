// selfcal diagnose DATASET: where the gap lies, which effect causes it, how far it closes.
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/diagnosis_json.h"
#include "app/diagnosis_report.h"
#include "app/diagnosis_summary.h"
#include "app/progress_line.h"
#include "diagnosis/compare.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/simulation.h"
#include "io/data_set_file.h"
#include "io/file.h"
#include "io/robot_file.h"

namespace selfcal {
namespace {

struct Arguments {
  std::string data_set, since, simulated, next, out;
  bool json = false;
};

Result<void> write(const Arguments& arguments, const Diagnosis& diagnosis, const std::string& name,
                   const std::string& json) {
  const std::filesystem::path out(arguments.out);
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error) return device_failed(arguments.out + ": cannot create the folder: " + error.message());
  if (auto done = write_file_atomically(out / "diagnosis.json", json + "\n"); !done) return done;
  if (auto done = write_file_atomically(out / "report.html", html_report(diagnosis, name)); !done)
    return done;
  return write_file_atomically(out / "corrected.robot.yaml",
                               robot_text(*diagnosis.model, diagnosis.values));
}

std::function<void(std::string_view, double)> shown_on(ProgressLine& line) {
  return [&line](std::string_view stage, double share) { line.show(stage, share); };
}

struct Inputs {
  LoadedDataSet measured;
  std::shared_ptr<const Robot> robot;
  std::optional<LoadedDataSet> before, simulated;
};

Result<std::optional<LoadedDataSet>> load_other(const std::string& path, const Robot& robot) {
  if (path.empty()) return std::nullopt;
  auto other = load_data_set(path);
  if (!other) return tl::unexpected(other.error());
  if (const std::string why = incomparable(*other->robot, robot); !why.empty())
    return bad_input(path + " " + why);
  for (const std::string& notice : other->notices)
    std::fprintf(stderr, "selfcal: note: %s: %s\n", path.c_str(), notice.c_str());
  return std::optional(*std::move(other));
}

/// All of them, before anything that takes long.
Result<Inputs> load(const Arguments& arguments) {
  auto measured = load_data_set(arguments.data_set);
  if (!measured) return tl::unexpected(measured.error());
  for (const std::string& notice : measured->notices)
    std::fprintf(stderr, "selfcal: note: %s\n", notice.c_str());
  const std::shared_ptr<const Robot> robot = std::move(measured->robot);
  auto before = load_other(arguments.since, *robot);
  if (!before) return tl::unexpected(before.error());
  auto simulated = load_other(arguments.simulated, *robot);
  if (!simulated) return tl::unexpected(simulated.error());
  return Inputs{*std::move(measured), robot, *std::move(before), *std::move(simulated)};
}

int diagnose_command(const Arguments& arguments) {
  const auto inputs = load(arguments);
  if (!inputs) return tell(inputs.error());
  const DataSet& data = inputs->measured.data;
  Diagnosis diagnosis;
  std::optional<Comparison> since;
  std::optional<Differences> sim;
  {
    ProgressLine line;
    diagnosis = diagnose(inputs->robot, data, {}, shown_on(line));
    if (!diagnosis.problem.empty())
      return tell({kBadInput, arguments.data_set + ": " + diagnosis.problem});
    if (inputs->before)
      since =
          compare(inputs->robot, inputs->before->data, data, Between::sessions, {}, shown_on(line));
    if (inputs->simulated) {
      const DataSet& simulated = inputs->simulated->data;
      const Diagnosis other = diagnose(inputs->robot, simulated, {}, shown_on(line));
      if (!other.problem.empty())
        return tell({kBadInput, arguments.simulated + ": " + other.problem});
      sim = differences(
          diagnosis, other,
          compare(inputs->robot, simulated, data, Between::machines, {}, shown_on(line)));
    }
  }
  nlohmann::ordered_json whole = to_json(diagnosis);
  std::string more;
  if (since) {
    whole["since"] = to_json(*since);
    more += "Since " + inputs->before->name + ": " + since->why + "\n";
  }
  if (sim) {
    whole["sim"] = to_json(*sim);
    for (const std::string& each : sim->sentences)
      more += "Against " + inputs->simulated->name + ": " + each + "\n";
  }
  const std::string json = whole.dump(1);
  if (!arguments.out.empty())
    if (const auto written = write(arguments, diagnosis, inputs->measured.name, json); !written)
      return tell(written.error());
  if (!arguments.next.empty())
    if (const auto written =
            write_file_atomically(arguments.next, next_json(diagnosis, data).dump(1) + "\n");
        !written)
      return tell(written.error());
  if (arguments.json)
    std::printf("%s\n", json.c_str());
  else
    std::fputs((summary(diagnosis) + more).c_str(), stdout);
  return diagnosis.converged ? kDone : kAnswerIsNo;
}

}  // namespace

void add_diagnose(CLI::App& app, int& status) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "diagnose",
      "Where the gap between model and machine lies, what causes it, how far it closes");
  command->add_option("DATASET", arguments->data_set, "Folder with dataset.yaml")->required();
  command->add_option("--sim", arguments->simulated,
                      "Data set of the robot's simulator: in what the two differ");
  command->add_option("--since", arguments->since,
                      "Earlier data set of the same robot: what changed");
  command->add_option("--next", arguments->next, "File for the rows to measure next");
  command->add_option("--out", arguments->out,
                      "Folder for diagnosis.json, report.html and corrected.robot.yaml");
  command->add_flag("--json", arguments->json, "Print diagnosis.json alone on standard output");
  command->callback([arguments, &status] { status = diagnose_command(*arguments); });
}

}  // namespace selfcal
