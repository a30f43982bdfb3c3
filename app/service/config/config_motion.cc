#include "app/service/config/config_motion.h"

#include <algorithm>

#include "constraints/planning/fence_file.h"

namespace selfcal {

void read_motion(Fields& f, Config& c, Problems& problems) {
  const auto home = f.numbers("home", static_cast<int>(c.robot->joints().size()));
  if (home)
    c.plan.home = *home;
  else
    f.fail("home", "a reading for each joint (rad, m)");
  for (std::size_t j = 0; home && j < c.robot->joints().size(); ++j) {
    const Joint& joint = c.robot->joints()[j];
    const double q = (*home)[static_cast<Eigen::Index>(j)];
    if (!joint.allows(q)) f.fail("home", "a reading of " + joint.name + " within its limits");
  }
  c.plan.speed = c.speeds.travel = f.number("speed", c.speeds.travel, 1e-3, 100);
  c.speeds.touch = f.number("touch_speed", c.speeds.touch, 1e-4, 1);
  c.plan.clearance = f.number("clearance", c.plan.clearance, 1e-3, 0.5);
  c.plan.search = f.number("search", c.plan.search, 1e-4, 0.1);
  c.plan.apart = f.number("apart", c.plan.apart, 0, 0.5);
  c.plan.tilt = f.number("tilt", c.plan.tilt, 0.01, 3.2);
  c.plan.touch_speed = c.speeds.touch;
  c.plan.spacing = f.number("spacing", c.plan.spacing, 0, 1);
  c.plan.longest = f.number("longest", c.plan.longest, 0, 1e6);
  c.plan.limit_margin = f.number("limit_margin", c.plan.limit_margin, 0, 0.4);
  c.touch.rest = f.number("rest", c.touch.rest, 1e-7, 0.1);
  if (c.plan.apart >= c.plan.clearance) f.fail("apart", "less than clearance");
  if (c.plan.search >= c.plan.clearance) f.fail("search", "less than clearance");
  const double most = std::max(c.plan.search, c.plan.clearance);
  c.plan.slow = f.number("slow", c.plan.search, c.plan.search, most);
  c.plan.fence = read_fence(f.node("keep_out"), f.node("capsules"), *c.robot, problems);
  if (problems.any() || !home) return;
  Locations X;
  if (!c.robot->locate(block_of(*home), values(*c.robot), Body::endpoint, X, nullptr).closes(0))
    return f.fail("home", "readings with which the robot's chains meet");
  if (!c.robot->within_passive_limits(*home))
    return f.fail("home",
                  "readings at which every passive joint is within its limit (`swing` of the "
                  "robot's file, which `selfcal robot check` shows)");
  if (const std::string what = in_the_way(*c.robot, c.plan.fence, {}, *home, X.p(0), 0, -1);
      !what.empty())
    f.fail("home", "free of keep_out and capsules: there " + what);
}

void read_touch(Fields& f, Config& c) {
  c.touch.repeats = c.plan.repeats = f.integer("repeats", c.touch.repeats, 1, 20);
  c.touch.tolerance = f.number("tolerance", c.touch.tolerance, 1e-6, 0.01);
  c.limits.attempts = f.integer("attempts", c.limits.attempts, 1, 20);
  c.limits.most_failures = f.integer("most_lost", c.limits.most_failures, 1, 1000);
}

void read_limits(Fields& f, Limits& limits) {
  const auto limit = [&](const char* key, Nanoseconds& value) {
    value = nanoseconds(f.number(key, seconds(value), 1, 3600));
  };
  limit("self_test", limits.self_test);
  limit("planning", limits.planning);
  limit("approach", limits.approach);
  limit("touch", limits.touch);
  limit("settle", limits.settle);
  limit("retract", limits.retract);
  limit("lock", limits.lock);
  limit("computing", limits.computing);
  limit("diagnosing", limits.diagnosing);
}

}  // namespace selfcal
