// selfcal plan ROBOT --method METHOD, plan CONFIG.yaml, plan --separate FILE: which configurations
// to measure at.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "app/commands/subcommand.h"
#include "app/commands/support/cell_plan.h"
#include "app/commands/support/plan_request.h"
#include "app/commands/support/prior_file.h"
#include "app/commands/support/separating_rows.h"
#include "app/report/next_place_report.h"
#include "app/report/plan_report.h"
#include "app/report/progress_line.h"
#include "io/files/file.h"
#include "io/files/observations_text.h"
#include "io/files/robot_file.h"

namespace selfcal {
namespace {

constexpr double kTarget = 1e-3;  // m, where none is given

/// The rows without what an instrument will only read there.
std::string rows_text(const ConfigurationPlan& plan) {
  DataSet data = plan.data;
  data.rows.position.setConstant(std::nan(""));
  data.rows.orientation.setConstant(std::nan(""));
  data.rows.measured.clear();
  return observations_text(data);
}

Result<void> write_rows(const PlanArguments& arguments, const std::string& text) {
  return arguments.out.empty() ? Result<void>() : write_file_atomically(arguments.out, text);
}

NextPlaces find_next_places(const Robot& robot, const NextRequest& request) {
  ProgressLine line;
  return next_places(robot, values(robot), request,
                     [&](std::string_view stage, double share) { line.show(stage, share); });
}

int plan_for_robot(const PlanArguments& arguments) {
  if (const std::string what = mistake(arguments.options); !what.empty()) return wrong_usage(what);
  if (arguments.candidates < arguments.count)
    return wrong_usage("--candidates must be at least --count");
  const auto robot = load_robot(arguments.file);
  if (!robot) return tell(robot.error());
  const Result<PlanRequest> request = plan_request(**robot, arguments);
  if (!request) return tell(request.error());
  ConfigurationPlan plan;
  {
    ProgressLine line;
    plan =
        plan_configurations(**robot, values(**robot), *request,
                            [&](std::string_view stage, double share) { line.show(stage, share); });
  }
  if (!plan.problem.empty()) return tell({kAnswerIsNo, plan.problem});
  if (const auto written = write_rows(arguments, rows_text(plan)); !written)
    return tell(written.error());
  const double target = arguments.target.value_or(kTarget);
  nlohmann::ordered_json json;
  if (arguments.json)
    json = plan_json(**robot, *request, plan, target);
  else
    std::fputs(plan_report(**robot, *request, plan, target).c_str(), stdout);
  if (!arguments.further.empty()) {
    auto next = next_request(**robot, arguments, plan.data);
    if (!next) return tell(next.error());
    next->pool.prior = request->pool.prior;
    next->pool.held = request->pool.held;
    next->workspace = request->workspace;
    const NextPlaces places = find_next_places(**robot, *next);
    if (arguments.json)
      json["further"] = next_json(places);
    else
      std::fputs(next_place_report(*next, places).c_str(), stdout);
  }
  if (arguments.json) std::printf("%s\n", json.dump(1).c_str());
  // Who names no target asks for the best of so many, whatever that comes to.
  return arguments.target && plan.curve.back() > *arguments.target ? kAnswerIsNo : kDone;
}

int plan_for_cell(const PlanArguments& arguments) {
  auto config = load_config(arguments.file);
  if (!config) return tell(config.error());
  if (!arguments.prior.empty()) {
    auto prior = read_prior(arguments.prior, *config->robot);
    if (!prior) return tell(prior.error());
    config->plan.known.prior = *std::move(prior);
  }
  CellPlan cell;
  {
    ProgressLine line;
    cell =
        plan_cell(*config, [&](std::string_view stage, double share) { line.show(stage, share); });
  }
  // Rows that leave a surface out are no plan.
  if (cell.plan.unreached.empty())
    if (const auto written = write_rows(arguments, cell_plan_rows(*config, cell)); !written)
      return tell(written.error());
  nlohmann::ordered_json json;
  if (arguments.json)
    json = cell_plan_json(*config, cell);
  else
    std::printf("%s: robot %s\n%s", config->id.c_str(), config->robot->name().c_str(),
                cell_plan_report(*config, cell).c_str());
  if (!arguments.further.empty() && cell.plan.unreached.empty()) {
    auto next = next_request(*config->robot, arguments, cell_plan_data(*config, cell));
    if (!next) return tell(next.error());
    next->pool.prior = config->plan.known.prior;
    next->workspace = config->workspace;
    const NextPlaces places = find_next_places(*config->robot, *next);
    if (arguments.json)
      json["further"] = next_json(places);
    else
      std::fputs(next_place_report(*next, places).c_str(), stdout);
  }
  if (arguments.json) std::printf("%s\n", json.dump(1).c_str());
  return cell.reaches(*config) ? kDone : kAnswerIsNo;
}

int plan_to_separate(const PlanArguments& arguments) {
  const auto rows = read_separating_rows(arguments.separate);
  if (!rows) return tell(rows.error());
  const auto step = static_cast<std::size_t>(arguments.step);
  if (!rows->steps.empty() && step > rows->steps.size())
    return wrong_usage("--step: the diagnosis asks for " + std::to_string(rows->steps.size()) +
                       " of them");
  std::fputs(separating_report(*rows).c_str(), stdout);
  if (rows->steps.empty()) return kAnswerIsNo;
  const SeparatingStep& chosen = rows->steps[step - 1];
  if (const auto written = write_rows(arguments, observations_text(chosen.rows)); !written)
    return tell(written.error());
  return chosen.settles() ? kDone : kAnswerIsNo;
}

int plan_command(const PlanArguments& arguments) {
  if (arguments.separate.empty() == arguments.file.empty())
    return wrong_usage("plan needs a robot file with --method, a CONFIG.yaml, or --separate FILE");
  if (!arguments.separate.empty()) return plan_to_separate(arguments);
  return arguments.options.methods.empty() ? plan_for_cell(arguments) : plan_for_robot(arguments);
}

std::vector<std::string> criterion_list() {
  const std::vector<std::string_view> names = criterion_names();
  return {names.begin(), names.end()};
}

}  // namespace

void add_plan(CLI::App& app, int& status) {
  auto arguments = std::make_shared<PlanArguments>();
  CLI::App* command = app.add_subcommand("plan", "Choose the configurations to measure at");
  command->add_option("FILE", arguments->file, "Robot file, or the CONFIG.yaml of a cell");
  CLI::Option* method =
      command
          ->add_option("--method", arguments->options.methods,
                       "Constraint method; again for each further surface, socket or instrument")
          ->check(is_method())
          ->expected(1)
          ->take_all();
  CLI::Option* separate = command->add_option(
      "--separate", arguments->separate, "diagnosis.json: rows that tell its look-alikes apart");
  command->add_option("--step", arguments->step, "Of these, whose rows --out gets")
      ->check(CLI::Range(1, 100))
      ->needs(separate)
      ->capture_default_str();
  command
      ->add_option("--prior", arguments->prior,
                   "result.json whose covariance says what is known beforehand")
      ->excludes(separate);
  CLI::Option* further =
      command
          ->add_option("--further", arguments->further,
                       "Method: where a further surface, socket or instrument would help most")
          ->check(is_method())
          ->excludes(separate);
  const std::vector<CLI::Option*> others = command->get_options();
  add_lock_and_unknown(*command, arguments->options);
  command->add_option("--count", arguments->count, "Configurations to choose")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_option("--candidates", arguments->candidates, "Configurations to choose from")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--criterion", arguments->criterion, "What is made best")
      ->check(CLI::IsMember(criterion_list()))
      ->capture_default_str();
  command
      ->add_option("--workspace", arguments->workspace,
                   "Box where the end position counts: X Y Z X Y Z of two corners (m)")
      ->expected(6);
  command
      ->add_option("--start", arguments->start, "CSV of configurations that are measured already")
      ->excludes(further);
  command
      ->add_option("--spacing", arguments->spacing,
                   "Least between end positions of a set, those of --start included (m)")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--longest", arguments->longest,
                   "Most that the motion may take (s); fewer are chosen then")
      ->check(CLI::PositiveNumber);
  command->add_option("--groups", arguments->groups, "Sockets or nests of a method that has such")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--noise", arguments->options.noise,
                   "1 sigma of a measured length (m; default 2e-5)")
      ->check(CLI::Range(1e-9, 0.1));
  command
      ->add_option("--noise-angle", arguments->options.noise_angle,
                   "1 sigma of a measured angle (rad; default 2e-5)")
      ->check(CLI::Range(1e-9, 0.1));
  command
      ->add_option("--speed", arguments->speed,
                   "Joint speeds, one or one each (rad/s, m/s; default 1 and 0.25)")
      ->check(CLI::PositiveNumber);
  command
      ->add_option(
          "--target", arguments->target,
          "End-position accuracy wanted (m, 1 sigma; default 1e-3); exit status 1 where it "
          "is given and not reached")
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", arguments->seed, "Seed of all that is drawn")
      ->capture_default_str();
  for (CLI::Option* each : command->get_options())
    if (std::ranges::find(others, each) == others.end()) each->needs(method);
  command->add_option("--out", arguments->out, "CSV file for the configurations");
  command->add_flag("--json", arguments->json, "Print JSON alone on standard output")
      ->excludes(separate);
  command->callback([arguments, &status] { status = plan_command(*arguments); });
}

}  // namespace selfcal
