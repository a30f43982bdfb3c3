// Speed as ratios in one run: each task by selfcal and by its contenders, on the same rows and from
// the same start, the peak of this core among them. --width=NAME holds the kernels to one of
// Highway's targets.
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>

#include "tests/bench/tasks.h"

namespace selfcal::bench {
namespace {

/// Prints as usual, and keeps the best time of each for the ratios.
class Ratios final : public benchmark::ConsoleReporter {
 public:
  Ratios() : ConsoleReporter(OO_Tabular) {}

  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
      const auto items = run.counters.find("items_per_second");
      const double time = items != run.counters.end() && run.benchmark_name().starts_with("jac")
                              ? 1 / items->second.value
                              : run.cpu_accumulated_time / static_cast<double>(run.iterations);
      double& least = time_.try_emplace(run.benchmark_name(), HUGE_VAL).first->second;
      least = std::min(least, time);
      if (const auto rate = run.counters.find("GFLOP/s"); rate != run.counters.end())
        rate_[run.benchmark_name()] = std::max(rate_[run.benchmark_name()], rate->second.value);
    }
  }

  void print() const {
    std::printf("\nratios of this run            times  wanted\n");
    line("Jacobian, one, over Ceres", "jacobian/ceres-automatic", "jacobian/selfcal-one", 30);
    line("Jacobian, batched, over Ceres", "jacobian/ceres-automatic", "jacobian/selfcal-batched",
         300);
    line("Jacobian, one, over KDL's joints alone", "jacobian/kdl-joints-alone",
         "jacobian/selfcal-one", 1);
    for (const char* rows : {"1000", "10000", "100000"}) {
      const std::string n = std::string("/") + rows, of = std::string(rows) + " rows, core over ";
      line(of + "Ceres automatic", "core/ceres-automatic-qr" + n, "core/selfcal" + n, 40);
      line(of + "automatic, normal", "core/ceres-automatic-normal" + n, "core/selfcal" + n, 40);
      line(of + "analytic", "core/ceres-analytic-normal" + n, "core/selfcal" + n, 10);
      line(of + "plain Eigen", "core/plain-eigen" + n, "core/selfcal" + n, 1);
    }
    line("whole identify over its core, 10000", "whole/selfcal/10000", "core/selfcal/10000", 10,
         true);
    line("rank over Eigen", "rank/eigen-colpiv", "rank/selfcal", 3);
    line("choice over a Cholesky a trial", "choice/cholesky", "choice/selfcal/875", 15);
    line("choice over singular values a trial", "choice/singular-values/iterations:1",
         "choice/selfcal/875", 1000);
    line("100 of 10000 over an observability each", "plan/100-of-10000/iterations:1",
         "plan/observability/iterations:1", 100, true);
    if (time_.contains("compensation/loop"))
      std::printf("%-38s %6.3g us\n", "a command in a control loop",
                  1e6 * time_.at("compensation/loop"));
    line("diagnosis over identification, 400", "diagnosis/selfcal/iterations:1",
         "whole/selfcal/400", 20, true);
    line("nine joints over three", "joints/selfcal/9", "joints/selfcal/3", 9, true);
    line("a hundred planes over four", "planes/selfcal/100", "planes/selfcal/4", 2, true);
    if (rate_.contains("peak") && rate_.contains("pass/selfcal/10000"))
      std::printf("%-38s %6.0f %%   40 %%\n", "a pass of the peak",
                  100 * rate_.at("pass/selfcal/10000") / rate_.at("peak"));
  }

 private:
  void line(const std::string& what, const std::string& slow, const std::string& fast,
            double wanted, bool at_most = false) const {
    if (!time_.contains(slow) || !time_.contains(fast)) return;
    std::printf("%-38s %6.3g  %s%g\n", what.c_str(), time_.at(slow) / time_.at(fast),
                at_most ? "at most " : "", wanted);
  }

  std::map<std::string, double> time_, rate_;
};

/// Takes --width=NAME out of the arguments; false when this machine has no such width.
bool hold_width(int& argc, char** argv) {
  constexpr const char* kOption = "--width=";
  for (int i = 1; i < argc; ++i) {
    if (std::strncmp(argv[i], kOption, std::strlen(kOption)) != 0) continue;
    const std::string name = argv[i] + std::strlen(kOption);
    std::copy(argv + i + 1, argv + argc, argv + i);
    --argc;
    using Targets = decltype(hwy::SupportedTargets());
    for (auto left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
      const auto one = static_cast<Targets>(left & ~(left - 1));
      if (name != hwy::TargetName(one)) continue;
      hwy::SetSupportedTargetsForTest(one);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      return true;
    }
    std::fprintf(stderr, "%s: not a width of this machine\n", name.c_str());
    return false;
  }
  return true;
}

}  // namespace
}  // namespace selfcal::bench

int main(int argc, char** argv) {
  using namespace selfcal::bench;
  if (!hold_width(argc, argv)) return 2;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  add_jacobians();
  add_identifications();
  add_choices();
  add_growth();
  Ratios ratios;
  benchmark::RunSpecifiedBenchmarks(&ratios);
  ratios.print();
  return 0;
}
