#include "app/commands/support/prior_file.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/files/file.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostResultBytes = 64 << 20;
constexpr double kRoundedInFiles = 1e-9;  // of both sigmas: what either half of a matrix is off by

/// The parameters that the covariance is of; a sentence where there is something else.
Result<std::vector<int>> parameters_of(const nlohmann::json& covariance, const Robot& robot,
                                       const std::string& file) {
  std::vector<int> list;
  for (const nlohmann::json& name : covariance.at("order")) {
    list.push_back(name.is_string() ? find_parameter(robot, name.get<std::string>()) : -1);
    if (list.back() < 0)
      return bad_input(file + ": its covariance is of " + name.dump() +
                       ", no parameter of this robot");
  }
  return list;
}

}  // namespace

Result<Eigen::MatrixXd> read_prior(const std::filesystem::path& path, const Robot& robot) {
  const auto text = read_file(path, kMostResultBytes);
  if (!text) return tl::unexpected(text.error());
  const auto parameters = static_cast<Eigen::Index>(robot.parameters().size());
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(parameters, parameters);
  for (Eigen::Index i = 0; i < parameters; ++i) {
    const Parameter& each = robot.parameters()[static_cast<std::size_t>(i)];
    if (each.free) C(i, i) = each.tolerance * each.tolerance;
  }
  const nlohmann::json json = nlohmann::json::parse(*text, nullptr, false);
  const bool has =
      json.is_object() && json.contains("covariance") && json["covariance"].is_object() &&
      json["covariance"].contains("order") && json["covariance"].contains("matrix") &&
      json["covariance"]["order"].is_array() && json["covariance"]["matrix"].is_array();
  if (!has) return bad_input(path.string() + ": no result with a covariance");
  const auto list = parameters_of(json["covariance"], robot, path.string());
  if (!list) return tl::unexpected(list.error());
  const nlohmann::json& matrix = json["covariance"]["matrix"];
  const auto broken = [&] {
    return bad_input(path.string() + ": its covariance is no symmetric matrix of its parameters");
  };
  const auto count = static_cast<Eigen::Index>(list->size());
  Eigen::MatrixXd told(count, count);
  if (matrix.size() != list->size()) return broken();
  for (std::size_t a = 0; a < list->size(); ++a) {
    if (!matrix[a].is_array() || matrix[a].size() != list->size()) return broken();
    for (std::size_t b = 0; b < list->size(); ++b) {
      if (!matrix[a][b].is_number()) return broken();
      told(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) = matrix[a][b].get<double>();
    }
  }
  if (!(told.diagonal().array() > 0).all()) return broken();
  const Eigen::VectorXd sigma = told.diagonal().cwiseSqrt();
  const Eigen::ArrayXXd apart = (told - told.transpose()).array().abs();
  if (!(apart <= kRoundedInFiles * (sigma * sigma.transpose()).array()).all()) return broken();
  C(*list, *list) = (told + told.transpose()) / 2;
  return C;
}

}  // namespace selfcal
