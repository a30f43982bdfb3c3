// A robot in its cell as the page draws it: lines at the readings that its encoders send, and the
// surfaces that it may touch. With the figures of the robot's file.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "app/service/config/config.h"
#include "io/dds/participant.h"

namespace selfcal {

class CellView {
 public:
  /// Of a configuration; joint states are heard where they come over DDS. `wakeup` must outlive it.
  static Result<std::unique_ptr<CellView>> open(const std::string& config,
                                                const DdsParticipant& participant, Wakeup& wakeup);

  const Config& config() const { return config_; }

  /// {"robot", "model_hash", "live", "home": LINES, "surfaces": [{"name", "center", "normal",
  /// "radius"}, …]}: `live` says whether joint states are listened to.
  nlohmann::ordered_json cell() const;
  /// {"lines": LINES, "tool": [x, y, z]} at readings `q`, the tool alone where the kind does not
  /// say where its links are; null where no position of the tool has these readings.
  nlohmann::ordered_json pose(const Eigen::VectorXd& q) const;
  /// The readings that came last since the last call.
  std::optional<Eigen::VectorXd> heard();

 private:
  explicit CellView(Config config) : config_(std::move(config)) {}

  Config config_;
  std::unique_ptr<EncoderSource> encoders_;
  std::vector<EncoderSample> samples_;
};

}  // namespace selfcal
