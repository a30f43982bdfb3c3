#include "tests/reliability/diagram.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace selfcal {

void ReliabilityDiagram::add(const std::string& part, double probability, bool right) {
  Bin& bin = parts_[part][static_cast<size_t>(std::clamp(10 * probability, 0.0, 9.0))];
  ++bin.answers;
  bin.right += right;
  bin.stated += probability;
}

double ReliabilityDiagram::calibration_error(const std::string& part) const {
  const auto found = parts_.find(part);
  if (found == parts_.end()) return 0;
  double error = 0;
  int answers = 0;
  for (const Bin& bin : found->second) {
    error += std::abs(bin.stated - bin.right);
    answers += bin.answers;
  }
  return error / std::max(answers, 1);
}

std::string ReliabilityDiagram::text() const {
  std::string text = "| part | stated | answers | mean stated | right |\n|---|---|---|---|---|\n";
  char line[160];
  for (const auto& [part, bins] : parts_)
    for (size_t i = 0; i < bins.size(); ++i) {
      const Bin& bin = bins[i];
      if (bin.answers == 0) continue;
      std::snprintf(line, sizeof line, "| %s | %.1f to %.1f | %d | %.2f | %.2f |\n", part.c_str(),
                    0.1 * static_cast<double>(i), 0.1 * static_cast<double>(i + 1), bin.answers,
                    bin.stated / bin.answers, static_cast<double>(bin.right) / bin.answers);
      text += line;
    }
  return text;
}

}  // namespace selfcal
