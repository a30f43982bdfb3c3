// What a robot's store has that its messages have not: past sessions, the log, what accept and
// rollback would change, where a touch was planned.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "io/store/store.h"
#include "kinematics/robot.h"

namespace selfcal {

class Archive {
 public:
  static constexpr int kSessions = 30, kEvents = 60;  ///< shown

  /// Of the store in `folder`, which need not be there yet; `factory` is the robot as its maker
  /// gives it.
  Archive(std::filesystem::path folder, std::shared_ptr<const Robot> factory)
      : folder_(std::move(folder)), factory_(std::move(factory)) {}

  /// The newest sessions as `history --json` has them, and the log: {"sessions", "events",
  /// "problem"}; the last says why they are empty, if they are.
  nlohmann::ordered_json history();

  /// {"accept": {"session", "from", "changes"}, "rollback": {"from", "to", "since_ms", "changes"}}:
  /// sessions, 0 for the factory's parameters, and changes_between; null where there is nothing to
  /// accept or to go back to, or where it cannot be read.
  nlohmann::ordered_json slots();

  /// The readings at which the step of the session's plan should touch; nothing when unknown.
  std::optional<Eigen::VectorXd> planned(std::int64_t session, std::uint32_t step);

 private:
  struct Parameters {
    std::int64_t session = 0, since_ms = 0;
    std::shared_ptr<const Robot> robot;
  };
  Result<Store*> store();
  /// What is in the slot; the factory's where it is empty and `or_factory` holds.
  std::optional<Parameters> parameters(Store& store, Slot slot, bool or_factory) const;

  std::filesystem::path folder_;
  std::shared_ptr<const Robot> factory_;
  std::unique_ptr<Store> store_;
  std::int64_t planned_session_ = 0;
  std::vector<StepRecord> plan_;  // of that session
};

}  // namespace selfcal
