// A reliability diagram: how often answers of a stated probability are right, for parts of the
// trials.
#pragma once

#include <array>
#include <map>
#include <string>

namespace selfcal {

class ReliabilityDiagram {
 public:
  /// One answer of `probability`, in the part called `part`.
  void add(const std::string& part, double probability, bool right);
  /// Mean difference of stated and true, over bins of a tenth, weighed by their answers; 0 without.
  double calibration_error(const std::string& part) const;
  /// By part and bin: answers, mean stated, share right.
  std::string text() const;

 private:
  struct Bin {
    int answers = 0, right = 0;
    double stated = 0;
  };
  std::map<std::string, std::array<Bin, 10>> parts_;
};

}  // namespace selfcal
