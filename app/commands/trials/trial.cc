// Arguments of selfcal trial seal, run and score.
#include "app/commands/trials/trial.h"

#include <memory>

#include "app/commands/subcommand.h"
#include "diagnosis/trials/baselines.h"

namespace selfcal {
namespace {

void add_seal(CLI::App& app, int& status) {
  auto arguments = std::make_shared<SealArguments>();
  CLI::App* command =
      app.add_subcommand("seal", "Make or take data sets and put their truth aside");
  CLI::Option* given = command->add_option("DATASET", arguments->data_sets,
                                           "Given data sets, whose truth is in --truth");
  CLI::Option* truth =
      command->add_option("--truth", arguments->truth, "truth.json of the given data sets");
  CLI::Option* make = command->add_option("--make", arguments->make, "How many to make")
                          ->check(CLI::Range(1, 100000));
  given->needs(truth)->excludes(make);
  truth->needs(given);
  command->add_option("--seed", arguments->seed, "Of what is made; 1 by default")->needs(make);
  command->add_option("--measure", arguments->measure, "planes or positions; both by default")
      ->check(CLI::IsMember({"planes", "positions"}))
      ->needs(make);
  command->add_option("--rows", arguments->rows, "LEAST-MOST, 120-400 by default")->needs(make);
  command
      ->add_option(
          "--robot", arguments->robot,
          "Robot with masses and limits, a platform or a delta; an arm for each by default")
      ->needs(make);
  command->add_option("--out", arguments->out, "Folder of the trials")->required();
  command->callback([arguments, &status] { status = seal_trials(*arguments); });
}

void add_run(CLI::App& app, int& status) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Answer every trial without its truth");
  command->add_option("DIR", arguments->folder, "Folder of the trials")->required();
  command->add_option("--out", arguments->out, "File for the answers")->required();
  command->add_option("--baseline", arguments->baseline, "Answer by a textbook's method instead")
      ->check(CLI::IsMember(baseline_names()));
  command->add_option("--jobs", arguments->jobs, "Trials at once; as many as cores by default")
      ->check(CLI::Range(1, 256));
  command->callback([arguments, &status] { status = run_trials(*arguments); });
}

void add_score(CLI::App& app, int& status) {
  auto arguments = std::make_shared<ScoreArguments>();
  CLI::App* command = app.add_subcommand("score", "Open the truth and judge the answers");
  command->add_option("DIR", arguments->folder, "Folder of the trials")->required();
  command
      ->add_option("ANSWERS", arguments->answers,
                   "Files that `run` wrote: the one that is judged, then any to stand beside it")
      ->required();
  command->add_flag("--json", arguments->json, "Print the table as JSON");
  command->callback([arguments, &status] { status = score_trials(*arguments); });
}

}  // namespace

void add_trial(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("trial", "Blind trials of the diagnosis");
  command->require_subcommand(1);
  add_seal(*command, status);
  add_run(*command, status);
  add_score(*command, status);
}

}  // namespace selfcal
