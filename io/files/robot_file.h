// Robots from their files and back.
#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "io/result.h"
#include "kinematics/robot.h"

namespace selfcal {

/// The robot that the file describes, or the first mistake in it with its line.
Result<std::unique_ptr<Robot>> load_robot(const std::filesystem::path& path);

/// The same of a file's `text`; `name` stands for the file in messages.
Result<std::unique_ptr<Robot>> robot_of(std::string_view text, const std::string& name);

/// The text begins as XML does: a model of another program, and no robot file.
bool looks_like_xml(std::string_view text);

/// The robot's file with parameter values `xi` (one for each of robot.parameters(), SI).
std::string robot_text(const Robot& robot, const Eigen::VectorXd& xi);

/// "sha256:" and 64 digits: equal for all calibrations of one nominal model.
std::string model_hash(const Robot& robot);

}  // namespace selfcal
