// Plans touches of an unknown plane, and commands a calibrated robot to where the nominal one is at
// some readings.
#include <selfcal/selfcal.h>
#include <cstdio>
#include <cstdlib>
#include <memory>

int main(int argc, char** argv) {
  if (argc < 4) return std::fputs("usage: compensate NOMINAL CALIBRATED Q1 ...\n", stderr), 2;
  std::shared_ptr<const selfcal::Robot> robots[2];
  for (int i = 0; i < 2; ++i) {
    auto robot = selfcal::load_robot(argv[1 + i]);
    if (!robot) {
      std::fprintf(stderr, "%s\n", robot.error().what.c_str());
      return robot.error().exit_status;
    }
    robots[i] = *std::move(robot);
  }
  const auto& [nominal, calibrated] = robots;
  Eigen::VectorXd q(argc - 3);
  for (int j = 0; j < argc - 3; ++j) q[j] = std::atof(argv[3 + j]);
  if (static_cast<std::size_t>(q.size()) != nominal->joints().size()) return 2;

  selfcal::Problems problems;
  selfcal::PlanRequest request;
  request.pool.sets = {selfcal::make_set(
      "plane", selfcal::Node::map().set("method", selfcal::Node::of(std::string("plane"))),
      problems)};
  request.pool.candidates = 100;
  request.count = 20;
  request.speed = Eigen::VectorXd::Ones(q.size());
  const selfcal::ConfigurationPlan plan =
      selfcal::plan_configurations(*nominal, values(*nominal), request);
  std::printf("plan %.6g\n", plan.planned.sigma);

  const selfcal::Location wanted = locate(*nominal, values(*nominal), q);
  const Eigen::Quaterniond turn(wanted.R);
  std::printf("pose %.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", wanted.p.x(), wanted.p.y(),
              wanted.p.z(), turn.w(), turn.x(), turn.y(), turn.z());
  const selfcal::Command command =
      selfcal::Compensation(nominal, calibrated).command(wanted, std::nullopt);
  std::printf("%s\n", std::string(to_string(command.status)).c_str());
  for (Eigen::Index j = 0; j < command.q.size(); ++j)
    std::printf("q%d %.9f\n", int(j) + 1, command.q[j]);
  auto stream = selfcal::CompensationStream::of(calibrated, command.q);
  return stream && stream->command(wanted).status == selfcal::Streamed::reached ? 0 : 1;
}
