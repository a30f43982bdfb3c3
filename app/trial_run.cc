// selfcal trial run: answers to every data set of a folder. The truth is never opened.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>

#include "app/command.h"
#include "app/trial.h"
#include "diagnosis/baselines.h"
#include "diagnosis/diagnosis.h"
#include "io/data_set_file.h"
#include "io/file.h"

namespace selfcal {
namespace {

TrialCauseNamed named(const CauseResult& cause) {
  return {cause.effect, cause.where, cause.probability, cause.confounded_with};
}

TrialAnswer answer_of(const Diagnosis& diagnosis) {
  TrialAnswer answer{named(diagnosis.verdict)};
  for (const CauseResult& each : diagnosis.candidates) answer.candidates.push_back(named(each));
  answer.closed = diagnosis.gap.closed_fraction;
  return answer;
}

class Runner {
 public:
  Runner(const RunArguments& arguments, std::vector<std::string> names)
      : arguments_(arguments), names_(std::move(names)) {}

  Result<TrialAnswers> run() {
    const auto cores = std::max(1U, std::thread::hardware_concurrency());
    const auto jobs = std::min<std::size_t>(
        names_.size(), arguments_.jobs > 0 ? static_cast<unsigned>(arguments_.jobs) : cores);
    {
      std::vector<std::jthread> workers;
      for (std::size_t i = 0; i < jobs; ++i) workers.emplace_back([this] { work(); });
    }
    if (failed_) return tl::unexpected(*failed_);
    return std::move(answers_);
  }

 private:
  void work() {
    for (std::size_t i = next_++; i < names_.size(); i = next_++) {
      const auto begin = std::chrono::steady_clock::now();
      Result<TrialAnswer> answer = answer_to(names_[i]);
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
      const std::scoped_lock lock(mutex_);
      if (!answer) {
        failed_ = answer.error();
        next_ = names_.size();
        return;
      }
      answer->seconds = spent.count();
      std::fprintf(stderr, "%zu/%zu %s %s %.3f (%.1f s)\n", answers_.size() + 1, names_.size(),
                   names_[i].c_str(), answer->verdict.effect.c_str(), answer->verdict.probability,
                   answer->seconds);
      answers_[names_[i]] = std::move(*answer);
    }
  }

  Result<TrialAnswer> answer_to(const std::string& name) const {
    auto loaded = load_data_set(std::filesystem::path(arguments_.folder) / name);
    if (!loaded) return tl::unexpected(loaded.error());
    const std::shared_ptr<const Robot> robot = std::move(loaded->robot);
    if (const auto baseline = find_baseline(arguments_.baseline))
      return (*baseline)(robot, loaded->data);
    const Diagnosis diagnosis = diagnose(robot, loaded->data);
    if (!diagnosis.problem.empty()) return bad_input(name + ": " + diagnosis.problem);
    return answer_of(diagnosis);
  }

  const RunArguments& arguments_;
  const std::vector<std::string> names_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;  ///< of all below
  TrialAnswers answers_;
  std::optional<Failure> failed_;
};

}  // namespace

int run_trials(const RunArguments& arguments) {
  auto names = trial_names(arguments.folder);
  if (!names) return tell(names.error());
  const auto answers = Runner(arguments, std::move(*names)).run();
  if (!answers) return tell(answers.error());
  const std::string by = arguments.baseline.empty() ? "diagnose" : arguments.baseline;
  const std::string sealed = published_hash(arguments.folder).value_or("");
  const auto written = write_file_atomically(arguments.out, answers_text({by, sealed, *answers}));
  return written ? kDone : tell(written.error());
}

}  // namespace selfcal
