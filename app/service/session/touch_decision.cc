#include "app/service/session/touch_decision.h"

#include <cmath>

namespace selfcal {
namespace {

/// Why a machine with loops cannot stand at these readings: one is out of its range, or the loops
/// do not close in their assembly mode. Empty where it can.
std::string cannot_stand(const Robot& robot, const Eigen::VectorXd& q) {
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(j)];
    if (!joint.allows(q[j]))
      return joint.name + " reads " + format_number(std::round(q[j] * 1e6) / 1e6) +
             ", out of its range";
  }
  Locations X;
  const Closure closure = robot.locate(block_of(q), values(robot), Body::endpoint, X, nullptr);
  return closure.closes(0) ? "" : "the assembly mode is lost: " + closure.why[0];
}

}  // namespace

Eigen::Vector3d endpoint(const Robot& robot, const Eigen::VectorXd& q) {
  return locate(robot, values(robot), q).p;
}

TouchDecision decide_on_touch(const Robot& robot, const Session& session, const Decoding& decoding,
                              const StepRecord& step, const Reading& reading, double search,
                              double tolerance) {
  if (const std::string why = robot.has_loops() ? cannot_stand(robot, reading.q) : ""; !why.empty())
    return {TouchOutcome::outlier, why};
  const int set = set_index(decoding, step.set);
  const auto out_by = [&](const Eigen::VectorXd& from) {
    return decoding.outward[set].dot(endpoint(robot, reading.q) - endpoint(robot, from));
  };
  const double early = out_by(vector_of(step.touch));
  if (early > search)
    return {TouchOutcome::outlier,
            "touched " + format_number(std::round(early * 1e5) / 100) + " mm before the surface"};
  const auto good = good_touches(session, step.index);
  for (const TouchRecord* other : good) {
    const double apart = std::abs(out_by(reading_of(*other, decoding).q));
    if (apart > tolerance)
      return {TouchOutcome::differs,
              "differs by " + format_number(std::round(apart * 1e6)) + " um from the one before"};
  }
  return {};
}

TouchDecision decide_on_visit(const Robot& robot, const Reading& reading) {
  const std::string why = cannot_stand(robot, reading.q);
  return why.empty() ? TouchDecision{} : TouchDecision{TouchOutcome::outlier, why};
}

}  // namespace selfcal
