// selfcal trial run: answers to every data set of a folder. The truth is never opened.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>

#include "app/commands/subcommand.h"
#include "app/commands/trials/trial.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/trials/baselines.h"
#include "io/files/data_set_file.h"
#include "io/files/file.h"

namespace selfcal {
namespace {

TrialCauseNamed named(const CauseResult& cause) {
  return {cause.effect, cause.where, cause.probability, cause.confounded_with};
}

TrialAnswer trial_answer(const Diagnosis& diagnosis) {
  TrialAnswer answer{named(diagnosis.verdict)};
  for (const CauseResult& each : diagnosis.candidates) answer.candidates.push_back(named(each));
  // A fit that is told the truth is told every cause, the verdict names the largest.
  answer.closed = diagnosis.gap.closed_all.fraction;
  return answer;
}

/// Works through the trials, and keeps the file of answers up to date while it does: what was
/// answered outlives an interruption, and a trial that cannot be answered stops no other.
class Runner {
 public:
  Runner(const RunArguments& arguments, std::vector<std::string> names)
      : arguments_(arguments), names_(std::move(names)) {
    file_.by = arguments.baseline.empty() ? "diagnose" : arguments.baseline;
    file_.sealed = published_hash(arguments.folder).value_or("");
  }

  int run() {
    const auto cores = std::max(1U, std::thread::hardware_concurrency());
    const auto jobs = std::min<std::size_t>(
        names_.size(), arguments_.jobs > 0 ? static_cast<unsigned>(arguments_.jobs) : cores);
    {
      std::vector<std::jthread> workers;
      for (std::size_t i = 0; i < jobs; ++i) workers.emplace_back([this] { work(); });
    }
    if (saved_) save();
    if (!saved_) return tell(saved_.error());
    if (file_.unanswered.empty()) return kDone;
    return tell({kInputIsBad, std::to_string(file_.unanswered.size()) + " of " +
                                  std::to_string(names_.size()) + " trials were not answered"});
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kBetweenSaves{1};

  void work() {
    for (std::size_t i = next_++; i < names_.size(); i = next_++) {
      const auto begin = Clock::now();
      Result<TrialAnswer> answer = answer_to(names_[i]);
      const std::chrono::duration<double> spent = Clock::now() - begin;
      const std::scoped_lock lock(mutex_);
      if (answer) answer->seconds = spent.count();
      take(names_[i], std::move(answer));
      if (saved_ && Clock::now() - last_save_ >= kBetweenSaves) save();
      if (!saved_) next_ = names_.size();
    }
  }

  void take(const std::string& name, Result<TrialAnswer> answer) {
    const std::size_t done = file_.answers.size() + file_.unanswered.size() + 1;
    std::fprintf(stderr, "%zu/%zu %s ", done, names_.size(), name.c_str());
    if (answer) {
      std::fprintf(stderr, "%s %.3f (%.1f s)\n", answer->verdict.effect.c_str(),
                   answer->verdict.probability, answer->seconds);
      file_.answers[name] = std::move(*answer);
    } else {
      std::fprintf(stderr, "not answered: %s\n", answer.error().what.c_str());
      file_.unanswered[name] = answer.error().what;
    }
  }

  void save() {
    saved_ = write_file_atomically(arguments_.out, answers_text(file_));
    last_save_ = Clock::now();
  }

  Result<TrialAnswer> answer_to(const std::string& name) const {
    auto loaded = load_data_set(std::filesystem::path(arguments_.folder) / name);
    if (!loaded) return tl::unexpected(loaded.error());
    print_notices(*loaded);
    const std::shared_ptr<const Robot> robot = std::move(loaded->robot);
    if (const auto baseline = find_baseline(arguments_.baseline))
      return (*baseline)(robot, loaded->data);
    const Diagnosis diagnosis = diagnose(robot, loaded->data);
    if (!diagnosis.problem.empty()) return bad_input(name + ": " + diagnosis.problem);
    return trial_answer(diagnosis);
  }

  const RunArguments& arguments_;
  const std::vector<std::string> names_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;  ///< of all below
  TrialAnswerFile file_;
  Result<void> saved_;
  Clock::time_point
      last_save_{};  ///< so that the first answer shows whether the file can be written
};

}  // namespace

int run_trials(const RunArguments& arguments) {
  auto names = trial_names(arguments.folder);
  if (!names) return tell(names.error());
  return Runner(arguments, std::move(*names)).run();
}

}  // namespace selfcal
