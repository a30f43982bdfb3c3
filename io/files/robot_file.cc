// A robot's file is YAML; what its keys mean is each kind of robot's own affair
// (kinematics/robots).
#include "io/files/robot_file.h"

#include "io/files/file.h"
#include "io/files/utf8.h"
#include "io/files/yaml.h"
#include "kinematics/make_robot.h"

namespace selfcal {

Result<std::unique_ptr<Robot>> load_robot(const std::filesystem::path& path) {
  const auto text = read_file(path, kMostYamlBytes);
  if (!text) return tl::unexpected(text.error());
  return robot_of(*text, path.string());
}

Result<std::unique_ptr<Robot>> robot_of(std::string_view text, const std::string& name) {
  if (looks_like_xml(text))
    return bad_input(name + ": is XML and no robot file; `selfcal robot convert " + name +
                     "` makes one of a URDF");
  const Result<Node> node = parse_yaml(text, name);
  if (!node) return tl::unexpected(node.error());
  Problems problems;
  std::unique_ptr<Robot> robot = make_robot(*node, problems);
  if (problems.any()) return bad_input(problems);
  return robot;
}

bool looks_like_xml(std::string_view text) { return first_of(text) == '<'; }

std::string robot_text(const Robot& robot, const Eigen::VectorXd& xi) {
  return write_yaml(robot.text().describe(xi));
}

std::string model_hash(const Robot& robot) {
  return "sha256:" + sha256_hex(robot.text().identity());
}

}  // namespace selfcal
