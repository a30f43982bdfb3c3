// selfcal robot check FILE: validates a robot file and shows what a person can check by eye.
#include <cstdio>
#include <memory>
#include <numbers>

#include "app/commands/subcommand.h"
#include "io/files/robot_file.h"

namespace selfcal {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kMillimetres = 1e3;

int check(const std::string& file) {
  const auto robot = load_robot(file);
  if (!robot) return tell(robot.error());
  const Robot& r = **robot;
  std::printf("%s, %s, %zu joints, %zu parameters, %s\n", r.name().c_str(),
              std::string(r.kind()).c_str(), r.joints().size(), r.parameters().size(),
              model_hash(r).c_str());
  for (const Joint& joint : r.joints()) {
    const bool turns = joint.quantity == Quantity::angle;
    const double factor = turns ? kDegrees : kMillimetres;
    if (joint.limited())
      std::printf("  %s: %.4g to %.4g %s\n", joint.name.c_str(), factor * joint.lower,
                  factor * joint.upper, turns ? "degrees" : "mm");
    else
      std::printf("  %s: no limits given (%s)\n", joint.name.c_str(), turns ? "turns" : "slides");
  }
  for (const std::string& line : r.text().remarks()) std::printf("%s\n", line.c_str());
  return kDone;
}

}  // namespace

void add_robot(CLI::App& app, int& status) {
  CLI::App* robot = app.add_subcommand("robot", "Work on robot files");
  robot->require_subcommand(1);
  auto file = std::make_shared<std::string>();
  CLI::App* command = robot->add_subcommand("check", "Validate a robot file");
  command->add_option("FILE", *file, "NAME.robot.yaml (see man selfcal-data)")->required();
  command->callback([file, &status] { status = check(*file); });
  add_robot_convert(*robot, status);
}

}  // namespace selfcal
