// Identifies a robot's parameters from a data set, and says what causes the gap that is left.
#include <selfcal/selfcal.h>
#include <cstdio>
#include <string>

int main(int argc, char** argv) {
  if (argc != 2) return std::fputs("usage: calibrate DATASET\n", stderr), 2;
  const auto loaded = selfcal::load_data_set(argv[1]);
  if (!loaded) {
    std::fprintf(stderr, "%s\n", loaded.error().what.c_str());
    return loaded.error().exit_status;
  }
  const selfcal::Solution solution = selfcal::identify(*loaded->robot, loaded->data);
  for (const selfcal::ParameterResult& each : solution.parameters)
    if (each.status == selfcal::Status::identified)
      std::printf("%s %.9g sigma %.2g %s\n", each.parameter.name.c_str(), each.value, each.sigma,
                  std::string(each.parameter.unit()).c_str());
  std::printf("check rows: %.3g mm before, %.3g mm after\n",
              1e3 * solution.residual.check.rms_before, 1e3 * solution.residual.check.rms_after);
  std::printf("answer: %s\n", std::string(to_string(solution.verdict.answer)).c_str());

  const selfcal::Diagnosis diagnosis =
      selfcal::diagnose(loaded->robot, loaded->data, {.resamples = 39, .simulated_sessions = 0});
  if (!diagnosis.problem.empty()) {
    std::printf("no diagnosis: %s\n", diagnosis.problem.c_str());
    return 0;
  }
  std::printf("cause: %s\n", diagnosis.verdict.effect.c_str());
  for (const std::string& where : diagnosis.verdict.where) std::printf("  at %s\n", where.c_str());
}
