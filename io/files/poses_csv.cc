#include "io/files/poses_csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "constraints/methods/maker.h"
#include "io/files/cell_numbers.h"
#include "io/files/csv.h"
#include "io/files/near_names.h"
#include "io/files/plausible.h"

namespace selfcal {
namespace {

constexpr int kPose = 7;
constexpr std::array<std::string_view, kPose> kPoseNames = {"x", "y", "z", "qw", "qx", "qy", "qz"};
constexpr double kUnit = 1e-3;  // off 1 that a quaternion's length may be

std::string instead_of(std::string_view missing, Cells names) {
  const std::vector<std::string> there(names.begin(), names.end());
  std::vector<std::string> unknown;
  for (const std::string& name : there)
    if (std::ranges::find(kPoseNames, name) == kPoseNames.end()) unknown.push_back(name);
  return columns_instead(missing, there, unknown);
}

/// Places of the columns, those of the pose first, then the joints' if there are any.
class PoseReader {
 public:
  explicit PoseReader(const std::vector<Joint>& robot)
      : robot_(robot), joints_(static_cast<int>(robot.size())) {}

  std::optional<RowFault> take_header(Cells names, char separator) {
    cells_.begin(separator);
    for (const std::string_view name : kPoseNames) {
      const auto place = find(names, name);
      if (!place)
        return RowFault{"column '" + std::string(name) +
                        "' is missing: " + instead_of(name, names)};
      places_.push_back(*place);
    }
    for (int j = 1; j <= joints_; ++j) {
      const auto place = find(names, "q" + std::to_string(j));
      if (place) places_.push_back(*place);
    }
    if (const auto found = static_cast<int>(places_.size()) - kPose; found != 0 && found != joints_)
      return RowFault{"columns q1 to q" + std::to_string(joints_) + ": all of them or none"};
    return std::nullopt;
  }

  std::optional<RowFault> take_row(Cells cells) {
    Eigen::VectorXd numbers(static_cast<Eigen::Index>(places_.size()));
    WantedPose pose;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const auto number = cells_.read(cells[places_[i]]);
      if (!number) return RowFault{number.error(), places_[i]};
      if (i < 3 && std::abs(*number) > kFarthestPlace)
        return RowFault{"expected metres (millimetres?)", places_[i]};
      numbers[static_cast<Eigen::Index>(i)] = *number;
      if (i >= kPose) {
        if (auto fault = joint_fault(robot_[i - kPose], *number, Readings::any))
          return RowFault{std::move(*fault), places_[i]};
        continue;
      }
      std::string text(cells[places_[i]]);
      std::ranges::replace(text, ',', '.');
      pose.text += (i > 0 ? "," : "") + text;
    }
    const Eigen::Quaterniond turn(numbers[3], numbers[4], numbers[5], numbers[6]);
    if (!(std::abs(turn.norm() - 1) < kUnit))
      return RowFault{"expected a unit quaternion qw qx qy qz", places_[3]};
    pose.location.p = numbers.head<3>();
    pose.location.R = turn.normalized().toRotationMatrix();
    if (numbers.size() > kPose) pose.near = numbers.tail(joints_);
    poses_.push_back(std::move(pose));
    return std::nullopt;
  }

  std::vector<WantedPose> hand_over() { return std::move(poses_); }

 private:
  static std::optional<std::size_t> find(Cells names, std::string_view name) {
    const auto at = std::ranges::find(names, name);
    if (at == names.end()) return std::nullopt;
    return static_cast<std::size_t>(at - names.begin());
  }

  const std::vector<Joint>& robot_;
  int joints_;
  CellNumbers cells_;
  std::vector<std::size_t> places_;
  std::vector<WantedPose> poses_;
};

}  // namespace

Result<std::vector<WantedPose>> read_poses(const std::filesystem::path& path,
                                           const std::vector<Joint>& joints) {
  PoseReader reader(joints);
  const auto done = read_csv(
      path,
      [&](Cells names, std::optional<char> separator) {
        return reader.take_header(names, separator.value_or(','));
      },
      [&](Cells cells, int) { return reader.take_row(cells); });
  if (!done) return tl::unexpected(done.error());
  std::vector<WantedPose> poses = reader.hand_over();
  if (poses.empty()) return tl::unexpected(Failure{kBadInput, path.string() + ": has no rows"});
  return poses;
}

}  // namespace selfcal
