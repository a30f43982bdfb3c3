// An RX-90 whose tool pulls the cables of draw-wire encoders, their points and zeros unknown.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/recovery/rx90.h"
#include "tests/support/end_position.h"

namespace selfcal::recovery {
namespace {

/// Encoders of `rows` readings each, the second of unknown scale; with `point` they pull at a
/// target on the last link.
std::vector<SetPart> cables(int count, int rows, bool point) {
  std::vector<SetPart> parts;
  const char* const names[] = {"a", "b", "c"};
  for (int i = 0; i < count; ++i) {
    Node node = entry({{"method", "fixed-point-distance"}, {"offset", "unknown"}});
    if (i == 1) node.set("scale", Node::of(std::string("unknown")));
    if (point) node.set("point", Node::of(std::string("unknown")));
    parts.push_back({names[i], node, rows});
  }
  return parts;
}

TEST(CableEncoders, PutTheErrorsOfARobotWithinTheirOwnSigma) {
  const auto robot = robot_of(kRx90);
  double squares = 0;
  int errors = 0;
  for (int seed = 1; seed <= 24; ++seed) {
    Random random(seed);
    const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
    const bool point = seed % 2 == 0;
    const Session session =
        make_session(*robot, truth, cables(1 + seed % 3, 150, point), 20e-6, random);
    ASSERT_EQ(session.unreached, "");
    const Solution solution = identify(*robot, session.data);
    EXPECT_TRUE(solution.converged) << seed << " " << solution.stop_reason;
    EXPECT_EQ(solution.verdict.answer, Answer::improved) << seed << " " << solution.verdict.why;
    for (size_t i = 0; i < solution.parameters.size(); ++i) {
      const ParameterResult& p = solution.parameters[i];
      EXPECT_EQ(p.status == Status::held, p.parameter.part == Part::base) << p.parameter.name;
      if (p.status != Status::identified) continue;
      ++errors;
      squares += std::pow((p.value - truth[static_cast<Eigen::Index>(i)]) / p.sigma, 2);
    }
    if (point) continue;  // where the tool is, nothing tells
    double square = 0;
    for (const double e : aligned_errors(*robot, solution.values, truth)) square += e * e / 500;
    std::printf("%zu cables: end position %.3g mm off, %.3g stated\n", session.data.sets.size(),
                1e3 * std::sqrt(square), 1e3 * solution.endpoint.rms);
    EXPECT_LT(std::sqrt(square), 2 * solution.endpoint.rms) << seed;
  }
  std::printf("%d errors: rms %.3f sigma\n", errors, std::sqrt(squares / errors));
  // Errors of one robot hang together: some 24 x 10 independent ones leave 5 %, 3 sigma. The gear
  // ratios are exact, and stated as in doubt, which alone makes 0.85 of what noise leaves.
  EXPECT_GT(std::sqrt(squares / errors), 0.85 * 0.85);
  EXPECT_LT(std::sqrt(squares / errors), 1.15);
}

TEST(CableEncoders, FindEveryParameterToOneNanometreOrNanoradianFromExactRowsWithoutPriors) {
  const auto robot = robot_of(kRx90);
  for (const bool point : {false, true}) {
    Random random(3);
    const Eigen::VectorXd truth = rx90_truth(*robot, random, false);
    const Exact exact = without_priors(*robot, truth, cables(2, 150, point), random);
    ASSERT_EQ(exact.unreached, "");
    EXPECT_TRUE(exact.solution.converged) << exact.solution.stop_reason;
    EXPECT_LT(exact.largest_error, 1e-9) << point;
  }
}

}  // namespace
}  // namespace selfcal::recovery
