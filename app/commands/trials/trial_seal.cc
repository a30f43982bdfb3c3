// selfcal trial seal: data sets in a folder, their truth beside them, the truth's SHA-256
// published.
#include <cstdio>
#include <filesystem>
#include <set>

#include "app/commands/subcommand.h"
#include "app/commands/trials/trial.h"
#include "app/report/progress_line.h"
#include "diagnosis/diagnosis.h"
#include "io/files/data_set_file.h"
#include "io/files/data_set_writer.h"
#include "io/files/file.h"
#include "io/files/json_parts.h"
#include "io/files/robot_file.h"
#include "sim/trials/trial_machine.h"

namespace selfcal {
namespace {

namespace fs = std::filesystem;

Json ledger_json(const TrialLedger& truth) {
  Json where = Json::object();
  for (const auto& [effect, places] : truth.where) where[effect] = places;
  const auto text = [](const std::string& each) { return each.empty() ? Json() : Json(each); };
  return {{"effect", truth.effect},
          {"second", text(truth.second)},
          {"where", where},
          {"r", truth.r},
          {"measure", truth.measure},
          {"noise", truth.noise},
          {"rows", truth.rows},
          {"physics", text(truth.physics)},
          {"told_closed", truth.told_closed ? Json(*truth.told_closed) : Json()}};
}

Node description(const MadeTrial& trial) {
  Node sets = Node::map();
  for (const Set& set : trial.data.sets) {
    Node entry = Node::map();
    entry.set("method", Node::of(std::string(set.method->name())));
    if (set.noise > 0) entry.set("noise", Node::of(set.noise));
    sets.set(set.name, std::move(entry));
  }
  Node node = Node::map();
  node.set("robot", Node::of(std::string("arm.robot.yaml")));
  node.set("observations", Node::of(std::string("observations.csv")));
  node.set("sets", std::move(sets));
  return node;
}

std::string trial_name(int number) {
  std::string digits = std::to_string(number);
  if (digits.size() < 3) digits.insert(0, 3 - digits.size(), '0');
  return "t" + digits;
}

/// Publishes the truth's fingerprint beside the truth.
Result<void> seal(const fs::path& out, const std::string& truth) {
  if (auto done = write_file_atomically(out / kTruthFile, truth); !done) return done;
  const std::string hash = sha256_hex(truth);
  if (auto done = write_file_atomically(out / kTruthHash, hash + "\n"); !done) return done;
  std::printf("%s\n", hash.c_str());
  return {};
}

/// A folder that holds a truth is not overwritten: its answers would be judged by another one.
Result<void> check_unsealed(const fs::path& out) {
  std::error_code error;
  if (fs::exists(out / kTruthFile, error))
    return bad_input((out / kTruthFile).string() + ": is sealed already: choose a new folder");
  return make_folder(out);
}

/// Fills in what the arguments ask for; false when `rows` or `measure` make no sense.
bool read_options(const SealArguments& arguments, TrialRequest& request) {
  if (!arguments.rows.empty() &&
      (std::sscanf(arguments.rows.c_str(), "%d-%d", &request.least_rows, &request.most_rows) != 2 ||
       request.least_rows < 60 || request.most_rows < request.least_rows))
    return false;
  if (!arguments.measure.empty()) request.touches = arguments.measure == "planes";
  request.seed = arguments.seed;
  return true;
}

Result<Json> make_one(const TrialRequest& request, const fs::path& folder) {
  const MadeTrial trial = make_trial(request);
  if (!trial.unreached.empty()) return bad_input(folder.string() + ": " + trial.unreached);
  const NewDataSet written{description(trial), "arm.robot.yaml",
                           robot_text(*trial.robot, values(*trial.robot)), &trial.data};
  if (auto done = write_data_set(folder, written); !done) return tl::unexpected(done.error());
  return ledger_json(trial.truth);
}

int make_trials(const SealArguments& arguments) {
  TrialRequest request;
  if (!read_options(arguments, request))
    return wrong_usage("--rows: expected LEAST-MOST of at least 60, like 120-400");
  if (!arguments.robot.empty()) {
    auto robot = load_robot(arguments.robot);
    if (!robot) return tell(robot.error());
    const Statics* statics = (*robot)->statics();
    const bool on_legs = (*robot)->leg_parameter(0) >= 0;
    if (!on_legs && (!statics || !statics->mechanics().masses_known()))
      return wrong_usage(arguments.robot + ": trials need the masses of the links");
    request.robot = std::move(*robot);
  }
  const fs::path out(arguments.out);
  if (const auto free = check_unsealed(out); !free) return tell(free.error());
  Json truths = Json::object();
  {
    ProgressLine progress;
    for (request.number = 0; request.number < arguments.make; ++request.number) {
      progress.show("making trials", static_cast<double>(request.number) / arguments.make);
      const std::string name = trial_name(request.number);
      auto truth = make_one(request, out / name);
      if (!truth) return tell(truth.error());
      truths[name] = std::move(*truth);
    }
  }
  const auto sealed = seal(out, truths.dump(1) + "\n");
  return sealed ? kDone : tell(sealed.error());
}

/// A data set that is given, and where its copy goes.
struct Given {
  std::string name;
  fs::path from, to;
  std::vector<fs::path> files;  ///< relative to `from`
};

/// The data set at `folder` reads, reads as well elsewhere, and its place in `out` is free.
Result<Given> examine(const fs::path& folder, const fs::path& out) {
  const fs::path from = folder.lexically_normal();
  const std::string name = (from.has_filename() ? from : from.parent_path()).filename().string();
  Given given{name, from, out / name, {}};
  std::error_code error;
  if (fs::exists(given.to, error)) return bad_input(given.to.string() + ": is there already");
  auto loaded = load_data_set(from);
  if (!loaded) return tl::unexpected(loaded.error());
  given.files = loaded->files;
  // What `trial run` cannot answer would be scored as if the diagnosis had failed.
  if (const std::string why = why_not_diagnosable(std::move(loaded->robot), loaded->data);
      !why.empty())
    return bad_input((from / "observations.csv").string() + ": " + why);
  for (const fs::path& file : given.files)
    if (file.is_absolute() || *file.lexically_normal().begin() == "..")
      return bad_input((from / "dataset.yaml").string() + ": " + file.string() +
                       " lies outside the data set's folder");
  return given;
}

/// Copies the files that the data set is made of, and nothing else that lies beside them.
Result<void> copy(const Given& given) {
  for (const fs::path& file : given.files) {
    const fs::path to = given.to / file;
    if (auto made = make_folder(to.parent_path()); !made) return made;
    std::error_code error;
    fs::copy_file(given.from / file, to, error);
    if (error) return device_failed(to.string() + ": cannot copy: " + error.message());
  }
  return {};
}

/// All of them are examined before the first is copied: a refused run leaves nothing behind.
int take_trials(const SealArguments& arguments) {
  const auto truth = read_file(arguments.truth, kMostTrialBytes);
  if (!truth) return tell(truth.error());
  const auto truths = parse_truths(*truth, arguments.truth);
  if (!truths) return tell(truths.error());
  const fs::path out(arguments.out);
  std::vector<Given> all;
  std::set<std::string> taken;
  for (const std::string& each : arguments.data_sets) {
    auto given = examine(each, out);
    if (!given) return tell(given.error());
    if (!truths->contains(given->name))
      return wrong_usage(arguments.truth + ": says nothing of the data set " + given->name);
    if (!taken.insert(given->name).second)
      return wrong_usage("two data sets are called " + given->name);
    all.push_back(std::move(*given));
  }
  for (const auto& [name, each] : *truths)
    if (!taken.contains(name))
      return wrong_usage(arguments.truth + ": names " + name + ", which was not given");
  if (const auto free = check_unsealed(out); !free) return tell(free.error());
  for (const Given& given : all)
    if (const auto done = copy(given); !done) return tell(done.error());
  const auto sealed = seal(out, *truth);
  return sealed ? kDone : tell(sealed.error());
}

}  // namespace

int seal_trials(const SealArguments& arguments) {
  if (arguments.make > 0) return make_trials(arguments);
  if (!arguments.data_sets.empty()) return take_trials(arguments);
  return wrong_usage("give --make N, or data sets with --truth FILE");
}

}  // namespace selfcal
